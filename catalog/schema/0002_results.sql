-- SPDX-License-Identifier: Apache-2.0
-- Results: what was computed or measured about a layout, each with its own origin.

-- Methods of metrics and names of capabilities, few and often repeated.
CREATE TABLE term(
  id INTEGER PRIMARY KEY,
  text TEXT NOT NULL UNIQUE
) STRICT;

-- A metric that could not be computed is a row with its reason.
CREATE TABLE metric(
  layout_id INTEGER NOT NULL REFERENCES layout(id) ON DELETE CASCADE,
  quantity_id INTEGER NOT NULL REFERENCES quantity(id),
  method_id INTEGER NOT NULL REFERENCES term(id),
  value REAL,
  failure TEXT CHECK(failure <> ''),
  provenance_id INTEGER NOT NULL REFERENCES provenance(id),
  CHECK((value IS NULL) = (failure IS NOT NULL)),
  PRIMARY KEY(layout_id, quantity_id, method_id)
) STRICT, WITHOUT ROWID;
CREATE INDEX metric_by_value ON metric(quantity_id, value);

CREATE TABLE capability(
  layout_id INTEGER NOT NULL REFERENCES layout(id) ON DELETE CASCADE,
  name_id INTEGER NOT NULL REFERENCES term(id),
  detail TEXT NOT NULL,
  provenance_id INTEGER NOT NULL REFERENCES provenance(id),
  PRIMARY KEY(layout_id, name_id)
) STRICT, WITHOUT ROWID;
CREATE INDEX capability_by_name ON capability(name_id);

CREATE TABLE calibration(
  id INTEGER PRIMARY KEY,
  layout_id INTEGER NOT NULL REFERENCES layout(id) ON DELETE CASCADE,
  content_hash BLOB NOT NULL CHECK(length(content_hash) = 32),
  measurements TEXT NOT NULL,
  measurements_hash TEXT NOT NULL CHECK(length(measurements_hash) = 64),
  status TEXT NOT NULL CHECK(status <> ''),
  rms_before_um REAL CHECK(rms_before_um >= 0),
  rms_after_um REAL CHECK(rms_after_um >= 0),
  sigma_um REAL CHECK(sigma_um >= 0),
  degrees_of_freedom INTEGER NOT NULL,
  provenance_id INTEGER NOT NULL REFERENCES provenance(id),
  added_at TEXT NOT NULL CHECK(added_at GLOB '????-??-??T??:??:??Z'),
  report TEXT NOT NULL CHECK(report <> ''), -- JSON; last, because it is long and rarely read
  UNIQUE(layout_id, content_hash)
) STRICT;

-- The residuals of the newest calibration, copied into the layout's row to be searched and sorted by index.
ALTER TABLE layout ADD COLUMN rms_before_um REAL;
ALTER TABLE layout ADD COLUMN rms_after_um REAL;
CREATE INDEX layout_by_rms_after ON layout(rms_after_um) WHERE rms_after_um IS NOT NULL;

CREATE TRIGGER calibration_added AFTER INSERT ON calibration WHEN NEW.rms_after_um IS NOT NULL BEGIN
  UPDATE layout SET rms_before_um = NEW.rms_before_um, rms_after_um = NEW.rms_after_um WHERE id = NEW.layout_id;
END;
CREATE TRIGGER calibration_changed AFTER UPDATE ON calibration BEGIN
  UPDATE layout SET (rms_before_um, rms_after_um) =
    (SELECT c.rms_before_um, c.rms_after_um FROM calibration AS c
      WHERE c.layout_id = NEW.layout_id AND c.rms_after_um IS NOT NULL ORDER BY c.id DESC LIMIT 1)
  WHERE id = NEW.layout_id;
END;
CREATE TRIGGER calibration_removed AFTER DELETE ON calibration BEGIN
  UPDATE layout SET (rms_before_um, rms_after_um) =
    (SELECT c.rms_before_um, c.rms_after_um FROM calibration AS c
      WHERE c.layout_id = OLD.layout_id AND c.rms_after_um IS NOT NULL ORDER BY c.id DESC LIMIT 1)
  WHERE id = OLD.layout_id;
END;

DROP VIEW layouts;
CREATE VIEW layouts AS
SELECT l.id AS id,
       l.name AS name,
       f.text AS formula,
       f.distribution AS distribution,
       f.relative_motion AS relative_motion,
       f.base AS base,
       l.coordinates AS coordinates,
       l.drives AS drives,
       (SELECT group_concat(b.name || '=' || m.name, ', ')
          FROM layout_block AS b CROSS JOIN module AS m ON m.id = b.module_id
         WHERE b.layout_id = l.id) AS modules,
       p.plugins AS plugins,
       l.rms_before_um AS rms_before_um,
       l.rms_after_um AS rms_after_um,
       (SELECT count(*) FROM calibration AS c WHERE c.layout_id = l.id) AS calibrations,
       p.program_version AS program_version,
       p.source_path AS source,
       p.source_hash AS source_hash,
       lower(hex(l.content_hash)) AS hash,
       l.added_at AS added_at
  FROM layout AS l
  JOIN formula AS f ON f.id = l.formula_id
  JOIN provenance AS p ON p.id = l.provenance_id;

CREATE VIEW plugins AS
SELECT l.id AS layout_id, l.name AS layout, v.plugin AS plugin, v.version AS version
  FROM layout AS l
  JOIN provenance_plugin AS v ON v.provenance_id = l.provenance_id;

CREATE VIEW metrics AS
SELECT r.layout_id AS layout_id, l.name AS layout, q.name AS name, r.value AS value, q.unit AS unit,
       t.text AS method, r.failure AS failure, p.program_version AS program_version, p.plugins AS plugins,
       p.source_hash AS source_hash
  FROM metric AS r
  JOIN quantity AS q ON q.id = r.quantity_id
  JOIN term AS t ON t.id = r.method_id
  JOIN layout AS l ON l.id = r.layout_id
  JOIN provenance AS p ON p.id = r.provenance_id;

CREATE VIEW capabilities AS
SELECT r.layout_id AS layout_id, l.name AS layout, t.text AS name, r.detail AS detail,
       p.program_version AS program_version, p.plugins AS plugins, p.source_hash AS source_hash
  FROM capability AS r
  JOIN term AS t ON t.id = r.name_id
  JOIN layout AS l ON l.id = r.layout_id
  JOIN provenance AS p ON p.id = r.provenance_id;

CREATE VIEW calibrations AS
SELECT c.layout_id AS layout_id, l.name AS layout, c.status AS status, c.rms_before_um AS rms_before_um,
       c.rms_after_um AS rms_after_um, c.sigma_um AS sigma_um, c.degrees_of_freedom AS degrees_of_freedom,
       c.measurements AS measurements, c.measurements_hash AS measurements_hash,
       p.program_version AS program_version, p.plugins AS plugins, p.source_hash AS source_hash,
       c.added_at AS added_at
  FROM calibration AS c
  JOIN layout AS l ON l.id = c.layout_id
  JOIN provenance AS p ON p.id = c.provenance_id;
