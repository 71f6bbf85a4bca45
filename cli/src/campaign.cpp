// SPDX-License-Identifier: Apache-2.0
#include "campaign.hpp"

#include "text.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include <toml++/toml.h>

#include "kompono/calibration/codes.hpp"
#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::cli {
namespace {

class CampaignReader {
 public:
  CampaignReader(std::string_view text, const std::string& file)
      : text_(text), file_(file), folder_(std::filesystem::path(file).parent_path()) {}

  Parsed<Campaign> Read() {
    toml::table root;
    try {
      root = toml::parse(text_, file_);
    } catch (const toml::parse_error& error) {
      Complain(error.source(), std::string(error.description()));
      return tl::unexpected(std::move(complaints_));
    }
    Campaign campaign;
    KnowOnly(root, {"measurements", "layout", "file", "fit"});
    if (root["measurements"].value<std::int64_t>() != 1) {
      Complain(root["measurements"], "'measurements' must be 1, the version of this format");
    }
    campaign.layout = Beside(Text(root, "layout"));
    const toml::array* files = root["file"].as_array();
    if (files == nullptr || files->empty()) {
      Complain(root.source(), "no [[file]] with measurements", "[[file]] csv = \"points.csv\"");
    } else {
      for (const toml::node& node : *files) campaign.files.push_back(File(node));
    }
    if (const toml::node* fit = root.get("fit")) ReadFit(*fit, &campaign);
    if (!complaints_.empty()) return tl::unexpected(std::move(complaints_));
    return campaign;
  }

 private:
  void Complain(const toml::source_region& where, std::string message, std::string help = "") {
    Diagnostic complaint{.code = calibration::codes::kBadCampaign.code,
                         .file = file_,
                         .message = std::move(message),
                         .help = std::move(help)};
    if (where.begin.line > 0) {
      complaint.span = SpanAt(
          text_, static_cast<int>(where.begin.line), static_cast<int>(where.begin.column), 1);
    }
    complaints_.push_back(std::move(complaint));
  }
  template <class View>
  void Complain(const toml::node_view<View>& view, std::string message) {
    Complain(view.node() != nullptr ? view.node()->source() : toml::source_region{},
             std::move(message));
  }

  void KnowOnly(const toml::table& table, const std::vector<std::string>& keys) {
    for (const auto& [key, value] : table) {
      const std::string name(key.str());
      if (std::find(keys.begin(), keys.end(), name) != keys.end()) continue;
      Complain(key.source(), fmt::format("unknown key '{}'", name), DidYouMean(name, keys));
    }
  }

  std::string Text(const toml::table& table, const char* key) {
    const toml::node* node = table.get(key);
    if (node != nullptr && node->is_string()) return node->ref<std::string>();
    Complain(node != nullptr ? node->source() : table.source(),
             fmt::format("'{}' must be the name of a file", key));
    return {};
  }

  [[nodiscard]] std::string Beside(const std::string& name) const {
    return name.empty() ? name : (folder_ / name).lexically_normal().string();
  }

  std::optional<double> Deviation(const toml::table& table, const char* key) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return std::nullopt;
    const std::optional<double> number = node->value<double>();
    if (!number || !(*number > 0.0)) {
      Complain(node->source(), fmt::format("'{}' must be a number greater than 0", key));
    }
    return number;
  }

  MeasurementSource File(const toml::node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr) {
      Complain(node.source(), "a [[file]] must be a table");
      return {};
    }
    KnowOnly(*table, {"csv", "sigma_mm", "sigma_deg", "held_out"});
    MeasurementSource file;
    file.name = Beside(Text(*table, "csv"));
    file.sigma_mm = Deviation(*table, "sigma_mm");
    file.sigma_rad = Deviation(*table, "sigma_deg");
    if (file.sigma_rad) *file.sigma_rad /= kDegPerRad;
    if (const toml::node* held_out = table->get("held_out")) {
      if (!held_out->is_boolean()) Complain(held_out->source(), "'held_out' is true or false");
      file.held_out = held_out->value_or(false);
    }
    return file;
  }

  std::vector<std::string> Patterns(const toml::table& fit, const char* key) {
    std::vector<std::string> out;
    const toml::node* node = fit.get(key);
    if (node == nullptr) return out;
    const toml::array* list = node->as_array();
    if (list == nullptr || !list->is_homogeneous(toml::node_type::string)) {
      Complain(node->source(), fmt::format("'{}' must be a list of patterns", key));
      return out;
    }
    for (const toml::node& pattern : *list) out.push_back(pattern.ref<std::string>());
    return out;
  }

  void ReadFit(const toml::node& node, Campaign* campaign) {
    const toml::table* fit = node.as_table();
    if (fit == nullptr) {
      Complain(node.source(), "[fit] must be a table");
      return;
    }
    KnowOnly(*fit, {"free", "lock", "group", "prior"});
    campaign->free = Patterns(*fit, "free");
    campaign->lock = Patterns(*fit, "lock");
    campaign->groups = Patterns(*fit, "group");
    const toml::node* prior = fit->get("prior");
    if (prior == nullptr) return;
    const toml::table* table = prior->as_table();
    if (table == nullptr) {
      Complain(prior->source(), "'prior' must be a table of deviations by pattern");
      return;
    }
    for (const auto& [pattern, value] : *table) {
      const std::optional<double> number = value.value<double>();
      if (!number) {
        Complain(value.source(), fmt::format("the prior of '{}' must be a number", pattern.str()));
        continue;
      }
      campaign->prior.push_back(fmt::format("{}={}", pattern.str(), *number));
    }
  }

  std::string_view text_;
  const std::string& file_;
  std::filesystem::path folder_;
  Diagnostics complaints_;
};

}  // namespace

bool IsCampaign(std::string_view text) {
  try {
    return toml::parse(text).contains("measurements");
  } catch (const toml::parse_error&) {
    return false;  // the layout's reader says what is wrong with it
  }
}

Parsed<Campaign> ReadCampaign(std::string_view text, const std::string& file) {
  return CampaignReader(text, file).Read();
}

}  // namespace kompono::cli
