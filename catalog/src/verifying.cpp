// SPDX-License-Identifier: Apache-2.0
#include "verifying.hpp"

#include "bulk.hpp"
#include "failure.hpp"
#include "reading.hpp"
#include "record_parts.hpp"
#include "schema.hpp"
#include "study_reading.hpp"
#include "words.hpp"
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

namespace kompono::catalog {
namespace {

using Schema = std::map<std::string, std::string>;

Schema SchemaOf(SQLite::Database& db) {
  Schema schema;
  SQLite::Statement row(db,
                        "SELECT type || ' ' || name, coalesce(sql, '') FROM sqlite_schema "
                        "WHERE name NOT LIKE 'sqlite\\_%' ESCAPE '\\'");
  while (row.executeStep())
    schema.emplace(row.getColumn(0).getString(), row.getColumn(1).getString());
  return schema;
}

class Verifier {
 public:
  Verifier(SQLite::Database& db, std::string file) : db_(db), file_(std::move(file)) {}

  void Structure() {
    SQLite::Statement row(db_, "PRAGMA integrity_check(50)");
    while (row.executeStep()) {
      const std::string finding = row.getColumn(0).getString();
      if (finding != "ok") Found("E0530", finding);
    }
  }

  void References() {
    SQLite::Statement row(db_, "PRAGMA foreign_key_check");
    for (int i = 0; i < 50 && row.executeStep(); ++i) {
      Found("E0531",
            fmt::format("a row of table '{}' refers to a missing row of '{}'",
                        row.getColumn(0).getString(),
                        row.getColumn(2).getString()));
    }
  }

