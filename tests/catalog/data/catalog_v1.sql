-- SPDX-License-Identifier: Apache-2.0
-- A catalog of schema 1: what 'sqlite3 FILE .dump' printed of three layouts, and the two numbers of the header.
PRAGMA foreign_keys=OFF;
BEGIN TRANSACTION;
CREATE TABLE schema_history(
  version INTEGER PRIMARY KEY,
  name TEXT NOT NULL,
  program_version TEXT NOT NULL,
  applied_at TEXT NOT NULL
) STRICT;
INSERT INTO schema_history VALUES(1,'layouts','0.1.0','2026-11-23T15:26:25Z');
CREATE TABLE formula(
  id INTEGER PRIMARY KEY,
  text TEXT NOT NULL UNIQUE CHECK(text <> ''),
  distribution TEXT NOT NULL,
  relative_motion TEXT NOT NULL,
  base TEXT NOT NULL CHECK(base IN ('closed', 'open'))
) STRICT;
INSERT INTO formula VALUES(1,'part_xy (XY):drive O|O Z P_z','part_xy (XY):drive O|O Z P_z','{XYZ} P_z','open');
INSERT INTO formula VALUES(2,'part X Y Z O C_v tool','part {XYZ} O C_v tool','{XYZ} C_v','closed');
INSERT INTO formula VALUES(3,'part O (XYZABC):struts C_v tool','part O (XYZABC):struts C_v tool','{XYZ} {ABC} C_v','closed');
CREATE TABLE motion(
  formula_id INTEGER NOT NULL REFERENCES formula(id) ON DELETE CASCADE,
  position INTEGER NOT NULL CHECK(position >= 0),
  axis TEXT NOT NULL CHECK(axis <> ''),
  side TEXT NOT NULL CHECK(side IN ('workpiece', 'tool')),
  working INTEGER NOT NULL CHECK(working IN (0, 1)),
  block TEXT NOT NULL,
  PRIMARY KEY(formula_id, position)
) STRICT, WITHOUT ROWID;
INSERT INTO motion VALUES(1,0,'X','workpiece',1,'drive');
INSERT INTO motion VALUES(1,1,'Y','workpiece',1,'drive');
INSERT INTO motion VALUES(1,2,'Z','tool',1,'');
INSERT INTO motion VALUES(2,0,'X','workpiece',1,'');
INSERT INTO motion VALUES(2,1,'Y','workpiece',1,'');
INSERT INTO motion VALUES(2,2,'Z','workpiece',1,'');
INSERT INTO motion VALUES(3,0,'X','workpiece',1,'');
INSERT INTO motion VALUES(3,1,'Y','workpiece',1,'');
INSERT INTO motion VALUES(3,2,'Z','workpiece',1,'');
CREATE TABLE provenance(
  id INTEGER PRIMARY KEY,
  program_version TEXT NOT NULL CHECK(program_version <> ''),
  plugins TEXT NOT NULL,
  source_path TEXT NOT NULL,
  source_hash TEXT NOT NULL CHECK(length(source_hash) = 64),
  UNIQUE(source_hash, source_path, program_version, plugins)
) STRICT;
INSERT INTO provenance VALUES(1,'0.1.0','org.kompono.lambda 1.0.0, org.kompono.units 1.2.0','layouts/machines/lambda.toml','b8a7a1be489b860ce4872264c9739b34d261ed8f7fe1fd53a016c58537b8cace');
INSERT INTO provenance VALUES(2,'0.1.0','org.kompono.units 1.2.0','knee.toml','9768a4c04d1cbcdb62b64cb0ddb5ad39f8fefd194065a9c51ce7d07042380223');
INSERT INTO provenance VALUES(3,'0.1.0','org.kompono.hexapod 2.0.1','knee.toml','9dc60e07e72ae1bdcd087f49fa6a1324b0d9a7f6309e7331b9c423d4ce8c574a');
CREATE TABLE provenance_plugin(
  provenance_id INTEGER NOT NULL REFERENCES provenance(id) ON DELETE CASCADE,
  plugin TEXT NOT NULL CHECK(plugin <> ''),
  version TEXT NOT NULL,
  PRIMARY KEY(provenance_id, plugin)
) STRICT, WITHOUT ROWID;
INSERT INTO provenance_plugin VALUES(1,'org.kompono.lambda','1.0.0');
INSERT INTO provenance_plugin VALUES(1,'org.kompono.units','1.2.0');
INSERT INTO provenance_plugin VALUES(2,'org.kompono.units','1.2.0');
INSERT INTO provenance_plugin VALUES(3,'org.kompono.hexapod','2.0.1');
CREATE TABLE module(
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL CHECK(name <> ''),
  plugin TEXT NOT NULL,
  UNIQUE(name, plugin)
) STRICT;
INSERT INTO module VALUES(1,'lambda','org.kompono.lambda');
INSERT INTO module VALUES(2,'jet_head','org.kompono.units');
INSERT INTO module VALUES(3,'spindle','org.kompono.units');
INSERT INTO module VALUES(4,'hexapod','org.kompono.hexapod');
CREATE TABLE quantity(
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL CHECK(name <> ''),
  unit TEXT NOT NULL,
  UNIQUE(name, unit)
) STRICT;
INSERT INTO quantity VALUES(1,'drive.L1','mm');
INSERT INTO quantity VALUES(2,'drive.L2','mm');
INSERT INTO quantity VALUES(5,'spindle.length','mm');
INSERT INTO quantity VALUES(6,'struts.radius','mm');
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
INSERT INTO layout VALUES(1,X'58ce1d95f7f009acc17d8d796e7764c2787d1ed8019018ff7c330b4a69454e04','Lambda water-jet',1,3,3,1,'2026-11-23T15:26:25Z');
INSERT INTO layout VALUES(2,X'3a2351f2a3bc8cb686cc5c86e77e14a77f965e77f4724835dd80368554470f25','Knee mill',2,3,3,2,'2026-11-23T15:26:25Z');
INSERT INTO layout VALUES(3,X'69000d3f3a5ae162f5d43da285be4cf204b0a6e88db0469c7014ceb3df7dbb58','Hexapod',3,6,6,3,'2026-11-23T15:26:25Z');
CREATE TABLE layout_text(
  layout_id INTEGER PRIMARY KEY REFERENCES layout(id) ON DELETE CASCADE,
  toml TEXT NOT NULL,
  content TEXT
) STRICT;
INSERT INTO layout_text VALUES(1,replace('kompono = 1\nname = "Lambda water-jet"\n','\n',char(10)),NULL);
INSERT INTO layout_text VALUES(2,replace('kompono = 1\nname = "Knee mill"\n','\n',char(10)),NULL);
INSERT INTO layout_text VALUES(3,replace('kompono = 1\nname = "Hexapod"\n','\n',char(10)),NULL);
CREATE TABLE layout_block(
  layout_id INTEGER NOT NULL REFERENCES layout(id) ON DELETE CASCADE,
  position INTEGER NOT NULL CHECK(position >= 0),
  name TEXT NOT NULL CHECK(name <> ''),
  module_id INTEGER NOT NULL REFERENCES module(id),
  PRIMARY KEY(layout_id, position)
) STRICT, WITHOUT ROWID;
INSERT INTO layout_block VALUES(1,0,'drive',1);
INSERT INTO layout_block VALUES(1,1,'tool',2);
INSERT INTO layout_block VALUES(2,0,'spindle',3);
INSERT INTO layout_block VALUES(3,0,'struts',4);
CREATE TABLE parameter(
  layout_id INTEGER NOT NULL REFERENCES layout(id) ON DELETE CASCADE,
  quantity_id INTEGER NOT NULL REFERENCES quantity(id),
  value REAL NOT NULL,
  PRIMARY KEY(layout_id, quantity_id)
) STRICT, WITHOUT ROWID;
INSERT INTO parameter VALUES(1,1,1200.0);
INSERT INTO parameter VALUES(1,2,820.49999999999999999);
INSERT INTO parameter VALUES(2,5,300.0);
INSERT INTO parameter VALUES(3,6,400.0);
CREATE INDEX formula_by_distribution ON formula(distribution);
CREATE INDEX formula_by_relative_motion ON formula(relative_motion);
CREATE INDEX layout_by_name ON layout(name);
CREATE INDEX layout_by_formula ON layout(formula_id);
CREATE INDEX layout_block_by_module ON layout_block(module_id);
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
PRAGMA application_id = 1263488336;
PRAGMA user_version = 1;
COMMIT;
