// SPDX-License-Identifier: Apache-2.0
#include "writing.hpp"

#include "record_parts.hpp"
#include "schema.hpp"
#include "structure.hpp"
#include "words.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include <sqlite3.h>

#include "kompono/catalog/hash.hpp"

namespace kompono::catalog {
namespace {

bool Same(const Provenance& a, const Provenance& b) {
  return a.source_sha256 == b.source_sha256 && a.source_path == b.source_path &&
         a.program_version == b.program_version &&
         std::equal(a.plugins.begin(),
                    a.plugins.end(),
                    b.plugins.begin(),
                    b.plugins.end(),
                    [](const PluginVersion& x, const PluginVersion& y) {
                      return x.id == y.id && x.version == y.version;
                    });
}

}  // namespace

Dictionary::Entry Dictionary::Find(std::span<const std::string_view> columns) {
  key_.clear();
  for (const std::string_view column : columns) {
    key_ += column;
    key_ += '\0';
  }
  if (const auto found = known_.find(key_); found != known_.end()) return {.id = found->second};
  const auto bind = [columns](Command& command) -> Command& {
    const auto used = static_cast<std::size_t>(command.ParameterCount());
    for (const std::string_view column : columns.first(used)) command.Text(column);
    return command;
  };
  Entry entry;
  entry.written = bind(insert_).Run() > 0;
  entry.id = bind(select_).Ask();
  known_.emplace(key_, entry.id);
  return entry;
}

Writer::Writer(SQLite::Database& db)
    : db_(db),
      hashes_(db),
      formulas_(
          db,
          "INSERT INTO formula(text, distribution, relative_motion, base) VALUES(?1, ?2, ?3, ?4) "
          "ON CONFLICT(text) DO UPDATE SET distribution = ?2, relative_motion = ?3, base = ?4 "
          "WHERE distribution IS NOT ?2 OR relative_motion IS NOT ?3 OR base IS NOT ?4",
          "SELECT id FROM formula WHERE text = ?1"),
      formula_texts_(db, "SELECT id FROM formula WHERE text = ?1"),
      provenances_(db,
                   "INSERT INTO provenance(source_hash, source_path, program_version, plugins) "
                   "VALUES(?1, ?2, ?3, ?4) ON CONFLICT DO NOTHING",
                   "SELECT id FROM provenance WHERE source_hash = ?1 AND source_path = ?2 "
                   "AND program_version = ?3 AND plugins = ?4"),
      modules_(db,
               "INSERT INTO module(name, plugin) VALUES(?1, ?2) ON CONFLICT DO NOTHING",
               "SELECT id FROM module WHERE name = ?1 AND plugin = ?2"),
      quantities_(db,
                  "INSERT INTO quantity(name, unit) VALUES(?1, ?2) ON CONFLICT DO NOTHING",
                  "SELECT id FROM quantity WHERE name = ?1 AND unit = ?2"),
      measures_(db,
                "INSERT INTO measure(name, unit, method) VALUES(?1, ?2, ?3) ON CONFLICT DO NOTHING",
                "SELECT id FROM measure WHERE name = ?1 AND unit = ?2 AND method = ?3"),
      terms_(db,
             "INSERT INTO term(text) VALUES(?1) ON CONFLICT DO NOTHING",
             "SELECT id FROM term WHERE text = ?1"),
      tree_(db, "UPDATE formula SET tree = ?2 WHERE id = ?1"),
      clear_motions_(db, "DELETE FROM motion WHERE formula_id = ?"),
      motion_(db, "INSERT INTO motion VALUES(?, ?, ?, ?, ?, ?)"),
      plugin_(db, "INSERT INTO provenance_plugin VALUES(?, ?, ?)"),
      layout_(db,
              "layout(id, hash_key, content_hash, name, formula_id, coordinates, drives, "
              "provenance_id, added_at)",
              9),
      text_(db, "layout_text", 3),
      refresh_derived_(db,
                       "UPDATE layout SET coordinates = ?2, drives = ?3 WHERE id = ?1 "
                       "AND (coordinates <> ?2 OR drives <> ?3)"),
      refresh_text_(db, "UPDATE layout_text SET toml = ?2 WHERE layout_id = ?1 AND toml IS NOT ?2"),
      refresh_provenance_(db, "UPDATE layout SET provenance_id = ?2 WHERE id = ?1"),
      block_(db, "layout_block", 4),
      parameter_(db, "parameter", 3),
      fresh_metric_(db, "metric", 5),
      fresh_capability_(db, "capability", 4),
      metric_(db,
              "INSERT INTO metric VALUES(?1, ?2, ?3, ?4, ?5) ON CONFLICT DO UPDATE SET value = ?3, "
              "failure = ?4, provenance_id = ?5 WHERE value IS NOT ?3 OR failure IS NOT ?4"),
      capability_(
          db,
          "INSERT INTO capability VALUES(?1, ?2, ?3, ?4) ON CONFLICT DO UPDATE SET detail = ?3, "
          "provenance_id = ?4 WHERE detail IS NOT ?3"),
      calibration_(db,
                   "INSERT INTO calibration(layout_id, content_hash, measurements, "
                   "measurements_hash, status, "
                   "rms_before_um, rms_after_um, sigma_um, degrees_of_freedom, provenance_id, "
                   "added_at, report) "
                   "VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING"),
      has_words_(db, "SELECT count(*) FROM word WHERE rowid = 2 * ?1"),
      clear_words_(db, "DELETE FROM word WHERE rowid = 2 * ?1"),
      words_(db,
             fmt::format("INSERT INTO word(rowid, name, formula, parts, text) {} WHERE l.id = ?1",
                         kWordsOfLayouts)) {}

std::int64_t Writer::TermOf(std::string_view text) {
  return terms_.Find(std::array{text}).id;
}

std::int64_t Writer::QuantityOf(std::string_view name, std::string_view unit) {
  return quantities_.Find(std::array{name, unit}).id;
}

std::int64_t Writer::MeasureOf(const Metric& metric) {
  return measures_.Find(std::array<std::string_view, 3>{metric.name, metric.unit, metric.method})
      .id;
}

std::int64_t Writer::FormulaOf(const LayoutRecord& record) {
  if (record.distribution.empty() && record.relative_motion.empty() && record.motions.empty())
    return FormulaOf(record.formula);
  const std::array<std::string_view, 4> columns{record.formula,
                                                record.distribution,
                                                record.relative_motion,
                                                record.open_base ? "open" : "closed"};
  const Dictionary::Entry entry = formulas_.Find(columns);
  if (entry.written) FillFormula(entry.id, record.formula, record.motions);
  return entry.id;
}

std::int64_t Writer::FormulaOf(const std::string& text) {
  if (const auto known = known_texts_.find(text); known != known_texts_.end()) return known->second;
  std::optional<std::int64_t> id = formula_texts_.Text(text).Look();
  if (!id) {
    const FormulaFacts facts = FactsOf(text);
    const std::array<std::string_view, 4> columns{
        text, facts.distribution, facts.relative_motion, facts.open_base ? "open" : "closed"};
    id = formulas_.Find(columns).id;
    FillFormula(*id, text, facts.motions);
  }
  known_texts_.emplace(text, *id);
  return *id;
}

void Writer::FillFormula(std::int64_t id,
                         const std::string& text,
                         std::span<const Motion> motions) {
  const std::string tree = TreeJson(text);
  tree_.Integer(id).TextOrNull(tree).Run();
  clear_motions_.Integer(id).Run();
  const std::vector<Motion> derived =
      motions.empty() ? FactsOf(text).motions : std::vector<Motion>();
  std::int64_t position = 0;
  for (const Motion& motion : motions.empty() ? std::span<const Motion>(derived) : motions) {
    motion_.Integer(id)
        .Integer(position++)
        .Text(motion.axis)
        .Text(motion.side == Side::kWorkpiece ? "workpiece" : "tool")
        .Integer(motion.working ? 1 : 0)
        .Text(motion.block)
        .Run();
  }
}

std::int64_t Writer::ProvenanceOf(const Provenance& provenance, std::string_view text) {
  if (run_ && !provenance.source_sha256.empty() && Same(*run_, provenance)) return run_id_;
  const std::optional<Sha256> given = Sha256FromHex(provenance.source_sha256);
  const std::string source = Hex(given ? *given : Sha256Of(text));
  const std::string plugins = PluginText(provenance);
  const std::array<std::string_view, 4> columns{source,
                                                provenance.source_path,
                                                provenance.program_version.empty()
                                                    ? std::string_view(KOMPONO_PROGRAM_VERSION)
                                                    : provenance.program_version,
                                                plugins};
  const Dictionary::Entry entry = provenances_.Find(columns);
  run_ = provenance;
  run_id_ = entry.id;
  if (!entry.written) return entry.id;
  for (const PluginVersion& plugin : provenance.plugins) {
    plugin_.Integer(entry.id).Text(plugin.id).Text(plugin.version).Run();
  }
  return entry.id;
}

void Writer::Begin(bool bulk) {
  now_ = Now();
  hashes_.Begin(bulk);
  // The transaction holds the write lock: nobody else numbers layouts.
  newest_layout_ = db_.execAndGet("SELECT coalesce(max(id), 0) FROM layout").getInt64();
}

AddResult Writer::Add(const LayoutRecord& record) {
  const std::int64_t provenance = ProvenanceOf(record.provenance, record.toml);
  const AddResult result = Put(record, FormulaOf(record), record.metrics, provenance);
  if (result.status == AddStatus::kAdded) {
    waiting_for_words_.push_back(result.id);
  } else if (result.status == AddStatus::kUpdated || has_words_.Integer(result.id).Ask() == 0) {
    clear_words_.Integer(result.id).Run();
    words_.Integer(result.id).Run();
  }
  return result;
}

Writer::OfStudy Writer::AddOfStudy(const LayoutRecord& record,
                                   std::span<const Metric> metrics,
                                   std::int64_t provenance) {
  const std::int64_t formula = FormulaOf(record);
  return {.layout = Put(record, formula, metrics, provenance).id, .formula = formula};
}

AddResult Writer::Put(const LayoutRecord& record,
                      std::int64_t formula,
                      std::span<const Metric> metrics,
                      std::int64_t provenance) {
  const Sha256 digest = ContentDigest(record);
  AddResult result;
  if (const std::optional<std::int64_t> found = Find(digest)) {
    result.id = *found;
    int changed = RefreshDerived(result.id, record);
    changed += RefreshText(result.id, record, provenance);
    changed += AddMetrics(result.id, metrics, provenance);
    changed += AddCapabilities(result.id, record, provenance);
    changed += AddCalibrations(result.id, record, provenance);
    result.status = changed > 0 ? AddStatus::kUpdated : AddStatus::kUnchanged;
    return result;
  }
  result.id = PutNew(digest, record, formula, provenance);
  for (const Metric& metric : metrics) {
    fresh_metric_.Integer(result.id).Integer(MeasureOf(metric)).RealOrNull(metric.value);
    fresh_metric_.TextOrNull(metric.failure).Integer(provenance);
  }
  for (const Capability& capability : record.capabilities) {
    fresh_capability_.Integer(result.id).Integer(TermOf(capability.name));
    fresh_capability_.Text(capability.detail).Integer(provenance);
  }
  if (!record.calibrations.empty()) {
    Flush();  // their rows refer to the layout's
    AddCalibrations(result.id, record, provenance);
  }
  return result;
}

/// What is found can be read and changed at once.
std::optional<std::int64_t> Writer::Find(const Sha256& digest) {
  const std::span<const Sha256> waiting = std::span(waiting_digests_).first(waiting_);
  if (std::find(waiting.begin(), waiting.end(), digest) != waiting.end()) Flush();
  return hashes_.Find(digest);
}

std::int64_t Writer::PutNew(const Sha256& digest,
                            const LayoutRecord& record,
                            std::int64_t formula,
                            std::int64_t provenance) {
  if (waiting_ == kMostWaiting) Flush();
  const Sha256& kept = waiting_digests_.at(waiting_++) = digest;
  const std::int64_t id = ++newest_layout_;
  layout_.Integer(id).Integer(KeyOf(digest)).Digest(kept).Text(record.name).Integer(formula);
  layout_.Integer(record.coordinates).Integer(record.drives).Integer(provenance).Text(now_);
  hashes_.Added(digest, id);
  AddStructure(id, record);
  return id;
}

void Writer::Flush() {
  layout_.Write();  // first, because the others refer to it
  text_.Write();
  block_.Write();
  parameter_.Write();
  fresh_metric_.Write();
  fresh_capability_.Write();
  waiting_ = 0;
  for (const std::int64_t layout : waiting_for_words_) words_.Integer(layout).Run();
  waiting_for_words_.clear();
}

void Writer::AddStructure(std::int64_t layout, const LayoutRecord& record) {
  text_.Integer(layout).Text(record.toml).TextOrNull(record.content);
  std::int64_t position = 0;
  for (const Block& block : record.blocks) {
    const std::int64_t module =
        modules_.Find(std::array<std::string_view, 2>{block.module, block.plugin}).id;
    block_.Integer(layout).Integer(position++).Text(block.name).Integer(module);
  }
  for (const Parameter& parameter : record.parameters) {
    const std::int64_t quantity = QuantityOf(parameter.name, parameter.unit);
    parameter_.Integer(layout).Integer(quantity).Real(parameter.value);
  }
}

/// Numbers that follow from the layout, but that another version of the program may count
/// otherwise.
int Writer::RefreshDerived(std::int64_t layout, const LayoutRecord& record) {
  return refresh_derived_.Integer(layout).Integer(record.coordinates).Integer(record.drives).Run();
}

int Writer::RefreshText(std::int64_t layout, const LayoutRecord& record, std::int64_t provenance) {
  if (refresh_text_.Integer(layout).Text(record.toml).Run() == 0) return 0;
  return refresh_provenance_.Integer(layout).Integer(provenance).Run();
}

int Writer::AddMetrics(std::int64_t layout,
                       std::span<const Metric> metrics,
                       std::int64_t provenance) {
  int changed = 0;
  for (const Metric& metric : metrics) {
    const std::int64_t measure = MeasureOf(metric);
    metric_.Integer(layout).Integer(measure).RealOrNull(metric.value);
    changed += metric_.TextOrNull(metric.failure).Integer(provenance).Run();
  }
  return changed;
}

int Writer::AddCapabilities(std::int64_t layout,
                            const LayoutRecord& record,
                            std::int64_t provenance) {
  int changed = 0;
  for (const Capability& capability : record.capabilities) {
    const std::int64_t name = TermOf(capability.name);
    changed +=
        capability_.Integer(layout).Integer(name).Text(capability.detail).Integer(provenance).Run();
  }
  return changed;
}

int Writer::AddCalibrations(std::int64_t layout,
                            const LayoutRecord& record,
                            std::int64_t provenance) {
  int changed = 0;
  for (const Calibration& calibration : record.calibrations) {
    const Sha256 digest = ContentDigest(calibration);
    const std::string measurements = Hex(Sha256FromHex(calibration.measurements_sha256).value());
    calibration_.Integer(layout).Digest(digest).Text(calibration.measurements).Text(measurements);
    calibration_.Text(calibration.status).RealOrNull(calibration.rms_before_um);
    calibration_.RealOrNull(calibration.rms_after_um).RealOrNull(calibration.sigma_um);
    calibration_.Integer(calibration.degrees_of_freedom).Integer(provenance);
    changed += calibration_.Text(now_).Text(calibration.report_json).Run();
  }
  return changed;
}

}  // namespace kompono::catalog
