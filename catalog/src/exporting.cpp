// SPDX-License-Identifier: Apache-2.0
#include "exporting.hpp"

#include "csv.hpp"
#include "failure.hpp"
#include "reading.hpp"
#include "study_reading.hpp"
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

namespace kompono::catalog {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::string_view kFormat = "catalog 1";

/// What is written has its name only when it is complete.
class OutFile {
 public:
  explicit OutFile(fs::path path) : path_(std::move(path)), part_(path_) {
    part_ += ".part";
    out_.open(part_, std::ios::binary | std::ios::trunc);
  }
  void Write(std::string_view text) {
    out_.write(text.data(), static_cast<std::streamsize>(text.size()));
  }
  /// Empty: the file is there.
  [[nodiscard]] Diagnostics Close() {
    out_.close();
    std::error_code error;
    if (!out_.fail()) fs::rename(part_, path_, error);
    if (!out_.fail() && !error) return {};
    fs::remove(part_, error);
    return {Complaint("E0550",
                      path_.string(),
                      "cannot be written",
                      "check the folder's permissions and the space on the disk")};
  }

 private:
  fs::path path_;
  fs::path part_;
  std::ofstream out_;
};

/// Lines of a JSON list, each entry on its own.
class List {
 public:
  explicit List(OutFile& out) : out_(out) {}
  void Add(const ordered_json& entry) {
    out_.Write(first_ ? "\n" : ",\n");
    first_ = false;
    out_.Write(entry.dump());
  }

