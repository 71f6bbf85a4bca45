-- SPDX-License-Identifier: Apache-2.0
-- Studies: what was searched, what became of every candidate, which are done; tables that bear a million layouts; words.

-- Views and triggers name tables that are rebuilt below.
DROP VIEW layouts;
DROP VIEW motions;
DROP VIEW modules;
DROP VIEW parameters;
DROP VIEW plugins;
DROP VIEW metrics;
DROP VIEW capabilities;
DROP VIEW calibrations;
DROP TRIGGER calibration_added;
DROP TRIGGER calibration_changed;
DROP TRIGGER calibration_removed;

-- The index of the hashes holds eight bytes of each instead of all: a third of the pages that a new layout dirties at random.
CREATE TABLE layout_3(
  id INTEGER PRIMARY KEY,
  hash_key INTEGER NOT NULL, -- the first eight bytes of content_hash, big-endian
  content_hash BLOB NOT NULL CHECK(length(content_hash) = 32),
  name TEXT NOT NULL CHECK(name <> ''),
  formula_id INTEGER NOT NULL REFERENCES formula(id),
  coordinates INTEGER NOT NULL CHECK(coordinates >= 0),
  drives INTEGER NOT NULL CHECK(drives >= 0),
  provenance_id INTEGER NOT NULL REFERENCES provenance(id),
  added_at TEXT NOT NULL CHECK(added_at GLOB '????-??-??T??:??:??Z'),
  rms_before_um REAL,
  rms_after_um REAL
) STRICT;
INSERT INTO layout_3
SELECT id, content_key(content_hash), content_hash, name, formula_id, coordinates, drives, provenance_id, added_at,
       rms_before_um, rms_after_um
  FROM layout ORDER BY id;
DROP TABLE layout;
ALTER TABLE layout_3 RENAME TO layout;
CREATE INDEX layout_by_hash ON layout(hash_key);
CREATE INDEX layout_by_name ON layout(name);
CREATE INDEX layout_by_formula ON layout(formula_id);
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

-- What a number of a metric means: its name, unit and method as one small number.
CREATE TABLE measure(
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL CHECK(name <> ''),
  unit TEXT NOT NULL,
  method TEXT NOT NULL,
  UNIQUE(name, unit, method)
) STRICT;
INSERT INTO measure(name, unit, method)
SELECT DISTINCT q.name, q.unit, t.text
  FROM metric AS r JOIN quantity AS q ON q.id = r.quantity_id JOIN term AS t ON t.id = r.method_id
 ORDER BY 1, 2, 3;
CREATE TABLE metric_3(
  layout_id INTEGER NOT NULL REFERENCES layout(id) ON DELETE CASCADE,
  measure_id INTEGER NOT NULL REFERENCES measure(id),
  value REAL,
  failure TEXT CHECK(failure <> ''),
  provenance_id INTEGER NOT NULL REFERENCES provenance(id),
  CHECK((value IS NULL) = (failure IS NOT NULL)),
  PRIMARY KEY(layout_id, measure_id)
) STRICT, WITHOUT ROWID;
INSERT INTO metric_3
SELECT r.layout_id, m.id, r.value, r.failure, r.provenance_id
  FROM metric AS r JOIN quantity AS q ON q.id = r.quantity_id JOIN term AS t ON t.id = r.method_id
  JOIN measure AS m ON m.name = q.name AND m.unit = q.unit AND m.method = t.text
 ORDER BY 1, 2;
DROP TABLE metric;
ALTER TABLE metric_3 RENAME TO metric;
CREATE INDEX metric_by_value ON metric(measure_id, value);

-- The tree of the formula as JSON; NULL for a text that is not a formula.
ALTER TABLE formula ADD COLUMN tree TEXT;
UPDATE formula SET tree = formula_tree(text);

CREATE TABLE study(
  id INTEGER PRIMARY KEY,
  content_hash BLOB NOT NULL UNIQUE CHECK(length(content_hash) = 32),
  name TEXT NOT NULL CHECK(name <> ''),
  candidates INTEGER NOT NULL CHECK(candidates >= 0),
  provenance_id INTEGER NOT NULL REFERENCES provenance(id),
  added_at TEXT NOT NULL CHECK(added_at GLOB '????-??-??T??:??:??Z'),
  toml TEXT NOT NULL,
  content TEXT
) STRICT;
CREATE INDEX study_by_name ON study(name);

