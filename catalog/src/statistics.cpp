// SPDX-License-Identifier: Apache-2.0
#include "reading.hpp"
#include "schema.hpp"
#include <nlohmann/json.hpp>

namespace kompono::catalog {
namespace {

std::int64_t CountOf(SQLite::Database& db, const char* query) {
  return db.execAndGet(query).getInt64();
}

std::vector<Count> CountsOf(SQLite::Database& db, const char* query) {
  std::vector<Count> counts;
  SQLite::Statement row(db, query);
  while (row.executeStep())
    counts.emplace_back(row.getColumn(0).getString(), row.getColumn(1).getInt64());
  return counts;
}

nlohmann::ordered_json CountsJson(const std::vector<Count>& counts) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, count] : counts) json[name] = count;
  return json;
}

}  // namespace

Statistics ReadStatistics(SQLite::Database& db) {
  Statistics s;
  s.schema_version = VersionOf(db);
  s.file_bytes = CountOf(db, "PRAGMA page_count") * CountOf(db, "PRAGMA page_size");
  s.layouts = CountOf(db, "SELECT count(*) FROM layout");
  s.open_base_layouts = CountOf(db,
                                "SELECT count(*) FROM layout AS l JOIN formula AS f ON f.id = "
                                "l.formula_id WHERE f.base = 'open'");
  s.calibrated_layouts = CountOf(db, "SELECT count(DISTINCT layout_id) FROM calibration");
  s.formulas = CountOf(db, "SELECT count(*) FROM formula");
  s.distributions =
      CountOf(db, "SELECT count(DISTINCT distribution) FROM formula WHERE distribution <> ''");
  s.relative_motions = CountOf(
      db, "SELECT count(DISTINCT relative_motion) FROM formula WHERE relative_motion <> ''");
  s.parameters = CountOf(db, "SELECT count(*) FROM parameter");
  s.metrics = CountOf(db, "SELECT count(*) FROM metric");
  s.failed_metrics = CountOf(db, "SELECT count(*) FROM metric WHERE value IS NULL");
  s.calibrations = CountOf(db, "SELECT count(*) FROM calibration");
  const auto evaluations = [&db](const char* status) {
    SQLite::Statement row(db,
                          "SELECT count(*) FROM verdict AS v JOIN evaluation AS e "
                          "ON e.verdict_id = v.id WHERE v.status = ?");
    row.bind(1, status);
    row.executeStep();
    return row.getColumn(0).getInt64();
  };
  s.evaluations_ok = evaluations("ok");
  s.evaluations_rejected = evaluations("rejected");
  s.evaluations_failed = evaluations("failed");
  s.evaluations = s.evaluations_ok + s.evaluations_rejected + s.evaluations_failed;
  s.studies = CountsOf(db,
                       "SELECT s.name, (SELECT coalesce(sum(r.past - r.begin), 0) FROM run_range "
                       "AS r WHERE r.study_id = s.id) FROM study AS s ORDER BY s.name, s.id");
  s.rejected =
      CountsOf(db,
               "SELECT v.stage || ': ' || v.reason, sum(e.n) AS n FROM verdict AS v JOIN (SELECT "
               "verdict_id, "
               "count(*) AS n FROM evaluation GROUP BY verdict_id) AS e ON e.verdict_id = v.id "
               "WHERE v.status <> 'ok' GROUP BY 1 ORDER BY n DESC, 1 LIMIT 100");
  s.modules =
      CountsOf(db,
               "SELECT m.name, count(DISTINCT b.layout_id) AS n FROM layout_block AS b "
               "JOIN module AS m ON m.id = b.module_id GROUP BY m.name ORDER BY n DESC, m.name");
  s.plugins = CountsOf(
      db,
      "SELECT v.plugin || ' ' || v.version, sum(l.n) AS n FROM provenance_plugin AS v "
      "JOIN (SELECT provenance_id, count(*) AS n FROM layout GROUP BY provenance_id) AS l "
      "ON l.provenance_id = v.provenance_id GROUP BY v.plugin, v.version ORDER BY n DESC, 1");
  s.programs =
      CountsOf(db,
               "SELECT p.program_version, count(*) AS n FROM layout AS l "
               "JOIN provenance AS p ON p.id = l.provenance_id GROUP BY 1 ORDER BY n DESC, 1");
  return s;
}

nlohmann::ordered_json ToJson(const Statistics& statistics) {
  return {{"schema_version", statistics.schema_version},
          {"file_bytes", statistics.file_bytes},
          {"layouts", statistics.layouts},
          {"open_base_layouts", statistics.open_base_layouts},
          {"calibrated_layouts", statistics.calibrated_layouts},
          {"formulas", statistics.formulas},
          {"distributions", statistics.distributions},
          {"relative_motions", statistics.relative_motions},
          {"parameters", statistics.parameters},
          {"metrics", statistics.metrics},
          {"failed_metrics", statistics.failed_metrics},
          {"calibrations", statistics.calibrations},
          {"evaluations", statistics.evaluations},
          {"evaluations_ok", statistics.evaluations_ok},
          {"evaluations_rejected", statistics.evaluations_rejected},
          {"evaluations_failed", statistics.evaluations_failed},
          {"studies", CountsJson(statistics.studies)},
          {"rejected", CountsJson(statistics.rejected)},
          {"modules", CountsJson(statistics.modules)},
          {"plugins", CountsJson(statistics.plugins)},
          {"programs", CountsJson(statistics.programs)}};
}

}  // namespace kompono::catalog