  void Tables() {
    SQLite::Database fresh(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    CreateSchema(fresh);
    const Schema expected = SchemaOf(fresh);
    const Schema actual = SchemaOf(db_);
    for (const auto& [name, sql] : expected) {
      const auto found = actual.find(name);
      if (found == actual.end()) {
        if (!Deferred(name)) Found("E0534", fmt::format("{} is missing", name));
      } else if (found->second != sql) {
        Found("E0534", fmt::format("{} is not as this program made it", name));
      }
    }
    for (const auto& [name, sql] : actual) {
      if (!expected.contains(name))
        Found("E0534", fmt::format("{} does not belong to the catalog", name));
    }
  }

  void Layouts() {
    SQLite::Statement ids(db_, "SELECT id, content_hash, name, hash_key FROM layout ORDER BY id");
    SQLite::Statement texts(db_,
                            "SELECT f.text, t.toml, t.content FROM layout AS l JOIN formula AS f "
                            "ON f.id = l.formula_id "
                            "JOIN layout_text AS t ON t.layout_id = l.id WHERE l.id = ?");
    SQLite::Statement blocks(
        db_,
        "SELECT b.name, m.name FROM layout_block AS b JOIN module AS m ON m.id = b.module_id "
        "WHERE b.layout_id = ? ORDER BY b.position");
    SQLite::Statement parameters(
        db_,
        "SELECT q.name, r.value, q.unit FROM parameter AS r "
        "JOIN quantity AS q ON q.id = r.quantity_id WHERE r.layout_id = ?");
    while (ids.executeStep()) {
      const std::int64_t id = ids.getColumn(0).getInt64();
      LayoutRecord record{.name = ids.getColumn(2).getString()};
      texts.bind(1, id);
      if (!texts.executeStep()) {
        Found("E0532", fmt::format("layout {} '{}' has lost its text or formula", id, record.name));
        texts.reset();
        continue;
      }
      record.formula = texts.getColumn(0).getString();
      record.toml = texts.getColumn(1).getString();
      record.content = texts.getColumn(2).getString();
      texts.reset();
      blocks.bind(1, id);
      while (blocks.executeStep()) {
        record.blocks.push_back(
            {.name = blocks.getColumn(0).getString(), .module = blocks.getColumn(1).getString()});
      }
      blocks.reset();
      parameters.bind(1, id);
      while (parameters.executeStep()) {
        record.parameters.push_back({.name = parameters.getColumn(0).getString(),
                                     .value = parameters.getColumn(1).getDouble(),
                                     .unit = parameters.getColumn(2).getString()});
      }
      parameters.reset();
      const Sha256 digest = ContentDigest(record);
      if (digest != DigestAt(ids, 1) || KeyOf(digest) != ids.getColumn(3).getInt64()) {
        Found("E0532",
              fmt::format(
                  "layout {} '{}' is not what its hash says: it was changed after it was added",
                  id,
                  record.name));
      }
      ++report_.layouts;
    }
  }

  void Calibrations() {
    SQLite::Statement row(
        db_,
        "SELECT layout_id, content_hash, measurements, measurements_hash, status, rms_before_um, "
        "rms_after_um, sigma_um, degrees_of_freedom, report FROM calibration ORDER BY id");
    while (row.executeStep()) {
      const Calibration calibration = CalibrationAt(row, 2);
      if (ContentDigest(calibration) != DigestAt(row, 1)) {
        Found("E0533",
              fmt::format("the calibration of layout {} with '{}' is not what its hash says",
                          row.getColumn(0).getInt64(),
                          calibration.measurements));
      }
      ++report_.calibrations;
    }
    SQLite::Statement stale(
        db_,
        "SELECT l.id FROM layout AS l WHERE (l.rms_before_um, l.rms_after_um) IS NOT "
        "(SELECT c.rms_before_um, c.rms_after_um FROM calibration AS c WHERE c.layout_id = l.id "
        "AND c.rms_after_um IS NOT NULL ORDER BY c.id DESC LIMIT 1)");
    while (stale.executeStep()) {
      Found("E0533",
            fmt::format("the residuals of layout {} are not those of its newest calibration",
                        stale.getColumn(0).getInt64()));
    }
  }

  void Studies() {
    SQLite::Statement study(db_, "SELECT id, content_hash, name FROM study ORDER BY id");
    while (study.executeStep()) {
      const std::int64_t id = study.getColumn(0).getInt64();
      const std::string name = study.getColumn(2).getString();
      const StudyRecord record = ReadStudy(db_, id);
      if (ContentDigest(record) != DigestAt(study, 1)) {
        Found("E0545",
              fmt::format(
                  "study {} '{}' is not what its hash says: it was changed after it was added",
                  id,
                  name));
      }
      Evaluations(id, name, record.candidates);
    }
  }

  /// A layout or study that was changed has other words too, which was told.
  void Words() {
    const bool told = std::any_of(
        report_.findings.begin(), report_.findings.end(), [](const Diagnostic& finding) {
          return finding.code == "E0532" || finding.code == "E0545";
        });
    if (told) return;
    SQLite::Statement wrong(
        db_,
        fmt::format("SELECT count(*) FROM (SELECT rowid, name, formula, parts, text FROM word "
                    "EXCEPT SELECT * FROM ({} UNION ALL {}))",
                    kWordsOfLayouts,
                    kWordsOfStudies));
    wrong.executeStep();
    const std::int64_t stale = wrong.getColumn(0).getInt64();
    const std::int64_t lost =
        db_.execAndGet(
               "SELECT (SELECT count(*) FROM study AS s WHERE NOT EXISTS (SELECT 1 FROM word WHERE "
               "rowid = 2 * s.id + 1)) + (SELECT count(*) FROM layout AS l WHERE NOT EXISTS "
               "(SELECT 1 FROM evaluation AS e WHERE e.layout_id = l.id) AND NOT EXISTS "
               "(SELECT 1 FROM word WHERE rowid = 2 * l.id))")
            .getInt64();
    if (stale + lost > 0) {
      Found("E0547", fmt::format("full-text search has {} wrong and lacks {}", stale, lost));
    }
  }

  [[nodiscard]] VerifyReport Take() { return std::move(report_); }

 private:
  /// A load in bulk that goes on, or was cut short, leaves these out.
  bool Deferred(const std::string& name) {
    return BulkLoading(db_) && std::any_of(kDeferredIndexes.begin(),
                                           kDeferredIndexes.end(),
                                           [&name](const DeferredIndex& index) {
                                             return name == fmt::format("index {}", index.name);
                                           });
  }

  /// Every candidate that is done has its row, no other has one, and no range covers another.
  void Evaluations(std::int64_t study, const std::string& name, std::int64_t candidates) {
    const auto hole = [&](std::string_view what, std::int64_t candidate) {
      Found("E0546", fmt::format("study {} '{}': candidate {} {}", study, name, candidate, what));
    };
    SQLite::Statement rows(db_,
                           "SELECT count(*), coalesce(min(candidate), -1) FROM evaluation WHERE "
                           "study_id = ? AND candidate >= ? AND candidate < ?");
    std::int64_t in_ranges = 0;
    std::int64_t past = 0;
    for (const RangeOfRun& run : ReadRuns(db_, study)) {
      if (run.range.begin < past) hole("was done twice", run.range.begin);
      past = run.range.end;
      rows.reset();
      rows.bind(1, study);
      rows.bind(2, run.range.begin);
      rows.bind(3, run.range.end);
      rows.executeStep();
      const std::int64_t count = rows.getColumn(0).getInt64();
      if (count != run.range.size())
        hole("is in a range that is done but not complete", run.range.begin);
      in_ranges += count;
    }
    if (past > candidates) hole("is outside the study", past - 1);
    SQLite::Statement all(db_, "SELECT count(*) FROM evaluation WHERE study_id = ?");
    all.bind(1, study);
    all.executeStep();
    const std::int64_t count = all.getColumn(0).getInt64();
    report_.evaluations += count;
    if (count != in_ranges) {
      Found("E0546",
            fmt::format("study {} '{}' has {} evaluations of candidates that are not done",
                        study,
                        name,
                        count - in_ranges));
    }
  }

  void Found(std::string code, std::string message) {
    report_.findings.push_back(Complaint(std::move(code), file_, std::move(message)));
  }

  SQLite::Database& db_;
  std::string file_;
  VerifyReport report_;
};

}  // namespace

VerifyReport VerifyCatalog(SQLite::Database& db, const std::string& file) {
  Verifier verifier(db, file);
  verifier.Structure();
  verifier.References();
  verifier.Tables();
  verifier.Layouts();
  verifier.Calibrations();
  verifier.Studies();
  verifier.Words();
  return verifier.Take();
}

}  // namespace kompono::catalog