CREATE TABLE study_rule(
  study_id INTEGER NOT NULL REFERENCES study(id) ON DELETE CASCADE,
  position INTEGER NOT NULL CHECK(position >= 0),
  first TEXT NOT NULL CHECK(first <> ''),
  second TEXT NOT NULL,
  kind TEXT NOT NULL CHECK(kind IN ('logical', 'empirical', 'normative')),
  reason TEXT NOT NULL,
  author TEXT NOT NULL,
  active INTEGER NOT NULL CHECK(active IN (0, 1)),
  PRIMARY KEY(study_id, position)
) STRICT, WITHOUT ROWID;

CREATE TABLE run(
  id INTEGER PRIMARY KEY,
  study_id INTEGER NOT NULL REFERENCES study(id) ON DELETE CASCADE,
  provenance_id INTEGER NOT NULL REFERENCES provenance(id),
  started_at TEXT NOT NULL CHECK(started_at GLOB '????-??-??T??:??:??Z')
) STRICT;
CREATE INDEX run_by_study ON run(study_id);

-- Candidates begin .. past-1 are done, by this run. Ranges of a study do not overlap.
CREATE TABLE run_range(
  study_id INTEGER NOT NULL REFERENCES study(id) ON DELETE CASCADE,
  begin INTEGER NOT NULL CHECK(begin >= 0),
  past INTEGER NOT NULL CHECK(past > begin),
  run_id INTEGER NOT NULL REFERENCES run(id),
  PRIMARY KEY(study_id, begin)
) STRICT, WITHOUT ROWID;

-- A million candidates fall for some dozens of reasons.
CREATE TABLE verdict(
  id INTEGER PRIMARY KEY,
  status TEXT NOT NULL CHECK(status IN ('ok', 'rejected', 'failed')),
  stage TEXT NOT NULL,
  reason TEXT NOT NULL,
  UNIQUE(status, stage, reason)
) STRICT;

CREATE TABLE evaluation(
  study_id INTEGER NOT NULL REFERENCES study(id) ON DELETE CASCADE,
  candidate INTEGER NOT NULL CHECK(candidate >= 0),
  verdict_id INTEGER NOT NULL REFERENCES verdict(id),
  formula_id INTEGER REFERENCES formula(id),
  layout_id INTEGER REFERENCES layout(id) ON DELETE CASCADE,
  PRIMARY KEY(study_id, candidate)
) STRICT, WITHOUT ROWID;
CREATE INDEX evaluation_by_layout ON evaluation(layout_id) WHERE layout_id IS NOT NULL;

-- Of candidates that did not become layouts; those of the others are the layout's.
CREATE TABLE evaluation_metric(
  study_id INTEGER NOT NULL,
  candidate INTEGER NOT NULL,
  measure_id INTEGER NOT NULL REFERENCES measure(id),
  value REAL,
  failure TEXT CHECK(failure <> ''),
  CHECK((value IS NULL) = (failure IS NOT NULL)),
  PRIMARY KEY(study_id, candidate, measure_id),
  FOREIGN KEY(study_id, candidate) REFERENCES evaluation(study_id, candidate) ON DELETE CASCADE
) STRICT, WITHOUT ROWID;

-- One row while somebody loads in bulk, and after that was cut short: the indexes of large tables may be missing.
CREATE TABLE bulk_load(
  id INTEGER PRIMARY KEY CHECK(id = 1),
  started_at TEXT NOT NULL
) STRICT;

-- Words of layouts (rowid 2 * id) and studies (rowid 2 * id + 1). Layouts that only a study made are found by the study.
CREATE VIRTUAL TABLE word USING fts5(name, formula, parts, text, tokenize = 'unicode61');
INSERT INTO word(rowid, name, formula, parts, text)
SELECT 2 * l.id, l.name, f.text,
       coalesce((SELECT group_concat(b.name || ' ' || m.name || ' ' || m.plugin, '; ')
                   FROM layout_block AS b JOIN module AS m ON m.id = b.module_id WHERE b.layout_id = l.id), '') || ' ' ||
       coalesce((SELECT group_concat(t.text || ' ' || c.detail, '; ')
                   FROM capability AS c JOIN term AS t ON t.id = c.name_id WHERE c.layout_id = l.id), ''),
       t.toml
  FROM layout AS l JOIN formula AS f ON f.id = l.formula_id JOIN layout_text AS t ON t.layout_id = l.id;

CREATE TRIGGER layout_removed AFTER DELETE ON layout BEGIN
  DELETE FROM word WHERE rowid = 2 * OLD.id;
END;
CREATE TRIGGER study_removed AFTER DELETE ON study BEGIN
  DELETE FROM word WHERE rowid = 2 * OLD.id + 1;
END;

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

