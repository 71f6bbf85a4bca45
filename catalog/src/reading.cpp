// SPDX-License-Identifier: Apache-2.0
#include "reading.hpp"

#include "failure.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>

#include <sqlite3.h>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::catalog {
namespace {

constexpr std::size_t kShortestPrefix = 4;
constexpr std::size_t kMostCandidates = 10;  // the LIMIT of the searches below

struct Candidate {
  std::int64_t id = 0;
  std::string hash;
};

std::vector<Candidate> Candidates(SQLite::Statement& query) {
  std::vector<Candidate> found;
  while (query.executeStep()) {
    found.push_back({.id = query.getColumn(0).getInt64(), .hash = Hex(DigestAt(query, 1))});
  }
  return found;
}

std::vector<Candidate> ByName(SQLite::Database& db, const std::string& name) {
  SQLite::Statement query(
      db, "SELECT id, content_hash FROM layout WHERE name = ? ORDER BY id LIMIT 10");
  query.bind(1, name);
  return Candidates(query);
}

std::vector<Candidate> ById(SQLite::Database& db, std::string_view key) {
  std::int64_t id = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), id);
  if (error != std::errc{} || end != key.data() + key.size()) return {};
  SQLite::Statement query(db, "SELECT id, content_hash FROM layout WHERE id = ?");
  query.bind(1, id);
  return Candidates(query);
}

std::vector<Candidate> ByHash(SQLite::Database& db, std::string_view key) {
  const std::size_t digits = 2 * Sha256{}.size();
  if (key.size() < kShortestPrefix || key.size() > digits) return {};
  const std::optional<Sha256> low =
      Sha256FromHex(std::string(key) + std::string(digits - key.size(), '0'));
  const std::optional<Sha256> high =
      Sha256FromHex(std::string(key) + std::string(digits - key.size(), 'f'));
  if (!low || !high) return {};
  SQLite::Statement query(
      db, "SELECT id, content_hash FROM layout WHERE content_hash BETWEEN ? AND ? LIMIT 10");
  query.bindNoCopy(1, low->data(), static_cast<int>(low->size()));
  query.bindNoCopy(2, high->data(), static_cast<int>(high->size()));
  return Candidates(query);
}

std::string Suggestion(SQLite::Database& db, std::string_view key) {
  std::vector<std::string> names;
  SQLite::Statement query(db, "SELECT DISTINCT name FROM layout ORDER BY name LIMIT 10000");
  while (query.executeStep()) names.push_back(query.getColumn(0).getString());
  return names.empty() ? "the catalog is empty" : DidYouMean(key, names);
}

void ReadMotions(SQLite::Database& db, StoredLayout& layout) {
  SQLite::Statement row(
      db,
      "SELECT m.axis, m.side, m.working, m.block FROM motion AS m "
      "JOIN layout AS l ON l.formula_id = m.formula_id WHERE l.id = ? ORDER BY m.position");
  row.bind(1, layout.id);
  while (row.executeStep()) {
    layout.record.motions.push_back(
        {.axis = row.getColumn(0).getString(),
         .side = row.getColumn(1).getString() == "workpiece" ? Side::kWorkpiece : Side::kTool,
         .working = row.getColumn(2).getInt() != 0,
         .block = row.getColumn(3).getString()});
  }
}

void ReadBlocks(SQLite::Database& db, StoredLayout& layout) {
  SQLite::Statement row(db,
                        "SELECT b.name, m.name, m.plugin FROM layout_block AS b JOIN module AS m "
                        "ON m.id = b.module_id "
                        "WHERE b.layout_id = ? ORDER BY b.position");
  row.bind(1, layout.id);
  while (row.executeStep()) {
    layout.record.blocks.push_back({.name = row.getColumn(0).getString(),
                                    .module = row.getColumn(1).getString(),
                                    .plugin = row.getColumn(2).getString()});
  }
}

