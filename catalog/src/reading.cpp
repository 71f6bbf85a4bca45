// SPDX-License-Identifier: Apache-2.0
#include "reading.hpp"

#include "failure.hpp"
#include "record_parts.hpp"
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
      db,
      "SELECT id, content_hash FROM layout WHERE hash_key BETWEEN ? AND ? AND content_hash BETWEEN "
      "? AND ? ORDER BY content_hash LIMIT 10");
  // Four digits are equal, so both keys have the same sign.
  query.bind(1, KeyOf(*low));
  query.bind(2, KeyOf(*high));
  query.bindNoCopy(3, low->data(), static_cast<int>(low->size()));
  query.bindNoCopy(4, high->data(), static_cast<int>(high->size()));
  return Candidates(query);
}

std::string Suggestion(SQLite::Database& db, std::string_view key) {
  std::vector<std::string> names;
  SQLite::Statement query(db, "SELECT DISTINCT name FROM layout ORDER BY name LIMIT 10000");
  while (query.executeStep()) names.push_back(query.getColumn(0).getString());
  return names.empty() ? "the catalog is empty" : DidYouMean(key, names);
}

}  // namespace

std::optional<double> NumberAt(SQLite::Statement& row, int column) {
  const SQLite::Column value = row.getColumn(column);
  return value.isNull() ? std::nullopt : std::optional(value.getDouble());
}