CREATE VIEW motions AS
SELECT l.id AS layout_id, l.name AS layout, v.position AS position, v.axis AS axis, v.side AS side,
       v.working AS working, v.block AS block
  FROM motion AS v
  JOIN layout AS l ON l.formula_id = v.formula_id;

CREATE VIEW modules AS
SELECT b.layout_id AS layout_id, l.name AS layout, b.name AS block, m.name AS module, m.plugin AS plugin,
       (SELECT v.version FROM provenance_plugin AS v
         WHERE v.provenance_id = l.provenance_id AND v.plugin = m.plugin) AS plugin_version
  FROM layout_block AS b
  JOIN module AS m ON m.id = b.module_id
  JOIN layout AS l ON l.id = b.layout_id;

CREATE VIEW parameters AS
SELECT r.layout_id AS layout_id, l.name AS layout, q.name AS name, r.value AS value, q.unit AS unit
  FROM parameter AS r
  JOIN quantity AS q ON q.id = r.quantity_id
  JOIN layout AS l ON l.id = r.layout_id;

CREATE VIEW plugins AS
SELECT l.id AS layout_id, l.name AS layout, v.plugin AS plugin, v.version AS version
  FROM layout AS l
  JOIN provenance_plugin AS v ON v.provenance_id = l.provenance_id;

CREATE VIEW metrics AS
SELECT r.layout_id AS layout_id, l.name AS layout, m.name AS name, r.value AS value, m.unit AS unit,
       m.method AS method, r.failure AS failure, p.program_version AS program_version, p.plugins AS plugins,
       p.source_hash AS source_hash
  FROM metric AS r
  JOIN measure AS m ON m.id = r.measure_id
  JOIN layout AS l ON l.id = r.layout_id
  JOIN provenance AS p ON p.id = r.provenance_id;

-- The same without words, for conditions like metric.stiffness_min > 20.
CREATE VIEW metric_values AS
SELECT layout_id, measure_id AS measure, value FROM metric;

CREATE VIEW measures AS
SELECT id AS measure, name, unit, method FROM measure;

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

CREATE VIEW measurements AS
SELECT c.measurements_hash AS hash, min(c.measurements) AS name, count(*) AS calibrations,
       count(DISTINCT c.layout_id) AS layouts
  FROM calibration AS c GROUP BY c.measurements_hash;

CREATE VIEW formulas AS
SELECT text AS formula, distribution, relative_motion, base, tree FROM formula;

CREATE VIEW studies AS
SELECT s.id AS id, s.name AS name, s.candidates AS candidates,
       (SELECT coalesce(sum(r.past - r.begin), 0) FROM run_range AS r WHERE r.study_id = s.id) AS done,
       p.source_path AS source, p.source_hash AS source_hash, p.program_version AS program_version,
       p.plugins AS plugins, lower(hex(s.content_hash)) AS hash, s.added_at AS added_at
  FROM study AS s
  JOIN provenance AS p ON p.id = s.provenance_id;

CREATE VIEW rules AS
SELECT r.study_id AS study_id, s.name AS study, r.first AS first, r.second AS second, r.kind AS kind,
       r.reason AS reason, r.author AS author, r.active AS active
  FROM study_rule AS r
  JOIN study AS s ON s.id = r.study_id;

CREATE VIEW runs AS
SELECT g.study_id AS study_id, s.name AS study, g.run_id AS run, g.begin AS begin, g.past AS past,
       p.program_version AS program_version, p.plugins AS plugins, r.started_at AS started_at
  FROM run_range AS g
  JOIN run AS r ON r.id = g.run_id
  JOIN study AS s ON s.id = g.study_id
  JOIN provenance AS p ON p.id = r.provenance_id;

CREATE VIEW evaluations AS
SELECT e.study_id AS study_id, s.name AS study, e.candidate AS candidate, v.status AS status, v.stage AS stage,
       v.reason AS reason, f.text AS formula, e.layout_id AS layout_id
  FROM evaluation AS e
  JOIN study AS s ON s.id = e.study_id
  JOIN verdict AS v ON v.id = e.verdict_id
  LEFT JOIN formula AS f ON f.id = e.formula_id;

CREATE VIEW evaluation_metrics AS
SELECT e.study_id AS study_id, e.candidate AS candidate, m.name AS name, r.value AS value, m.unit AS unit,
       m.method AS method, r.failure AS failure
  FROM evaluation AS e
  JOIN metric AS r ON r.layout_id = e.layout_id
  JOIN measure AS m ON m.id = r.measure_id
UNION ALL
SELECT r.study_id, r.candidate, m.name, r.value, m.unit, m.method, r.failure
  FROM evaluation_metric AS r
  JOIN measure AS m ON m.id = r.measure_id;
