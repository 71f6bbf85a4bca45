// SPDX-License-Identifier: Apache-2.0
#include "writing.hpp"

#include "record_parts.hpp"
#include "schema.hpp"

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
      formulas_(
          db,
          "INSERT INTO formula(text, distribution, relative_motion, base) VALUES(?1, ?2, ?3, ?4) "
          "ON CONFLICT(text) DO UPDATE SET distribution = ?2, relative_motion = ?3, base = ?4 "
          "WHERE distribution IS NOT ?2 OR relative_motion IS NOT ?3 OR base IS NOT ?4",
          "SELECT id FROM formula WHERE text = ?1"),
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
      terms_(db,
             "INSERT INTO term(text) VALUES(?1) ON CONFLICT DO NOTHING",
             "SELECT id FROM term WHERE text = ?1"),
      clear_motions_(db, "DELETE FROM motion WHERE formula_id = ?"),
      motion_(db, "INSERT INTO motion VALUES(?, ?, ?, ?, ?, ?)"),
      plugin_(db, "INSERT INTO provenance_plugin VALUES(?, ?, ?)"),
      layout_(db,
              "INSERT INTO layout(content_hash, name, formula_id, coordinates, drives, "
              "provenance_id, added_at) "
              "VALUES(?, ?, ?, ?, ?, ?, ?) ON CONFLICT(content_hash) DO NOTHING"),
      find_layout_(db, "SELECT id FROM layout WHERE content_hash = ?"),
      text_(db, "INSERT INTO layout_text VALUES(?, ?, ?)"),
      refresh_derived_(db,
                       "UPDATE layout SET coordinates = ?2, drives = ?3 WHERE id = ?1 "
                       "AND (coordinates <> ?2 OR drives <> ?3)"),
      refresh_text_(db, "UPDATE layout_text SET toml = ?2 WHERE layout_id = ?1 AND toml IS NOT ?2"),
      refresh_provenance_(db, "UPDATE layout SET provenance_id = ?2 WHERE id = ?1"),
      block_(db, "INSERT INTO layout_block VALUES(?, ?, ?, ?)"),
      parameter_(db, "INSERT INTO parameter VALUES(?, ?, ?)"),
      metric_(
          db,
          "INSERT INTO metric VALUES(?1, ?2, ?3, ?4, ?5, ?6) ON CONFLICT DO UPDATE SET value = ?4, "
          "failure = ?5, provenance_id = ?6 WHERE value IS NOT ?4 OR failure IS NOT ?5"),
      capability_(
          db,
          "INSERT INTO capability VALUES(?1, ?2, ?3, ?4) ON CONFLICT DO UPDATE SET detail = ?3, "
          "provenance_id = ?4 WHERE detail IS NOT ?3"),
      calibration_(db,
                   "INSERT INTO calibration(layout_id, content_hash, measurements, "
                   "measurements_hash, status, "
                   "rms_before_um, rms_after_um, sigma_um, degrees_of_freedom, provenance_id, "
                   "added_at, report) "
                   "VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING") {}

std::int64_t Writer::TermOf(std::string_view text) {
  return terms_.Find(std::array{text}).id;
}

std::int64_t Writer::QuantityOf(std::string_view name, std::string_view unit) {
  return quantities_.Find(std::array{name, unit}).id;
}

std::int64_t Writer::FormulaOf(const LayoutRecord& record) {
  const std::array<std::string_view, 4> columns{record.formula,
                                                record.distribution,
                                                record.relative_motion,
                                                record.open_base ? "open" : "closed"};
  const Dictionary::Entry entry = formulas_.Find(columns);
  if (!entry.written) return entry.id;
  clear_motions_.Integer(entry.id).Run();
  std::int64_t position = 0;
  for (const Motion& motion : record.motions) {
    motion_.Integer(entry.id)
        .Integer(position++)
        .Text(motion.axis)
        .Text(motion.side == Side::kWorkpiece ? "workpiece" : "tool")
        .Integer(motion.working ? 1 : 0)
        .Text(motion.block)
        .Run();
  }
  return entry.id;
}

std::int64_t Writer::ProvenanceOf(const LayoutRecord& record) {
  const Provenance& provenance = record.provenance;
  if (run_ && !provenance.source_sha256.empty() && Same(*run_, provenance)) return run_id_;
  const std::optional<Sha256> given = Sha256FromHex(provenance.source_sha256);
  const std::string source = Hex(given ? *given : Sha256Of(record.toml));
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

void Writer::Begin() {
  now_ = Now();
}

AddResult Writer::Add(const LayoutRecord& record) {
  const Sha256 digest = ContentDigest(record);
  const std::int64_t provenance = ProvenanceOf(record);
  const std::int64_t formula = FormulaOf(record);
  layout_.Digest(digest).Text(record.name).Integer(formula).Integer(record.coordinates);
  layout_.Integer(record.drives).Integer(provenance).Text(now_);
  AddResult result;
  if (layout_.Run() > 0) {
    result.id = db_.getLastInsertRowid();
    AddStructure(result.id, record);
    AddResults(result.id, record, provenance);
    AddCalibrations(result.id, record, provenance);
    return result;
  }
  result.id = find_layout_.Digest(digest).Ask();
  int changed = RefreshDerived(result.id, record);
  changed += RefreshText(result.id, record, provenance);
  changed += AddResults(result.id, record, provenance);
  changed += AddCalibrations(result.id, record, provenance);
  result.status = changed > 0 ? AddStatus::kUpdated : AddStatus::kUnchanged;
  return result;
}

void Writer::AddStructure(std::int64_t layout, const LayoutRecord& record) {
  text_.Integer(layout).Text(record.toml).TextOrNull(record.content).Run();
  std::int64_t position = 0;
  for (const Block& block : record.blocks) {
    const std::int64_t module =
        modules_.Find(std::array<std::string_view, 2>{block.module, block.plugin}).id;
    block_.Integer(layout).Integer(position++).Text(block.name).Integer(module).Run();
  }
  for (const Parameter& parameter : record.parameters) {
    const std::int64_t quantity = QuantityOf(parameter.name, parameter.unit);
    parameter_.Integer(layout).Integer(quantity).Real(parameter.value).Run();
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

int Writer::AddResults(std::int64_t layout, const LayoutRecord& record, std::int64_t provenance) {
  int changed = 0;
  for (const Metric& metric : record.metrics) {
    const std::int64_t quantity = QuantityOf(metric.name, metric.unit);
    const std::int64_t method = TermOf(metric.method);
    metric_.Integer(layout).Integer(quantity).Integer(method).RealOrNull(metric.value);
    changed += metric_.TextOrNull(metric.failure).Integer(provenance).Run();
  }
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