Metric MetricAt(SQLite::Statement& row) {
  return {.name = row.getColumn(0).getString(),
          .value = NumberAt(row, 1),
          .unit = row.getColumn(2).getString(),
          .method = row.getColumn(3).getString(),
          .failure = row.getColumn(4).getString()};
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

LayoutReader::LayoutReader(SQLite::Database& db)
    : db_(db),
      layout_(
          db,
          "SELECT l.content_hash, l.added_at, l.rms_before_um, l.rms_after_um, l.name, f.text, "
          "f.distribution, f.relative_motion, f.base, l.coordinates, l.drives, t.toml, t.content, "
          "l.provenance_id FROM layout AS l JOIN formula AS f ON f.id = l.formula_id "
          "JOIN layout_text AS t ON t.layout_id = l.id WHERE l.id = ?"),
      motion_(db,
              "SELECT m.axis, m.side, m.working, m.block FROM motion AS m "
              "JOIN layout AS l ON l.formula_id = m.formula_id WHERE l.id = ? ORDER BY m.position"),
      block_(db,
             "SELECT b.name, m.name, m.plugin FROM layout_block AS b JOIN module AS m "
             "ON m.id = b.module_id WHERE b.layout_id = ? ORDER BY b.position"),
      parameter_(
          db,
          "SELECT q.name, r.value, q.unit FROM parameter AS r "
          "JOIN quantity AS q ON q.id = r.quantity_id WHERE r.layout_id = ? ORDER BY q.name"),
      metric_(db,
              "SELECT m.name, r.value, m.unit, m.method, r.failure FROM metric AS r "
              "JOIN measure AS m ON m.id = r.measure_id "
              "WHERE r.layout_id = ? ORDER BY m.name, m.unit, m.method"),
      capability_(db,
                  "SELECT t.text, r.detail FROM capability AS r JOIN term AS t ON t.id = r.name_id "
                  "WHERE r.layout_id = ? ORDER BY t.text"),
      calibration_(db,
                   "SELECT measurements, measurements_hash, status, rms_before_um, rms_after_um, "
                   "sigma_um, degrees_of_freedom, report FROM calibration WHERE layout_id = ? "
                   "ORDER BY id") {}

StoredLayout LayoutReader::ReadStructure(std::int64_t id) {
  layout_.reset();
  layout_.bind(1, id);
  if (!layout_.executeStep())
    throw SQLite::Exception("a layout's text or formula is missing", SQLITE_CORRUPT);
  StoredLayout layout{.id = id,
                      .hash = Hex(DigestAt(layout_, 0)),
                      .added_at = layout_.getColumn(1).getString(),
                      .rms_before_um = NumberAt(layout_, 2),
                      .rms_after_um = NumberAt(layout_, 3),
                      .record = {}};
  LayoutRecord& record = layout.record;
  record.name = layout_.getColumn(4).getString();
  record.formula = layout_.getColumn(5).getString();
  record.distribution = layout_.getColumn(6).getString();
  record.relative_motion = layout_.getColumn(7).getString();
  record.open_base = layout_.getColumn(8).getString() == "open";
  record.coordinates = layout_.getColumn(9).getInt();
  record.drives = layout_.getColumn(10).getInt();
  record.toml = layout_.getColumn(11).getString();
  record.content = layout_.getColumn(12).getString();
  const std::int64_t provenance = layout_.getColumn(13).getInt64();
  if (provenance != provenance_id_) {
    provenance_ = ReadProvenance(db_, provenance);
    provenance_id_ = provenance;
  }
  record.provenance = provenance_;
  layout_.reset();
  ReadBlocks(layout);
  ReadParameters(layout);
  return layout;
}

StoredLayout LayoutReader::Read(std::int64_t id) {
  StoredLayout layout = ReadStructure(id);
  ReadMotions(layout);
  ReadMetrics(layout);
  ReadCapabilities(layout);
  ReadCalibrations(layout);
  return layout;
}

void LayoutReader::ReadMotions(StoredLayout& layout) {
  motion_.reset();
  motion_.bind(1, layout.id);
  while (motion_.executeStep()) {
    layout.record.motions.push_back(
        {.axis = motion_.getColumn(0).getString(),
         .side = motion_.getColumn(1).getString() == "workpiece" ? Side::kWorkpiece : Side::kTool,
         .working = motion_.getColumn(2).getInt() != 0,
         .block = motion_.getColumn(3).getString()});
  }
}

void LayoutReader::ReadBlocks(StoredLayout& layout) {
  block_.reset();
  block_.bind(1, layout.id);
  while (block_.executeStep()) {
    layout.record.blocks.push_back({.name = block_.getColumn(0).getString(),
                                    .module = block_.getColumn(1).getString(),
                                    .plugin = block_.getColumn(2).getString()});
  }
}

void LayoutReader::ReadParameters(StoredLayout& layout) {
  parameter_.reset();
  parameter_.bind(1, layout.id);
  while (parameter_.executeStep()) {
    layout.record.parameters.push_back({.name = parameter_.getColumn(0).getString(),
                                        .value = parameter_.getColumn(1).getDouble(),
                                        .unit = parameter_.getColumn(2).getString()});
  }
}

void LayoutReader::ReadMetrics(StoredLayout& layout) {
  metric_.reset();
  metric_.bind(1, layout.id);
  while (metric_.executeStep()) layout.record.metrics.push_back(MetricAt(metric_));
}

void LayoutReader::ReadCapabilities(StoredLayout& layout) {
  capability_.reset();
  capability_.bind(1, layout.id);
  while (capability_.executeStep()) {
    layout.record.capabilities.push_back({.name = capability_.getColumn(0).getString(),
                                          .detail = capability_.getColumn(1).getString()});
  }
}

void LayoutReader::ReadCalibrations(StoredLayout& layout) {
  calibration_.reset();
  calibration_.bind(1, layout.id);
  while (calibration_.executeStep())
    layout.record.calibrations.push_back(CalibrationAt(calibration_, 0));
}

Provenance ReadProvenance(SQLite::Database& db, std::int64_t id) {
  SQLite::Statement row(
      db, "SELECT program_version, source_path, source_hash FROM provenance WHERE id = ?");
  row.bind(1, id);
  Provenance provenance;
  if (!row.executeStep()) return provenance;
  provenance.program_version = row.getColumn(0).getString();
  provenance.source_path = row.getColumn(1).getString();
  provenance.source_sha256 = row.getColumn(2).getString();
  SQLite::Statement plugin(
      db, "SELECT plugin, version FROM provenance_plugin WHERE provenance_id = ? ORDER BY plugin");
  plugin.bind(1, id);
  while (plugin.executeStep()) {
    provenance.plugins.push_back(
        {.id = plugin.getColumn(0).getString(), .version = plugin.getColumn(1).getString()});
  }
  return provenance;
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