 private:
  OutFile& out_;
  bool first_ = true;
};

struct StudyKey {
  std::int64_t id = 0;
  std::string hash;
};

std::vector<StudyKey> StudiesInOrder(SQLite::Database& db) {
  std::vector<StudyKey> studies;
  SQLite::Statement row(db, "SELECT id, content_hash FROM study ORDER BY name, content_hash");
  while (row.executeStep())
    studies.push_back({.id = row.getColumn(0).getInt64(), .hash = Hex(DigestAt(row, 1))});
  return studies;
}

ordered_json StudyJson(const StudyRecord& study, const std::string& hash) {
  ordered_json rules = ordered_json::array();
  for (const StudyRule& rule : study.rules) {
    rules.push_back({{"first", rule.first},
                     {"second", rule.second},
                     {"kind", rule.kind},
                     {"reason", rule.reason},
                     {"author", rule.author},
                     {"active", rule.active}});
  }
  return {{"name", study.name},
          {"hash", hash},
          {"candidates", study.candidates},
          {"rules", std::move(rules)},
          {"toml", study.toml}};
}

ordered_json EvaluationJson(const EvaluationRecord& record,
                            const std::string& study,
                            const std::string& layout) {
  ordered_json json{{"study", study},
                    {"candidate", record.candidate},
                    {"status", Word(record.status)},
                    {"stage", record.stage},
                    {"reason", record.reason},
                    {"formula", record.formula}};
  if (!layout.empty()) {  // whose metrics are told there
    json["layout"] = layout;
    return json;
  }
  json["metrics"] = ordered_json::array();
  for (const Metric& metric : record.metrics) {
    ordered_json entry{
        {"name", metric.name},
        {"value", metric.value ? ordered_json(*metric.value) : ordered_json(nullptr)},
        {"unit", metric.unit},
        {"method", metric.method}};
    if (!metric.failure.empty()) entry["failure"] = metric.failure;
    json["metrics"].push_back(std::move(entry));
  }
  return json;
}

/// Without what depends on this file: id, times, and which calibration came last.
ordered_json LayoutJson(StoredLayout layout) {
  std::sort(layout.record.calibrations.begin(),
            layout.record.calibrations.end(),
            [](const Calibration& a, const Calibration& b) {
              return std::tie(a.measurements_sha256, a.status, a.report_json) <
                     std::tie(b.measurements_sha256, b.status, b.report_json);
            });
  ordered_json json = ToJson(layout);
  for (const char* own : {"id", "added_at", "rms_before_um", "rms_after_um"}) json.erase(own);
  return json;
}

void WriteEvaluations(SQLite::Database& db, OutFile& out, ExportSummary& summary) {
  SQLite::Statement hash(db, "SELECT content_hash FROM layout WHERE id = ?");
  EvaluationReader reader(db, EvaluationReader::Layouts::kNone);
  List list(out);
  for (const StudyKey& study : StudiesInOrder(db)) {
    const std::optional<std::int64_t> candidates = CandidatesOf(db, study.id);
    reader.Start(study.id, {.begin = 0, .end = candidates.value_or(0)});
    for (EvaluationRecord record; reader.Next(record);) {
      std::string layout;
      if (reader.LayoutId() != 0) {
        hash.reset();
        hash.bind(1, reader.LayoutId());
        if (hash.executeStep()) layout = Hex(DigestAt(hash, 0));
      }
      list.Add(EvaluationJson(record, study.hash, layout));
      ++summary.evaluations;
    }
  }
}

Diagnostics WriteJson(SQLite::Database& db, const fs::path& path, ExportSummary& summary) {
  OutFile out(path);
  out.Write(fmt::format("{{\"kompono\": \"{}\",\n\"studies\": [", kFormat));
  {
    List list(out);
    for (const StudyKey& study : StudiesInOrder(db))
      list.Add(StudyJson(ReadStudy(db, study.id), study.hash));
  }
  out.Write("\n],\n\"evaluations\": [");
  WriteEvaluations(db, out, summary);
  out.Write("\n],\n\"layouts\": [");
  LayoutReader reader(db);
  List list(out);
  SQLite::Statement row(db, "SELECT id FROM layout ORDER BY content_hash");
  while (row.executeStep()) {
    list.Add(LayoutJson(reader.Read(row.getColumn(0).getInt64())));
    ++summary.layouts;
  }
  out.Write("\n]}\n");
  ++summary.files;
  return out.Close();
}

struct CsvFile {
  const char* name;
  const char* sql;
};

constexpr std::array<CsvFile, 11> kCsvFiles = {{
    {"layouts.csv",
     "SELECT lower(hex(l.content_hash)) AS layout, l.name AS name, f.text AS formula, "
     "f.distribution AS distribution, f.relative_motion AS relative_motion, f.base AS base, "
     "l.coordinates AS coordinates, l.drives AS drives, p.plugins AS plugins, p.program_version AS "
     "program_version, p.source_path AS source, p.source_hash AS source_hash FROM layout AS l "
     "JOIN formula AS f ON f.id = l.formula_id JOIN provenance AS p ON p.id = l.provenance_id "
     "ORDER BY l.content_hash"},
    {"blocks.csv",
     "SELECT lower(hex(l.content_hash)) AS layout, b.position AS position, b.name AS block, m.name "
     "AS module, m.plugin AS plugin FROM layout AS l JOIN layout_block AS b ON b.layout_id = l.id "
     "JOIN module AS m ON m.id = b.module_id ORDER BY l.content_hash, b.position"},
    {"motions.csv",
     "SELECT f.text AS formula, v.position AS position, v.axis AS axis, v.side AS side, v.working "
     "AS working, v.block AS block FROM formula AS f JOIN motion AS v ON v.formula_id = f.id "
     "ORDER BY f.text, v.position"},
    {"parameters.csv",
     "SELECT lower(hex(l.content_hash)) AS layout, q.name AS name, r.value AS value, q.unit AS "
     "unit FROM layout AS l JOIN parameter AS r ON r.layout_id = l.id JOIN quantity AS q ON q.id = "
     "r.quantity_id ORDER BY l.content_hash, q.name"},
    {"metrics.csv",
     "SELECT lower(hex(l.content_hash)) AS layout, m.name AS name, r.value AS value, m.unit AS "
     "unit, m.method AS method, r.failure AS failure FROM layout AS l JOIN metric AS r ON "
     "r.layout_id = l.id JOIN measure AS m ON m.id = r.measure_id "
     "ORDER BY l.content_hash, m.name, m.unit, m.method"},
    {"capabilities.csv",
     "SELECT lower(hex(l.content_hash)) AS layout, t.text AS name, r.detail AS detail FROM layout "
     "AS l JOIN capability AS r ON r.layout_id = l.id JOIN term AS t ON t.id = r.name_id "
     "ORDER BY l.content_hash, t.text"},
    {"calibrations.csv",
     "SELECT lower(hex(l.content_hash)) AS layout, c.status AS status, c.rms_before_um AS "
     "rms_before_um, c.rms_after_um AS rms_after_um, c.sigma_um AS sigma_um, c.degrees_of_freedom "
     "AS degrees_of_freedom, c.measurements AS measurements, c.measurements_hash AS "
     "measurements_hash FROM layout AS l JOIN calibration AS c ON c.layout_id = l.id "
     "ORDER BY l.content_hash, c.content_hash"},
    {"studies.csv",
     "SELECT lower(hex(content_hash)) AS study, name, candidates FROM study "
     "ORDER BY name, content_hash"},
    {"rules.csv",
     "SELECT lower(hex(s.content_hash)) AS study, r.first AS first, r.second AS second, r.kind AS "
     "kind, r.reason AS reason, r.author AS author, r.active AS active FROM study AS s JOIN "
     "study_rule AS r ON r.study_id = s.id ORDER BY s.name, s.content_hash, r.position"},
    {"evaluations.csv",
     "SELECT lower(hex(s.content_hash)) AS study, e.candidate AS candidate, v.status AS status, "
     "v.stage AS stage, v.reason AS reason, f.text AS formula, lower(hex(l.content_hash)) AS "
     "layout "
     "FROM study AS s JOIN evaluation AS e ON e.study_id = s.id JOIN verdict AS v ON v.id = "
     "e.verdict_id LEFT JOIN formula AS f ON f.id = e.formula_id LEFT JOIN layout AS l ON l.id = "
     "e.layout_id ORDER BY s.name, s.content_hash, e.candidate"},
    {"evaluation_metrics.csv",
     "SELECT lower(hex(s.content_hash)) AS study, r.candidate AS candidate, m.name AS name, "
     "r.value "
     "AS value, m.unit AS unit, m.method AS method, r.failure AS failure FROM study AS s JOIN "
     "evaluation_metric AS r ON r.study_id = s.id JOIN measure AS m ON m.id = r.measure_id "
     "ORDER BY s.name, s.content_hash, r.candidate, m.name, m.unit, m.method"},
}};

Value ValueOf(const SQLite::Column& column) {
  if (column.isNull()) return std::monostate{};
  if (column.isInteger()) return static_cast<std::int64_t>(column.getInt64());
  if (column.isFloat()) return column.getDouble();
  return column.getString();
}

/// The number of rows.
std::int64_t WriteRows(SQLite::Database& db, const CsvFile& file, OutFile& out) {
  SQLite::Statement row(db, file.sql);
  const int columns = row.getColumnCount();
  std::string line;
  for (int i = 0; i < columns; ++i) line += (i == 0 ? "" : ",") + CsvText(row.getColumnName(i));
  out.Write(line + "\r\n");
  std::int64_t rows = 0;
  while (row.executeStep()) {
    line.clear();
    for (int i = 0; i < columns; ++i)
      line += (i == 0 ? "" : ",") + CsvField(ValueOf(row.getColumn(i)));
    out.Write(line + "\r\n");
    ++rows;
  }
  return rows;
}

Diagnostics WriteCsv(SQLite::Database& db, const fs::path& folder, ExportSummary& summary) {
  for (const CsvFile& file : kCsvFiles) {
    OutFile out(folder / file.name);
    const std::int64_t rows = WriteRows(db, file, out);
    if (Diagnostics trouble = out.Close(); !trouble.empty()) return trouble;
    if (std::string_view(file.name) == "layouts.csv") summary.layouts = rows;
    if (std::string_view(file.name) == "evaluations.csv") summary.evaluations = rows;
    ++summary.files;
  }
  return {};
}

/// Letters, digits and hyphens, so that no name of a layout leads out of the folder; the hash makes
/// it unique.
std::string FileName(std::string_view name, const std::string& hash) {
  constexpr std::size_t kLongest = 40;
  std::string plain;
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    const bool capital = c >= 'A' && c <= 'Z';
    if (letter || capital) {
      plain += capital ? static_cast<char>(c - 'A' + 'a') : c;
    } else if (!plain.empty() && plain.back() != '-') {
      plain += '-';
    }
    if (plain.size() == kLongest) break;
  }
  while (plain.ends_with('-')) plain.pop_back();
  return fmt::format("{}{}{}.toml", plain, plain.empty() ? "" : "-", hash.substr(0, 16));
}

