// SPDX-License-Identifier: Apache-2.0
#include "kompono/catalog/record.hpp"

#include "failure.hpp"
#include "record_parts.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tuple>

namespace kompono::catalog {
namespace {

/// Texts with their lengths in front, numbers by their bits: different values never make equal
/// bytes.
class Bytes {
 public:
  void Add(std::string_view text) {
    AddNumber(text.size());
    bytes_ += text;
  }
  void Add(double value) { AddNumber(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value)); }
  void Add(const std::optional<double>& value) {
    AddNumber(value ? 1 : 0);
    if (value) Add(*value);
  }
  void AddNumber(std::uint64_t value) {
    std::array<char, 8> little{};
    for (char& byte : little) {
      byte = static_cast<char>(value & 0xFFU);
      value >>= 8U;
    }
    bytes_.append(little.data(), little.size());
  }
  void Reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  [[nodiscard]] Sha256 Digest() const { return Sha256Of(bytes_); }

 private:
  std::string bytes_;
};

/// "the unit of metric" "stiffness": put together only if there is something to say.
struct Subject {
  std::string_view what;
  std::string_view name = {};
  [[nodiscard]] std::string Text() const {
    return name.empty() ? std::string(what) : fmt::format("{} '{}'", what, name);
  }
};

/// Collects what is wrong with one record.
class Judge {
 public:
  explicit Judge(const LayoutRecord& record)
      : file_(record.provenance.source_path.empty() ? record.name : record.provenance.source_path) {
  }

  void Require(bool good, const Subject& subject, std::string_view fault) {
    if (!good)
      found_.push_back(
          Complaint("E0511", std::string(file_), fmt::format("{} {}", subject.Text(), fault)));
  }
  void Text(std::string_view text, const Subject& subject) {
    Require(IsText(text), subject, "is not UTF-8 text");
  }
  void Name(std::string_view text, const Subject& subject) {
    Require(!text.empty(), subject, "is empty");
    Text(text, subject);
  }
  void Finite(const std::optional<double>& value, const Subject& subject) {
    Require(!value || std::isfinite(*value), subject, "is not a finite number");
  }
  void Digest(std::string_view hex, const Subject& subject) {
    Require(Sha256FromHex(hex).has_value(), subject, "is not 64 hexadecimal digits");
  }
  template <class List, class Key>
  void Unique(const List& list, std::string_view what, Key key) {
    // Few compare quicker in pairs, without a list of their own.
    constexpr std::size_t kFew = 6;
    if (list.size() <= kFew) {
      for (auto one = list.begin(); one != list.end(); ++one) {
        const auto same = [&](const auto& other) { return key(other) == key(*one); };
        Require(std::none_of(list.begin(), one, same), {what, std::get<0>(key(*one))}, kTwice);
      }
      return;
    }
    using Keys = std::vector<decltype(key(*list.begin()))>;
    Keys keys;
    keys.reserve(list.size());
    for (const auto& item : list) keys.push_back(key(item));
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 1; i < keys.size(); ++i) {
      Require(keys[i] != keys[i - 1], {what, std::get<0>(keys[i])}, kTwice);
    }
  }
  [[nodiscard]] Diagnostics Take() { return std::move(found_); }

 private:
  static constexpr std::string_view kTwice = "is given twice";

  std::string_view file_;
  Diagnostics found_;
};

void CheckStructure(const LayoutRecord& record, Judge& judge) {
  judge.Name(record.name, {"the layout's name"});
  judge.Name(record.formula, {"the formula"});
  judge.Text(record.distribution, {"the distribution key"});
  judge.Text(record.relative_motion, {"the relative-motion key"});
  judge.Text(record.toml, {"the layout file"});
  judge.Text(record.content, {"the canonical content"});
  judge.Require(record.coordinates >= 0, {"the number of coordinates"}, "is negative");
  judge.Require(record.drives >= 0, {"the number of drives"}, "is negative");
  for (const Motion& motion : record.motions) {
    judge.Name(motion.axis, {"an axis of the formula"});
    judge.Text(motion.block, {"the block of axis", motion.axis});
  }
  for (const Block& block : record.blocks) {
    judge.Name(block.name, {"a block's name"});
    judge.Name(block.module, {"the module of block", block.name});
    judge.Text(block.plugin, {"the plugin of block", block.name});
  }
  judge.Unique(
      record.blocks, "block", [](const Block& b) { return std::tuple<std::string_view>(b.name); });
  for (const Parameter& parameter : record.parameters) {
    judge.Name(parameter.name, {"a parameter's name"});
    judge.Text(parameter.unit, {"the unit of parameter", parameter.name});
    judge.Finite(parameter.value, {"parameter", parameter.name});
  }
  judge.Unique(record.parameters, "parameter", [](const Parameter& p) {
    return std::tuple<std::string_view>(p.name);
  });
}

