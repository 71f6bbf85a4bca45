-- SPDX-License-Identifier: Apache-2.0
-- A catalog of schema 2: what 'sqlite3 FILE .dump' printed of the catalog of schema 1 after the next program had added
-- a calibrated layout with its report, and the two numbers of the header.
PRAGMA foreign_keys=OFF;
BEGIN TRANSACTION;
CREATE TABLE schema_history(
  version INTEGER PRIMARY KEY,
  name TEXT NOT NULL,
  program_version TEXT NOT NULL,
  applied_at TEXT NOT NULL
) STRICT;
INSERT INTO schema_history VALUES(1,'layouts','0.1.0','2026-11-23T15:26:25Z');
INSERT INTO schema_history VALUES(2,'results','0.1.0','2026-11-23T22:03:16Z');
CREATE TABLE formula(
  id INTEGER PRIMARY KEY,
  text TEXT NOT NULL UNIQUE CHECK(text <> ''),
  distribution TEXT NOT NULL,
  relative_motion TEXT NOT NULL,
  base TEXT NOT NULL CHECK(base IN ('closed', 'open'))
) STRICT;
INSERT INTO formula VALUES(1,'part_xy (XY):drive O|O Z P_z','part_xy (XY):drive O|O Z P_z','part_xy (XY):drive Z P_z','open');
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
INSERT INTO provenance VALUES(4,'0.1.0','org.kompono.lambda 0.1.0, org.kompono.units 0.1.0','out.toml','d3b58d9c6b849e9f01014f3f0db95e23bf19c761fbd173f6a02e98d9c306ba15');
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
INSERT INTO provenance_plugin VALUES(4,'org.kompono.lambda','0.1.0');
INSERT INTO provenance_plugin VALUES(4,'org.kompono.units','0.1.0');
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
INSERT INTO quantity VALUES(7,'drive.L3','mm');
INSERT INTO quantity VALUES(8,'drive.mount.x','mm');
INSERT INTO quantity VALUES(9,'drive.mount.y','mm');
INSERT INTO quantity VALUES(10,'drive.mount.z','mm');
INSERT INTO quantity VALUES(11,'drive.mount.a','deg');
INSERT INTO quantity VALUES(12,'drive.mount.b','deg');
INSERT INTO quantity VALUES(13,'drive.mount.c','deg');
INSERT INTO quantity VALUES(14,'drive.q1.zero','mm');
INSERT INTO quantity VALUES(15,'drive.q2.zero','mm');
INSERT INTO quantity VALUES(16,'Z.position.x','mm');
INSERT INTO quantity VALUES(17,'Z.position.y','mm');
INSERT INTO quantity VALUES(18,'Z.position.z','mm');
INSERT INTO quantity VALUES(19,'Z.rotation.a','deg');
INSERT INTO quantity VALUES(20,'Z.rotation.b','deg');
INSERT INTO quantity VALUES(21,'Z.rotation.c','deg');
INSERT INTO quantity VALUES(22,'Z.zero','mm');
INSERT INTO quantity VALUES(23,'open_base.x','mm');
INSERT INTO quantity VALUES(24,'open_base.y','mm');
INSERT INTO quantity VALUES(25,'open_base.z','mm');
INSERT INTO quantity VALUES(26,'open_base.a','deg');
INSERT INTO quantity VALUES(27,'open_base.b','deg');
INSERT INTO quantity VALUES(28,'open_base.c','deg');
INSERT INTO quantity VALUES(29,'part.mount.x','mm');
INSERT INTO quantity VALUES(30,'part.mount.y','mm');
INSERT INTO quantity VALUES(31,'part.mount.z','mm');
INSERT INTO quantity VALUES(32,'part.mount.a','deg');
INSERT INTO quantity VALUES(33,'part.mount.b','deg');
INSERT INTO quantity VALUES(34,'part.mount.c','deg');
INSERT INTO quantity VALUES(35,'P_z.nozzle_length','mm');
INSERT INTO quantity VALUES(36,'P_z.chamber_length','mm');
INSERT INTO quantity VALUES(37,'P_z.tube_length','mm');
INSERT INTO quantity VALUES(38,'P_z.stand_off','mm');
INSERT INTO quantity VALUES(39,'P_z.chamber_offset[1]','mm');
INSERT INTO quantity VALUES(40,'P_z.chamber_offset[2]','mm');
INSERT INTO quantity VALUES(41,'P_z.chamber_tilt[1]','deg');
INSERT INTO quantity VALUES(42,'P_z.chamber_tilt[2]','deg');
INSERT INTO quantity VALUES(43,'P_z.tube_offset[1]','mm');
INSERT INTO quantity VALUES(44,'P_z.tube_offset[2]','mm');
INSERT INTO quantity VALUES(45,'P_z.tube_tilt[1]','deg');
INSERT INTO quantity VALUES(46,'P_z.tube_tilt[2]','deg');
INSERT INTO quantity VALUES(47,'P_z.edge_offset[1]','mm');
INSERT INTO quantity VALUES(48,'P_z.edge_offset[2]','mm');
INSERT INTO quantity VALUES(49,'P_z.mount.x','mm');
INSERT INTO quantity VALUES(50,'P_z.mount.y','mm');
INSERT INTO quantity VALUES(51,'P_z.mount.z','mm');
INSERT INTO quantity VALUES(52,'P_z.mount.a','deg');
INSERT INTO quantity VALUES(53,'P_z.mount.b','deg');
INSERT INTO quantity VALUES(54,'P_z.mount.c','deg');
INSERT INTO quantity VALUES(55,'singularity_margin','1');
INSERT INTO quantity VALUES(56,'singularity_type','1');
INSERT INTO quantity VALUES(57,'mobility.drive','1');
INSERT INTO quantity VALUES(58,'gruebler.drive','1');
INSERT INTO quantity VALUES(59,'loops.drive','1');
CREATE TABLE layout(
  id INTEGER PRIMARY KEY,
  content_hash BLOB NOT NULL UNIQUE CHECK(length(content_hash) = 32),
  name TEXT NOT NULL CHECK(name <> ''),
  formula_id INTEGER NOT NULL REFERENCES formula(id),
  coordinates INTEGER NOT NULL CHECK(coordinates >= 0),
  drives INTEGER NOT NULL CHECK(drives >= 0),
  provenance_id INTEGER NOT NULL REFERENCES provenance(id),
  added_at TEXT NOT NULL CHECK(added_at GLOB '????-??-??T??:??:??Z')
, rms_before_um REAL, rms_after_um REAL) STRICT;
INSERT INTO layout VALUES(1,X'58ce1d95f7f009acc17d8d796e7764c2787d1ed8019018ff7c330b4a69454e04','Lambda water-jet',1,3,3,1,'2026-11-23T15:26:25Z',NULL,NULL);
INSERT INTO layout VALUES(2,X'3a2351f2a3bc8cb686cc5c86e77e14a77f965e77f4724835dd80368554470f25','Knee mill',2,3,3,2,'2026-11-23T15:26:25Z',NULL,NULL);
INSERT INTO layout VALUES(3,X'69000d3f3a5ae162f5d43da285be4cf204b0a6e88db0469c7014ceb3df7dbb58','Hexapod',3,6,6,3,'2026-11-23T15:26:25Z',NULL,NULL);
INSERT INTO layout VALUES(4,X'f7aeee414fcf92a727fdebcb969f509519ad44bd5b6e3628dd590bdd085c8939','Open-base water-jet with a lambda sheet drive',1,3,3,4,'2026-11-23T22:03:16Z',799.87180680746951112,7.090480684891973695);
CREATE TABLE layout_text(
  layout_id INTEGER PRIMARY KEY REFERENCES layout(id) ON DELETE CASCADE,
  toml TEXT NOT NULL,
  content TEXT
) STRICT;
INSERT INTO layout_text VALUES(1,replace('kompono = 1\nname = "Lambda water-jet"\n','\n',char(10)),NULL);
INSERT INTO layout_text VALUES(2,replace('kompono = 1\nname = "Knee mill"\n','\n',char(10)),NULL);
INSERT INTO layout_text VALUES(3,replace('kompono = 1\nname = "Hexapod"\n','\n',char(10)),NULL);
INSERT INTO layout_text VALUES(4,replace('# SPDX-License-Identifier: Apache-2.0\n# SO''s water-jet machine with an open base: the lambda mechanism moves the sheet on its own foundation, the jet head stands\n# on another one; the two are coupled only electronically.\n# From SO: the kind of machine, levers of 1200 mm, a stiffness of 0.05 N/um. Chosen here to make a machine of it: L2, L3, the\n# work zone, speeds, and where the foundations stand. With L2 > L3 the only type 1 singularity is at Y = L1, far from the\n# work zone, and the sliders never meet.\nkompono     = 1\nname        = "Open-base water-jet with a lambda sheet drive"\ndescription = "The sheet is moved in X and Y by two sliders on one rail; the jet head moves in Z on its own foundation."\nformula     = "part_xy (XY):drive O|O Z P_z"\nunits       = { length = "mm", angle = "deg" }\n\n[block.drive]\nmodule     = "lambda"\nparameters = { L1 = 1200.7795619524752, L2 = 820.0070445650988, L3 = 599.9960571011071 }\nmode       = { q1 = "+", q2 = "+", side = "+" }\nmount      = { position = [0, 0, 0], rotation = [0, 0, 0] }\nhome       = { X = 500, Y = 600 }\nrange      = { X = [0, 1000], Y = [200, 1000] }\n\n[block.drive.drive.q1]\nrange = [-1300, 500]\nspeed = 40000                # mm/min\nacceleration = 5000          # mm/s²\nstiffness = 0.05             # N/µm, SO: this and the levers'' inertia make the dynamic error of 0.38 to 0.45 mm\n\n[block.drive.drive.q2]\nrange = [100, 1500]\nspeed = 40000\nacceleration = 5000\nstiffness = 0.05\nzero = 0.0046699703986737735\n\n[axis.Z]\nrange = [0, 150]\nspeed = 6000\nacceleration = 1000\n\n# With the sheet in the middle of its way the jet stands over the sheet''s datum; at Z = 0 the jet''s stand-off point, 134 mm\n# below the head''s face, lies in the sheet.\n[open_base]\nposition = [499.98175680930956, 599.9902159239133, 134]\nrotation = [0, 0, 0]\n\n[tool]\nmodule     = "jet_head"\nparameters = { nozzle_length = 25, chamber_length = 30, tube_length = 76, stand_off = 3 }\n\n# What measurements of the jet over the sheet can tell. A common shift of both sliders along their rail is the same as a\n# shift of the other foundation along X, so one of the zeros stays. The jet''s offset at the tube''s edge is the same as a\n# shift of the foundation while the head does not turn, and the foundation''s turn about the jet moves nothing: both stay.\n# L2, L3 and the slider''s zero do nearly the same to the sheet; what the workshop says of them keeps them apart.\n[calibration]\nfree = ["drive.L1", "drive.L2", "drive.L3", "drive.q2.zero", "open_base.x", "open_base.y"]\n\n[calibration.prior]\n"drive.L*"      = 0.1\n"drive.q2.zero" = 0.1\n\n[calibrated]\nsource = "p.csv (sha256 0f4c8ac19fa386167d95daa985aaa48e4a3242840a6849bf8ed806337dfa5987)"\n\n[calibrated.nominal]\n"drive.L1" = 1200\n"drive.L2" = 820\n"drive.L3" = 600\n"drive.q2.zero" = 0\n"open_base.x" = 500\n"open_base.y" = 600\n\n[calibrated.sigma]\n"drive.L1" = 0.012094843306325391\n"drive.L2" = 0.060327211287986064\n"drive.L3" = 0.01398042658603892\n"drive.q2.zero" = 0.0740059219576427\n"open_base.x" = 0.010966664751543601\n"open_base.y" = 0.0060837418879118674\n','\n',char(10)),NULL);
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
INSERT INTO layout_block VALUES(4,0,'drive',1);
INSERT INTO layout_block VALUES(4,1,'P_z',2);
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
INSERT INTO parameter VALUES(4,1,1200.7795619524752055);
INSERT INTO parameter VALUES(4,2,820.00704456509879488);
INSERT INTO parameter VALUES(4,7,599.99605710110711243);
INSERT INTO parameter VALUES(4,8,0.0);
INSERT INTO parameter VALUES(4,9,0.0);
INSERT INTO parameter VALUES(4,10,0.0);
INSERT INTO parameter VALUES(4,11,0.0);
INSERT INTO parameter VALUES(4,12,0.0);
INSERT INTO parameter VALUES(4,13,0.0);
INSERT INTO parameter VALUES(4,14,0.0);
INSERT INTO parameter VALUES(4,15,0.0046699703986737735317);
INSERT INTO parameter VALUES(4,16,0.0);
INSERT INTO parameter VALUES(4,17,0.0);
INSERT INTO parameter VALUES(4,18,0.0);
INSERT INTO parameter VALUES(4,19,0.0);
INSERT INTO parameter VALUES(4,20,0.0);
INSERT INTO parameter VALUES(4,21,0.0);
INSERT INTO parameter VALUES(4,22,0.0);
INSERT INTO parameter VALUES(4,23,499.98175680930955879);
INSERT INTO parameter VALUES(4,24,599.99021592391329703);
INSERT INTO parameter VALUES(4,25,134.0);
INSERT INTO parameter VALUES(4,26,0.0);
INSERT INTO parameter VALUES(4,27,0.0);
INSERT INTO parameter VALUES(4,28,0.0);
INSERT INTO parameter VALUES(4,29,0.0);
INSERT INTO parameter VALUES(4,30,0.0);
INSERT INTO parameter VALUES(4,31,0.0);
INSERT INTO parameter VALUES(4,32,0.0);
INSERT INTO parameter VALUES(4,33,0.0);
INSERT INTO parameter VALUES(4,34,0.0);
INSERT INTO parameter VALUES(4,35,25.0);
INSERT INTO parameter VALUES(4,36,30.0);
INSERT INTO parameter VALUES(4,37,76.0);
INSERT INTO parameter VALUES(4,38,3.0);
INSERT INTO parameter VALUES(4,39,0.0);
INSERT INTO parameter VALUES(4,40,0.0);
INSERT INTO parameter VALUES(4,41,0.0);
INSERT INTO parameter VALUES(4,42,0.0);
INSERT INTO parameter VALUES(4,43,0.0);
INSERT INTO parameter VALUES(4,44,0.0);
INSERT INTO parameter VALUES(4,45,0.0);
INSERT INTO parameter VALUES(4,46,0.0);
INSERT INTO parameter VALUES(4,47,0.0);
INSERT INTO parameter VALUES(4,48,0.0);
INSERT INTO parameter VALUES(4,49,0.0);
INSERT INTO parameter VALUES(4,50,0.0);
INSERT INTO parameter VALUES(4,51,0.0);
INSERT INTO parameter VALUES(4,52,0.0);
INSERT INTO parameter VALUES(4,53,0.0);
INSERT INTO parameter VALUES(4,54,0.0);
CREATE TABLE term(
  id INTEGER PRIMARY KEY,
  text TEXT NOT NULL UNIQUE
) STRICT;
INSERT INTO term VALUES(1,'at home');
INSERT INTO term VALUES(2,'process_jet');
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
INSERT INTO metric VALUES(4,55,1,0.61355000475565524276,NULL,4);
INSERT INTO metric VALUES(4,56,1,0.0,NULL,4);
INSERT INTO metric VALUES(4,57,1,2.0,NULL,4);
INSERT INTO metric VALUES(4,58,1,2.0,NULL,4);
INSERT INTO metric VALUES(4,59,1,1.0,NULL,4);
CREATE TABLE capability(
  layout_id INTEGER NOT NULL REFERENCES layout(id) ON DELETE CASCADE,
  name_id INTEGER NOT NULL REFERENCES term(id),
  detail TEXT NOT NULL,
  provenance_id INTEGER NOT NULL REFERENCES provenance(id),
  PRIMARY KEY(layout_id, name_id)
) STRICT, WITHOUT ROWID;
INSERT INTO capability VALUES(4,2,'P_z',4);
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
INSERT INTO calibration VALUES(1,4,X'dc75c2721b3956fc404a3b8e4aa355c753b72dcf39267115ff83272c9c0700ef','p.csv','0f4c8ac19fa386167d95daa985aaa48e4a3242840a6849bf8ed806337dfa5987','converged',799.87180680746951112,7.090480684891973695,NULL,178,4,'2026-11-23T22:03:16Z','{"calibrated_layout":"out.toml","chi_squared":249.31131815756964,"correlated":[{"correlation":0.9940690991222353,"first":"drive.L1","second":"open_base.x"},{"correlation":0.9503704370196497,"first":"drive.L1","second":"open_base.y"},{"correlation":0.9547287998927455,"first":"drive.L2","second":"drive.L3"},{"correlation":0.9989283393424696,"first":"drive.L2","second":"drive.q2.zero"},{"correlation":0.9672113273641337,"first":"drive.L3","second":"drive.q2.zero"}],"cost_after":124.65565907878482,"cost_before":1199615.4512352112,"diagnostics":[{"code":"W0454","file":"p.csv","help":"look at the rows with the largest residuals, free more parameters, or give larger deviations","message":"the errors left are 1.18 times what the given deviations allow: the measurements contradict each other or this model of the machine","severity":"warning"}],"dof":178,"errors":[{"count":60,"held_out":false,"max_after_mm":0.015549139052152324,"max_before_mm":0.8098017742353719,"quantity":"position","rms_after_mm":0.0070904806848919736,"rms_before_mm":0.7998718068074695}],"free_parameters":6,"iterations":3,"layout":"jet.toml","measurements":[{"file":"p.csv","sha256":"0f4c8ac19fa386167d95daa985aaa48e4a3242840a6849bf8ed806337dfa5987"}],"numbers":180,"ok":true,"parameters":[{"after_mm":1200.7795619524752,"at_bound":false,"before_mm":1200.0,"change_mm":0.7795619524752055,"determined":true,"name":"drive.L1","sigma_mm":0.012094843306325391,"unit":"mm"},{"after_mm":820.0070445650988,"at_bound":false,"before_mm":820.0,"change_mm":0.007044565098794919,"determined":true,"name":"drive.L2","sigma_mm":0.060327211287986064,"unit":"mm"},{"after_mm":599.9960571011071,"at_bound":false,"before_mm":600.0,"change_mm":-0.00394289889288757,"determined":true,"name":"drive.L3","sigma_mm":0.01398042658603892,"unit":"mm"},{"after_mm":0.0046699703986737735,"at_bound":false,"before_mm":0.0,"change_mm":0.0046699703986737735,"determined":true,"name":"drive.q2.zero","sigma_mm":0.0740059219576427,"unit":"mm"},{"after_mm":499.98175680930956,"at_bound":false,"before_mm":500.0,"change_mm":-0.018243190690441224,"determined":true,"name":"open_base.x","sigma_mm":0.010966664751543601,"unit":"mm"},{"after_mm":599.9902159239133,"at_bound":false,"before_mm":600.0,"change_mm":-0.009784076086702953,"determined":true,"name":"open_base.y","sigma_mm":0.0060837418879118674,"unit":"mm"}],"rank":6,"rows":[{"after_mm":0.0032409808543147497,"after_sigmas":0.46779529216926097,"before_mm":0.7993460026404895,"held_out":false,"kind":"position","line":5,"rejected":false,"row":1},{"after_mm":0.005521538044147367,"after_sigmas":0.7969653690323105,"before_mm":0.8035504789595267,"held_out":false,"kind":"position","line":6,"rejected":false,"row":2},{"after_mm":0.007050512036641956,"after_sigmas":1.0176537555699825,"before_mm":0.7985992503806696,"held_out":false,"kind":"position","line":7,"rejected":false,"row":3},{"after_mm":0.004852289880135159,"after_sigmas":0.7003677171205327,"before_mm":0.8048952648953164,"held_out":false,"kind":"position","line":8,"rejected":false,"row":4},{"after_mm":0.005244260629661165,"after_sigmas":0.7569438215588574,"before_mm":0.7949389492933061,"held_out":false,"kind":"position","line":9,"rejected":false,"row":5},{"after_mm":0.010234510714084792,"after_sigmas":1.477224378950241,"before_mm":0.809363419711826,"held_out":false,"kind":"position","line":10,"rejected":false,"row":6},{"after_mm":0.00644988651921962,"after_sigmas":0.9309609295284964,"before_mm":0.801910795555518,"held_out":false,"kind":"position","line":11,"rejected":false,"row":7},{"after_mm":0.005935955742121186,"after_sigmas":0.856781411402843,"before_mm":0.8013924998363536,"held_out":false,"kind":"position","line":12,"rejected":false,"row":8},{"after_mm":0.005108350035260681,"after_sigmas":0.7373268169931471,"before_mm":0.8045397818720406,"held_out":false,"kind":"position","line":13,"rejected":false,"row":9},{"after_mm":0.0033515667186403055,"after_sigmas":0.48375698680349277,"before_mm":0.7979493781268847,"held_out":false,"kind":"position","line":14,"rejected":false,"row":10},{"after_mm":0.006662975238798212,"after_sigmas":0.9617176369309897,"before_mm":0.8040395466425801,"held_out":false,"kind":"position","line":15,"rejected":false,"row":11},{"after_mm":0.005872088745608554,"after_sigmas":0.8475630044956177,"before_mm":0.796535451188404,"held_out":false,"kind":"position","line":16,"rejected":false,"row":12},{"after_mm":0.002815782564301614,"after_sigmas":0.4064232053697479,"before_mm":0.7973799858955933,"held_out":false,"kind":"position","line":17,"rejected":false,"row":13},{"after_mm":0.004458458828280129,"after_sigmas":0.643523101169599,"before_mm":0.802323032897945,"held_out":false,"kind":"position","line":18,"rejected":false,"row":14},{"after_mm":0.005989559285897651,"after_sigmas":0.8645184165100579,"before_mm":0.7929330516336998,"held_out":false,"kind":"position","line":19,"rejected":false,"row":15},{"after_mm":0.008460808359202737,"after_sigmas":1.2212124959368842,"before_mm":0.800858785535306,"held_out":false,"kind":"position","line":20,"rejected":false,"row":16},{"after_mm":0.005812624613457262,"after_sigmas":0.8389800963194488,"before_mm":0.8000094977719938,"held_out":false,"kind":"position","line":21,"rejected":false,"row":17},{"after_mm":0.008922781708251446,"after_sigmas":1.2878926052948105,"before_mm":0.8054561565151523,"held_out":false,"kind":"position","line":22,"rejected":false,"row":18},{"after_mm":0.015549139052152324,"after_sigmas":2.2443249043567666,"before_mm":0.80681204519291,"held_out":false,"kind":"position","line":23,"rejected":false,"row":19},{"after_mm":0.011245111838748269,"after_sigmas":1.62309208679219,"before_mm":0.7940043867124001,"held_out":false,"kind":"position","line":24,"rejected":false,"row":20},{"after_mm":0.00985159658322724,"after_sigmas":1.4219554848184612,"before_mm":0.7955543421193543,"held_out":false,"kind":"position","line":25,"rejected":false,"row":21},{"after_mm":0.010107757670935323,"after_sigmas":1.4589291530545032,"before_mm":0.7977555048768588,"held_out":false,"kind":"position","line":26,"rejected":false,"row":22},{"after_mm":0.011099800479697561,"after_sigmas":1.602118198726131,"before_mm":0.7949230563695934,"held_out":false,"kind":"position","line":27,"rejected":false,"row":23},{"after_mm":0.0027209061696840966,"after_sigmas":0.3927289773767067,"before_mm":0.8006332162977331,"held_out":false,"kind":"position","line":28,"rejected":false,"row":24},{"after_mm":0.0024373687461195885,"after_sigmas":0.3518038754216313,"before_mm":0.8018042539487679,"held_out":false,"kind":"position","line":29,"rejected":false,"row":25},{"after_mm":0.010137380968365589,"after_sigmas":1.4632049077409155,"before_mm":0.8098017742353719,"held_out":false,"kind":"position","line":30,"rejected":false,"row":26},{"after_mm":0.0031194054808029387,"after_sigmas":0.4502473985132927,"before_mm":0.7974832746080917,"held_out":false,"kind":"position","line":31,"rejected":false,"row":27},{"after_mm":0.012645748368475377,"after_sigmas":1.8252565561608827,"before_mm":0.7902980732901476,"held_out":false,"kind":"position","line":32,"rejected":false,"row":28},{"after_mm":0.011731619524835951,"after_sigmas":1.6933134226735764,"before_mm":0.7949456752347469,"held_out":false,"kind":"position","line":33,"rejected":false,"row":29},{"after_mm":0.0032511233494115473,"after_sigmas":0.4692592352378586,"before_mm":0.8008378705277529,"held_out":false,"kind":"position","line":34,"rejected":false,"row":30},{"after_mm":0.0034136836910717925,"after_sigmas":0.49272279949213366,"before_mm":0.797817310707441,"held_out":false,"kind":"position","line":35,"rejected":false,"row":31},{"after_mm":0.006592138081670161,"after_sigmas":0.9514931739968627,"before_mm":0.8007744939050978,"held_out":false,"kind":"position","line":36,"rejected":false,"row":32},{"after_mm":0.005425781018334764,"after_sigmas":0.7831440328748844,"before_mm":0.8011898473302632,"held_out":false,"kind":"position","line":37,"rejected":false,"row":33},{"after_mm":0.007983193927355752,"after_sigmas":1.1522747907379574,"before_mm":0.7941719591799504,"held_out":false,"kind":"position","line":38,"rejected":false,"row":34},{"after_mm":0.011306635647997642,"after_sigmas":1.6319722837501143,"before_mm":0.7994350890079585,"held_out":false,"kind":"position","line":39,"rejected":false,"row":35},{"after_mm":0.005381320674950973,"after_sigmas":0.7767267350696608,"before_mm":0.7981912988104627,"held_out":false,"kind":"position","line":40,"rejected":false,"row":36},{"after_mm":0.006730945661436851,"after_sigmas":0.9715283223828274,"before_mm":0.799019877314994,"held_out":false,"kind":"position","line":41,"rejected":false,"row":37},{"after_mm":0.00603424719878909,"after_sigmas":0.8709685611444066,"before_mm":0.7983323362814451,"held_out":false,"kind":"position","line":42,"rejected":false,"row":38},{"after_mm":0.00449869521688607,"after_sigmas":0.6493307236178135,"before_mm":0.8006624361900265,"held_out":false,"kind":"position","line":43,"rejected":false,"row":39},{"after_mm":0.0029554792345042103,"after_sigmas":0.4265866829063387,"before_mm":0.8005883948098288,"held_out":false,"kind":"position","line":44,"rejected":false,"row":40},{"after_mm":0.005447180064895035,"after_sigmas":0.7862327191978777,"before_mm":0.8001931250544582,"held_out":false,"kind":"position","line":45,"rejected":false,"row":41},{"after_mm":0.007296783738197226,"after_sigmas":1.0532000138666628,"before_mm":0.7993275368971168,"held_out":false,"kind":"position","line":46,"rejected":false,"row":42},{"after_mm":0.0055133664864888705,"after_sigmas":0.7957859062788527,"before_mm":0.8056318639924122,"held_out":false,"kind":"position","line":47,"rejected":false,"row":43},{"after_mm":0.00270013256398425,"after_sigmas":0.3897305656659953,"before_mm":0.7990624407239405,"held_out":false,"kind":"position","line":48,"rejected":false,"row":44},{"after_mm":0.006019609527159311,"after_sigmas":0.868855795230466,"before_mm":0.8047515868488014,"held_out":false,"kind":"position","line":49,"rejected":false,"row":45},{"after_mm":0.0030216387496207276,"after_sigmas":0.4361359863718328,"before_mm":0.8008633901403425,"held_out":false,"kind":"position","line":50,"rejected":false,"row":46},{"after_mm":0.004868584890766535,"after_sigmas":0.7027196993141509,"before_mm":0.8021217346137388,"held_out":false,"kind":"position","line":51,"rejected":false,"row":47},{"after_mm":0.008898264003286178,"after_sigmas":1.284353779404408,"before_mm":0.791815121468308,"held_out":false,"kind":"position","line":52,"rejected":false,"row":48},{"after_mm":0.001399685613727538,"after_sigmas":0.20202721646661018,"before_mm":0.7998035147265247,"held_out":false,"kind":"position","line":53,"rejected":false,"row":49},{"after_mm":0.004110247423184344,"after_sigmas":0.5932631140528617,"before_mm":0.8004894929358415,"held_out":false,"kind":"position","line":54,"rejected":false,"row":50},{"after_mm":0.01029177026344922,"after_sigmas":1.485489083010048,"before_mm":0.8001938282466765,"held_out":false,"kind":"position","line":55,"rejected":false,"row":51},{"after_mm":0.00518674078173659,"after_sigmas":0.7486415466381076,"before_mm":0.7987183671593854,"held_out":false,"kind":"position","line":56,"rejected":false,"row":52},{"after_mm":0.01145041504546302,"after_sigmas":1.6527250522077541,"before_mm":0.7965385369947938,"held_out":false,"kind":"position","line":57,"rejected":false,"row":53},{"after_mm":0.0031536315869499097,"after_sigmas":0.4551875114126093,"before_mm":0.797064112454108,"held_out":false,"kind":"position","line":58,"rejected":false,"row":54},{"after_mm":0.006090760863834595,"after_sigmas":0.8791256060761352,"before_mm":0.8035372769844039,"held_out":false,"kind":"position","line":59,"rejected":false,"row":55},{"after_mm":0.004058261653276655,"after_sigmas":0.5857596144903031,"before_mm":0.7979701458187647,"held_out":false,"kind":"position","line":60,"rejected":false,"row":56},{"after_mm":0.007280723972903013,"after_sigmas":1.050881986412729,"before_mm":0.804176146460182,"held_out":false,"kind":"position","line":61,"rejected":false,"row":57},{"after_mm":0.0059433157983591126,"after_sigmas":0.8578437440153972,"before_mm":0.8008668591781972,"held_out":false,"kind":"position","line":62,"rejected":false,"row":58},{"after_mm":0.009063937471007468,"after_sigmas":1.3082666847010245,"before_mm":0.7987956695457852,"held_out":false,"kind":"position","line":63,"rejected":false,"row":59},{"after_mm":0.0015072462242120483,"after_sigmas":0.21755225332096825,"before_mm":0.7987678213147567,"held_out":false,"kind":"position","line":64,"rejected":false,"row":60}],"rows_fitted":60,"rows_held_out":0,"rows_rejected":[],"scaled_condition":1096.1836032762214,"sigma0":1.1834801996263793,"sigma_assumed":false,"solver_message":"converged","solver_ms":0.360862,"status":"converged","tool_sigma_max_mm":0.0021490023773102726,"tool_sigma_rms_mm":0.0011609423015331495,"total_ms":1.864961,"unidentifiable":[]}');
CREATE INDEX formula_by_distribution ON formula(distribution);
CREATE INDEX formula_by_relative_motion ON formula(relative_motion);
CREATE INDEX layout_by_name ON layout(name);
CREATE INDEX layout_by_formula ON layout(formula_id);
CREATE INDEX layout_block_by_module ON layout_block(module_id);
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
CREATE INDEX metric_by_value ON metric(quantity_id, value);
CREATE INDEX capability_by_name ON capability(name_id);
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
PRAGMA application_id = 1263488336;
PRAGMA user_version = 2;
COMMIT;