void ReadNumbers(SQLite::Database& db, StoredLayout& layout) {
  SQLite::Statement parameter(
      db,
      "SELECT q.name, r.value, q.unit FROM parameter AS r "
      "JOIN quantity AS q ON q.id = r.quantity_id WHERE r.layout_id = ? ORDER BY q.name");
  parameter.bind(1, layout.id);
  while (parameter.executeStep()) {
    layout.record.parameters.push_back({.name = parameter.getColumn(0).getString(),
                                        .value = parameter.getColumn(1).getDouble(),
                                        .unit = parameter.getColumn(2).getString()});
  }
  SQLite::Statement metric(
      db,
      "SELECT q.name, r.value, q.unit, t.text, r.failure FROM metric AS r "
      "JOIN quantity AS q ON q.id = r.quantity_id JOIN term AS t ON t.id = r.method_id "
      "WHERE r.layout_id = ? ORDER BY q.name, q.unit, t.text");
  metric.bind(1, layout.id);
  while (metric.executeStep()) {
    layout.record.metrics.push_back({.name = metric.getColumn(0).getString(),
                                     .value = NumberAt(metric, 1),
                                     .unit = metric.getColumn(2).getString(),
                                     .method = metric.getColumn(3).getString(),
                                     .failure = metric.getColumn(4).getString()});
  }
}

void ReadResults(SQLite::Database& db, StoredLayout& layout) {
  SQLite::Statement capability(
      db,
      "SELECT t.text, r.detail FROM capability AS r JOIN term AS t ON t.id = r.name_id "
      "WHERE r.layout_id = ? ORDER BY t.text");
  capability.bind(1, layout.id);
  while (capability.executeStep()) {
    layout.record.capabilities.push_back({.name = capability.getColumn(0).getString(),
                                          .detail = capability.getColumn(1).getString()});
  }
  SQLite::Statement calibration(
      db,
      "SELECT measurements, measurements_hash, status, rms_before_um, rms_after_um, "
      "sigma_um, degrees_of_freedom, report FROM calibration WHERE layout_id = ? "
      "ORDER BY id");
  calibration.bind(1, layout.id);
  while (calibration.executeStep())
    layout.record.calibrations.push_back(CalibrationAt(calibration, 0));
}

void ReadProvenance(SQLite::Database& db, StoredLayout& layout) {
  SQLite::Statement row(
      db,
      "SELECT p.id, p.program_version, p.source_path, p.source_hash FROM provenance AS p "
      "JOIN layout AS l ON l.provenance_id = p.id WHERE l.id = ?");
  row.bind(1, layout.id);
  if (!row.executeStep()) return;
  Provenance& provenance = layout.record.provenance;
  provenance.program_version = row.getColumn(1).getString();
  provenance.source_path = row.getColumn(2).getString();
  provenance.source_sha256 = row.getColumn(3).getString();
  SQLite::Statement plugin(
      db, "SELECT plugin, version FROM provenance_plugin WHERE provenance_id = ? ORDER BY plugin");
  plugin.bind(1, row.getColumn(0).getInt64());
  while (plugin.executeStep()) {
    provenance.plugins.push_back(
        {.id = plugin.getColumn(0).getString(), .version = plugin.getColumn(1).getString()});
  }
}

}  // namespace

std::optional<double> NumberAt(SQLite::Statement& row, int column) {
  const SQLite::Column value = row.getColumn(column);
  return value.isNull() ? std::nullopt : std::optional(value.getDouble());
}

Sha256 DigestAt(SQLite::Statement& row, int column) {
  const SQLite::Column value = row.getColumn(column);
  Sha256 digest{};
  const void* bytes = value.getBlob();
  if (bytes != nullptr && value.getBytes() == static_cast<int>(digest.size())) {
    std::memcpy(digest.data(), bytes, digest.size());
  }
  return digest;
}

Calibration CalibrationAt(SQLite::Statement& row, int first) {
  return {.measurements = row.getColumn(first).getString(),
          .measurements_sha256 = row.getColumn(first + 1).getString(),
          .status = row.getColumn(first + 2).getString(),
          .rms_before_um = NumberAt(row, first + 3),
          .rms_after_um = NumberAt(row, first + 4),
          .sigma_um = NumberAt(row, first + 5),
          .degrees_of_freedom = row.getColumn(first + 6).getInt64(),
          .report_json = row.getColumn(first + 7).getString()};
}