void CheckMetrics(const LayoutRecord& record, Judge& judge) {
  for (const Metric& metric : record.metrics) {
    judge.Name(metric.name, {"a metric's name"});
    judge.Text(metric.unit, {"the unit of metric", metric.name});
    judge.Text(metric.method, {"the method of metric", metric.name});
    judge.Text(metric.failure, {"the failure of metric", metric.name});
    judge.Finite(metric.value, {"metric", metric.name});
    judge.Require(
        metric.value.has_value() == metric.failure.empty(),
        {"metric", metric.name},
        metric.value ? "has a value and a failure" : "has neither a value nor a reason why");
  }
  judge.Unique(record.metrics, "metric", [](const Metric& m) {
    return std::tuple<std::string_view, std::string_view, std::string_view>(
        m.name, m.unit, m.method);
  });
}

void CheckResults(const LayoutRecord& record, Judge& judge) {
  for (const Capability& capability : record.capabilities) {
    judge.Name(capability.name, {"a capability's name"});
    judge.Text(capability.detail, {"the detail of capability", capability.name});
  }
  judge.Unique(record.capabilities, "capability", [](const Capability& c) {
    return std::tuple<std::string_view>(c.name);
  });
  for (const Calibration& calibration : record.calibrations) {
    const std::string& name = calibration.measurements;
    judge.Text(name, {"the name of a measurement file"});
    judge.Digest(calibration.measurements_sha256,
                 {"the measurements' hash of the calibration with", name});
    judge.Name(calibration.status, {"the status of the calibration with", name});
    for (const auto& value :
         {calibration.rms_before_um, calibration.rms_after_um, calibration.sigma_um}) {
      const Subject subject{"a residual of the calibration with", name};
      judge.Finite(value, subject);
      judge.Require(!value || !(*value < 0.0), subject, "is negative");
    }
    judge.Require(
        IsText(calibration.report_json) && nlohmann::json::accept(calibration.report_json),
        {"the report of the calibration with", name},
        "is not JSON");
  }
}

void CheckProvenance(const Provenance& provenance, Judge& judge) {
  judge.Text(provenance.program_version, {"the program version"});
  judge.Text(provenance.source_path, {"the source's path"});
  if (!provenance.source_sha256.empty())
    judge.Digest(provenance.source_sha256, {"the source's hash"});
  for (const PluginVersion& plugin : provenance.plugins) {
    judge.Name(plugin.id, {"a plugin's id"});
    judge.Text(plugin.version, {"the version of plugin", plugin.id});
  }
  judge.Unique(provenance.plugins, "plugin", [](const PluginVersion& p) {
    return std::tuple<std::string_view>(p.id);
  });
}

/// LF line ends: a checkout on another system is the same layout.
std::string WithoutCarriageReturns(std::string_view toml) {
  std::string text;
  text.reserve(toml.size());
  for (std::size_t i = 0; i < toml.size(); ++i) {
    if (toml[i] != '\r' || i + 1 == toml.size() || toml[i + 1] != '\n') text += toml[i];
  }
  return text;
}

nlohmann::ordered_json NumberOrNull(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json StructureJson(const LayoutRecord& record) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  json["motions"] = nlohmann::ordered_json::array();
  for (const Motion& motion : record.motions) {
    json["motions"].push_back({{"axis", motion.axis},
                               {"side", motion.side == Side::kWorkpiece ? "workpiece" : "tool"},
                               {"working", motion.working},
                               {"block", motion.block}});
  }
  json["blocks"] = nlohmann::ordered_json::array();
  for (const Block& block : record.blocks) {
    json["blocks"].push_back(
        {{"name", block.name}, {"module", block.module}, {"plugin", block.plugin}});
  }
  json["parameters"] = nlohmann::ordered_json::array();
  for (const Parameter& parameter : record.parameters) {
    json["parameters"].push_back(
        {{"name", parameter.name}, {"value", parameter.value}, {"unit", parameter.unit}});
  }
  return json;
}

nlohmann::ordered_json ResultsJson(const LayoutRecord& record) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  json["metrics"] = nlohmann::ordered_json::array();
  for (const Metric& metric : record.metrics) {
    nlohmann::ordered_json entry{{"name", metric.name},
                                 {"value", NumberOrNull(metric.value)},
                                 {"unit", metric.unit},
                                 {"method", metric.method}};
    if (!metric.failure.empty()) entry["failure"] = metric.failure;
    json["metrics"].push_back(std::move(entry));
  }
  json["capabilities"] = nlohmann::ordered_json::array();
  for (const Capability& capability : record.capabilities) {
    json["capabilities"].push_back({{"name", capability.name}, {"detail", capability.detail}});
  }
  json["calibrations"] = nlohmann::ordered_json::array();
  for (const Calibration& calibration : record.calibrations) {
    json["calibrations"].push_back(
        {{"measurements", calibration.measurements},
         {"measurements_sha256", calibration.measurements_sha256},
         {"status", calibration.status},
         {"rms_before_um", NumberOrNull(calibration.rms_before_um)},
         {"rms_after_um", NumberOrNull(calibration.rms_after_um)},
         {"sigma_um", NumberOrNull(calibration.sigma_um)},
         {"degrees_of_freedom", calibration.degrees_of_freedom},
         {"report", nlohmann::ordered_json::parse(calibration.report_json, nullptr, false)}});
  }
  return json;
}

}  // namespace