/// Layouts of a study whose text was not kept have no file.
Diagnostics WriteToml(SQLite::Database& db, const fs::path& folder, ExportSummary& summary) {
  SQLite::Statement row(db,
                        "SELECT l.name, l.content_hash, t.toml FROM layout AS l JOIN layout_text "
                        "AS t ON t.layout_id = l.id WHERE t.toml <> '' ORDER BY l.content_hash");
  while (row.executeStep()) {
    OutFile out(folder / FileName(row.getColumn(0).getString(), Hex(DigestAt(row, 1))));
    out.Write(row.getColumn(2).getString());
    if (Diagnostics trouble = out.Close(); !trouble.empty()) return trouble;
    ++summary.layouts;
    ++summary.files;
  }
  return {};
}

Diagnostics MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (fs::is_directory(folder, error)) return {};
  return {Complaint("E0550", folder.string(), "this folder cannot be made")};
}

}  // namespace

Parsed<ExportSummary> ExportCatalog(SQLite::Database& db,
                                    ExportFormat format,
                                    const fs::path& out) {
  ExportSummary summary;
  Diagnostics trouble;
  if (format != ExportFormat::kJson) trouble = MakeFolder(out);
  if (trouble.empty()) {
    switch (format) {
      case ExportFormat::kJson:
        trouble = WriteJson(db, out, summary);
        break;
      case ExportFormat::kCsv:
        trouble = WriteCsv(db, out, summary);
        break;
      case ExportFormat::kToml:
        trouble = WriteToml(db, out, summary);
        break;
    }
  }
  if (!trouble.empty()) return tl::make_unexpected(std::move(trouble));
  return summary;
}

}  // namespace kompono::catalog
