-- SPDX-License-Identifier: Apache-2.0
-- Layouts: what was built, out of which blocks, with which parameters, and who wrote the row.
-- Read through the views at the end; docs/catalog.md describes their columns.

CREATE TABLE schema_history(
  version INTEGER PRIMARY KEY,
  name TEXT NOT NULL,
  program_version TEXT NOT NULL,
  applied_at TEXT NOT NULL
) STRICT;

-- One row per canonical formula; everything that follows from the formula alone hangs on it, so that a million
-- sized variants of one structure store it once.
CREATE TABLE formula(
  id INTEGER PRIMARY KEY,
  text TEXT NOT NULL UNIQUE CHECK(text <> ''),
  distribution TEXT NOT NULL,
  relative_motion TEXT NOT NULL,
  base TEXT NOT NULL CHECK(base IN ('closed', 'open'))
) STRICT;
CREATE INDEX formula_by_distribution ON formula(distribution);
CREATE INDEX formula_by_relative_motion ON formula(relative_motion);

CREATE TABLE motion(
  formula_id INTEGER NOT NULL REFERENCES formula(id) ON DELETE CASCADE,
  position INTEGER NOT NULL CHECK(position >= 0),
  axis TEXT NOT NULL CHECK(axis <> ''),
  side TEXT NOT NULL CHECK(side IN ('workpiece', 'tool')),
  working INTEGER NOT NULL CHECK(working IN (0, 1)),
  block TEXT NOT NULL,
  PRIMARY KEY(formula_id, position)
) STRICT, WITHOUT ROWID;

-- Who made a row: one entry serves all rows of a run.
CREATE TABLE provenance(
  id INTEGER PRIMARY KEY,
  program_version TEXT NOT NULL CHECK(program_version <> ''),
  plugins TEXT NOT NULL,
  source_path TEXT NOT NULL,
  source_hash TEXT NOT NULL CHECK(length(source_hash) = 64),
  UNIQUE(source_hash, source_path, program_version, plugins)
) STRICT;

CREATE TABLE provenance_plugin(
  provenance_id INTEGER NOT NULL REFERENCES provenance(id) ON DELETE CASCADE,
  plugin TEXT NOT NULL CHECK(plugin <> ''),
  version TEXT NOT NULL,
  PRIMARY KEY(provenance_id, plugin)
) STRICT, WITHOUT ROWID;

CREATE TABLE module(
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL CHECK(name <> ''),
  plugin TEXT NOT NULL,
  UNIQUE(name, plugin)
) STRICT;

CREATE TABLE quantity(
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL CHECK(name <> ''),
  unit TEXT NOT NULL,
  UNIQUE(name, unit)
) STRICT;

CREATE TABLE layout(
  id INTEGER PRIMARY KEY,
  content_hash BLOB NOT NULL UNIQUE CHECK(length(content_hash) = 32),
  name TEXT NOT NULL CHECK(name <> ''),
  formula_id INTEGER NOT NULL REFERENCES formula(id),
  coordinates INTEGER NOT NULL CHECK(coordinates >= 0),
  drives INTEGER NOT NULL CHECK(drives >= 0),
  provenance_id INTEGER NOT NULL REFERENCES provenance(id),
  added_at TEXT NOT NULL CHECK(added_at GLOB '????-??-??T??:??:??Z')
) STRICT;
CREATE INDEX layout_by_name ON layout(name);
CREATE INDEX layout_by_formula ON layout(formula_id);

-- Kept out of `layout`, so that a scan of the layouts does not read the texts.
CREATE TABLE layout_text(
  layout_id INTEGER PRIMARY KEY REFERENCES layout(id) ON DELETE CASCADE,
  toml TEXT NOT NULL,
  content TEXT
) STRICT;

CREATE TABLE layout_block(
  layout_id INTEGER NOT NULL REFERENCES layout(id) ON DELETE CASCADE,
  position INTEGER NOT NULL CHECK(position >= 0),
  name TEXT NOT NULL CHECK(name <> ''),
  module_id INTEGER NOT NULL REFERENCES module(id),
  PRIMARY KEY(layout_id, position)
) STRICT, WITHOUT ROWID;
CREATE INDEX layout_block_by_module ON layout_block(module_id);

CREATE TABLE parameter(
  layout_id INTEGER NOT NULL REFERENCES layout(id) ON DELETE CASCADE,
  quantity_id INTEGER NOT NULL REFERENCES quantity(id),
  value REAL NOT NULL,
  PRIMARY KEY(layout_id, quantity_id)
) STRICT, WITHOUT ROWID;

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