Sha256 ContentDigest(const LayoutRecord& record) {
  Bytes bytes;
  bytes.Reserve(512 + record.content.size() + (record.content.empty() ? record.toml.size() : 0));
  bytes.Add("kompono layout 1");
  bytes.Add(record.name);
  bytes.Add(record.formula);
  bytes.AddNumber(record.blocks.size());
  for (const Block& block : record.blocks) {
    bytes.Add(block.name);
    bytes.Add(block.module);
  }
  std::vector<const Parameter*> parameters;
  parameters.reserve(record.parameters.size());
  for (const Parameter& parameter : record.parameters) parameters.push_back(&parameter);
  std::sort(parameters.begin(), parameters.end(), [](const Parameter* a, const Parameter* b) {
    return std::tie(a->name, a->unit) < std::tie(b->name, b->unit);
  });
  bytes.AddNumber(parameters.size());
  for (const Parameter* parameter : parameters) {
    bytes.Add(parameter->name);
    bytes.Add(parameter->value);
    bytes.Add(parameter->unit);
  }
  if (!record.content.empty() || record.toml.find('\r') == std::string::npos) {
    bytes.Add(record.content.empty() ? record.toml : record.content);
  } else {
    bytes.Add(WithoutCarriageReturns(record.toml));
  }
  return bytes.Digest();
}

Sha256 ContentDigest(const Calibration& calibration) {
  Bytes bytes;
  bytes.Add("kompono calibration 1");
  const std::optional<Sha256> measurements = Sha256FromHex(calibration.measurements_sha256);
  bytes.Add(measurements ? Hex(*measurements) : std::string());
  bytes.Add(calibration.status);
  bytes.Add(calibration.rms_before_um);
  bytes.Add(calibration.rms_after_um);
  bytes.Add(calibration.sigma_um);
  bytes.AddNumber(static_cast<std::uint64_t>(calibration.degrees_of_freedom));
  bytes.Add(calibration.report_json);
  return bytes.Digest();
}

std::int64_t KeyOf(const Sha256& digest) {
  std::uint64_t key = 0;
  for (std::size_t i = 0; i < 8; ++i) key = key << 8U | digest.at(i);
  return static_cast<std::int64_t>(key);
}

std::string PluginText(const Provenance& provenance) {
  std::vector<std::string> plugins;
  for (const PluginVersion& plugin : provenance.plugins)
    plugins.push_back(plugin.id + " " + plugin.version);
  std::sort(plugins.begin(), plugins.end());
  return fmt::format("{}", fmt::join(plugins, ", "));
}

Diagnostics Check(const LayoutRecord& record) {
  Judge judge(record);
  CheckStructure(record, judge);
  CheckMetrics(record, judge);
  CheckResults(record, judge);
  CheckProvenance(record.provenance, judge);
  return judge.Take();
}

std::string ContentHash(const LayoutRecord& record) {
  return Hex(ContentDigest(record));
}

nlohmann::ordered_json ToJson(const StoredLayout& layout) {
  const LayoutRecord& record = layout.record;
  nlohmann::ordered_json json{{"id", layout.id},
                              {"hash", layout.hash},
                              {"name", record.name},
                              {"formula", record.formula},
                              {"distribution", record.distribution},
                              {"relative_motion", record.relative_motion},
                              {"base", record.open_base ? "open" : "closed"},
                              {"coordinates", record.coordinates},
                              {"drives", record.drives},
                              {"rms_before_um", NumberOrNull(layout.rms_before_um)},
                              {"rms_after_um", NumberOrNull(layout.rms_after_um)}};
  json.update(StructureJson(record));
  json.update(ResultsJson(record));
  nlohmann::ordered_json plugins = nlohmann::ordered_json::array();
  for (const PluginVersion& plugin : record.provenance.plugins) {
    plugins.push_back({{"id", plugin.id}, {"version", plugin.version}});
  }
  json["provenance"] = {{"program_version", record.provenance.program_version},
                        {"plugins", std::move(plugins)},
                        {"source", record.provenance.source_path},
                        {"source_sha256", record.provenance.source_sha256}};
  json["added_at"] = layout.added_at;
  json["toml"] = record.toml;
  return json;
}

}  // namespace kompono::catalog