Parsed<std::int64_t> FindLayout(SQLite::Database& db,
                                std::string_view key,
                                const std::string& file) {
  std::vector<Candidate> found = ByName(db, std::string(key));
  if (found.empty()) found = ById(db, key);
  if (found.empty()) found = ByHash(db, key);
  if (found.empty()) {
    return Refuse("E0512",
                  file,
                  fmt::format("no layout has the name, id or hash '{}'", key),
                  Suggestion(db, key));
  }
  if (found.size() > 1) {
    std::vector<std::string> choices;
    choices.reserve(found.size());
    for (const Candidate& candidate : found) {
      choices.push_back(
          fmt::format("id {} with hash {}", candidate.id, candidate.hash.substr(0, 12)));
    }
    const std::string number =
        found.size() < kMostCandidates ? std::to_string(found.size()) : "many";
    return Refuse("E0513",
                  file,
                  fmt::format("'{}' stands for {} layouts", key, number),
                  fmt::format("say which: {}", fmt::join(choices, "; ")));
  }
  return found.front().id;
}

StoredLayout ReadLayout(SQLite::Database& db, std::int64_t id) {
  SQLite::Statement row(
      db,
      "SELECT l.content_hash, l.added_at, l.rms_before_um, l.rms_after_um, l.name, f.text, "
      "f.distribution, f.relative_motion, f.base, l.coordinates, l.drives, t.toml, t.content "
      "FROM layout AS l JOIN formula AS f ON f.id = l.formula_id "
      "JOIN layout_text AS t ON t.layout_id = l.id WHERE l.id = ?");
  row.bind(1, id);
  if (!row.executeStep())
    throw SQLite::Exception("a layout's text or formula is missing", SQLITE_CORRUPT);
  StoredLayout layout{.id = id,
                      .hash = Hex(DigestAt(row, 0)),
                      .added_at = row.getColumn(1).getString(),
                      .rms_before_um = NumberAt(row, 2),
                      .rms_after_um = NumberAt(row, 3),
                      .record = {}};
  layout.record.name = row.getColumn(4).getString();
  layout.record.formula = row.getColumn(5).getString();
  layout.record.distribution = row.getColumn(6).getString();
  layout.record.relative_motion = row.getColumn(7).getString();
  layout.record.open_base = row.getColumn(8).getString() == "open";
  layout.record.coordinates = row.getColumn(9).getInt();
  layout.record.drives = row.getColumn(10).getInt();
  layout.record.toml = row.getColumn(11).getString();
  layout.record.content = row.getColumn(12).getString();
  ReadMotions(db, layout);
  ReadBlocks(db, layout);
  ReadNumbers(db, layout);
  ReadResults(db, layout);
  ReadProvenance(db, layout);
  return layout;
}

std::string ReadToml(SQLite::Database& db, std::int64_t id) {
  SQLite::Statement row(db, "SELECT toml FROM layout_text WHERE layout_id = ?");
  row.bind(1, id);
  return row.executeStep() ? row.getColumn(0).getString() : std::string();
}

std::vector<LayoutSummary> ReadList(SQLite::Database& db, const ListOptions& options) {
  SQLite::Statement row(
      db,
      "SELECT l.id, l.name, f.text, l.content_hash, l.rms_after_um, l.added_at FROM layout AS l "
      "JOIN formula AS f ON f.id = l.formula_id WHERE l.id > ? ORDER BY l.id LIMIT ?");
  row.bind(1, options.after_id);
  row.bind(2, options.limit > 0 ? options.limit : std::int64_t{-1});
  std::vector<LayoutSummary> layouts;
  while (row.executeStep()) {
    layouts.push_back({.id = row.getColumn(0).getInt64(),
                       .name = row.getColumn(1).getString(),
                       .formula = row.getColumn(2).getString(),
                       .hash = Hex(DigestAt(row, 3)),
                       .rms_after_um = NumberAt(row, 4),
                       .added_at = row.getColumn(5).getString()});
  }
  return layouts;
}

}  // namespace kompono::catalog
