// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/klipper_config.hpp"

#include "table.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "kompono/calibration/codes.hpp"

namespace kompono::calibration {
namespace {

constexpr std::array<char, 3> kTowers{'a', 'b', 'c'};
constexpr std::array<double, 3> kUsualAngles{210.0, 330.0, 90.0};
constexpr std::string_view kSaved = "#*#";
constexpr int kMostProbings = 1000;

struct Entry {
  std::string value;
  int line = 0;
};
using Section = std::map<std::string, Entry, std::less<>>;

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) {
    text.remove_suffix(1);
  }
  return text;
}

/// Sections of the file; a comment begins with # or ;.
std::map<std::string, Section, std::less<>> Sections(std::string_view text) {
  std::map<std::string, Section, std::less<>> sections;
  Section* section = nullptr;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    if (line.starts_with(kSaved)) line.remove_prefix(kSaved.size());
    line = Trimmed(line.substr(0, line.find_first_of("#;")));
    if (line.empty()) continue;
    if (line.front() == '[') {
      section = &sections[std::string(Trimmed(line.substr(1, line.find(']') - 1)))];
      continue;
    }
    const std::size_t mark = line.find_first_of(":=");
    if (section == nullptr || mark == std::string_view::npos) continue;
    (*section)[std::string(Trimmed(line.substr(0, mark)))] = {
        .value = std::string(Trimmed(line.substr(mark + 1))), .line = number};
  }
  return sections;
}

class ConfigReader {
 public:
  ConfigReader(std::string_view text, std::string_view file)
      : text_(text), file_(file), sections_(Sections(text)) {}

  Parsed<KlipperConfig> Read() {
    KlipperConfig config;
    const Entry* kinematics = Find("printer", "kinematics");
    if (kinematics == nullptr || kinematics->value != "delta") {
      Complain(kinematics,
               kinematics == nullptr
                   ? "the file has no [printer] with kinematics"
                   : fmt::format("a printer of kinematics '{}' is no delta", kinematics->value),
               "give the printer.cfg of a linear delta");
      return tl::unexpected(std::move(complaints_));
    }
    ReadGeometry(&config.geometry);
    ReadProbings(&config);
    if (!complaints_.empty()) return tl::unexpected(std::move(complaints_));
    return config;
  }

 private:
  [[nodiscard]] const Entry* Find(std::string_view section, std::string_view key) const {
    const auto found = sections_.find(section);
    if (found == sections_.end()) return nullptr;
    const auto entry = found->second.find(key);
    return entry == found->second.end() ? nullptr : &entry->second;
  }

  void Complain(const Entry* entry, std::string message, std::string help = "") {
    Diagnostic complaint{.code = codes::kKlipperConfig.code,
                         .file = std::string(file_),
                         .message = std::move(message),
                         .help = std::move(help)};
    if (entry != nullptr) {
      complaint.span = SpanAt(text_, entry->line, 1, 1);
      complaint.span.length = std::max<int>(1, static_cast<int>(complaint.span.line_text.size()));
    }
    complaints_.push_back(std::move(complaint));
  }

  static std::optional<double> NumberIn(std::string_view text) {
    text = Trimmed(text);
    if (text.starts_with('+')) text.remove_prefix(1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) {
      return std::nullopt;
    }
    return number;
  }

  /// The numbers of a list; complains unless there are `count`.
  std::vector<double> Numbers(const Entry& entry, std::size_t count, char separator = ',') {
    std::vector<double> out;
    for (std::size_t begin = 0; begin <= entry.value.size();) {
      const std::size_t end = std::min(entry.value.find(separator, begin), entry.value.size());
      const auto number = NumberIn(std::string_view(entry.value).substr(begin, end - begin));
      begin = end + 1;
      if (number) out.push_back(*number);
      if (number && out.size() <= count) continue;
      out.clear();
      break;
    }
    if (out.size() == count) return out;
    Complain(&entry,
             count == 1 ? fmt::format("'{}' is no number", entry.value)
                        : fmt::format("'{}' is not {} numbers", entry.value, count));
    return std::vector<double>(count, 1.0);
  }

  /// A number of the section, or of `other` (Klipper's tower a stands for b and c), or `usual`.
  double Number(std::string_view section,
                std::string_view key,
                std::optional<double> usual = std::nullopt,
                std::string_view other = "") {
    const Entry* entry = Find(section, key);
    if (entry == nullptr && !other.empty()) entry = Find(other, key);
    if (entry != nullptr) return Numbers(*entry, 1).front();
    if (!usual) Complain(nullptr, fmt::format("[{}] has no '{}'", section, key));
    return usual.value_or(1.0);
  }

  void ReadGeometry(KlipperGeometry* geometry) {
    geometry->delta_radius = Number("printer", "delta_radius");
    for (std::size_t i = 0; i < kTowers.size(); ++i) {
      const std::string stepper = fmt::format("stepper_{}", kTowers[i]);
      geometry->angle_deg[i] = Number(stepper, "angle", kUsualAngles[i]);
      geometry->arm[i] = Number(stepper, "arm_length", std::nullopt, "stepper_a");
      geometry->endstop[i] = Number(stepper, "position_endstop", std::nullopt, "stepper_a");
      step_mm_[i] = StepOf(stepper);
      if (complaints_.empty() && geometry->arm[i] <= std::abs(geometry->delta_radius)) {
        Complain(Find(stepper, "arm_length"),
                 "the arm is not longer than the radius, so that the platform hangs nowhere");
      }
    }
  }

  /// mm per microstep.
  double StepOf(const std::string& stepper) {
    if (Find(stepper, "step_distance") != nullptr) return Number(stepper, "step_distance");
    const double turn = Number(stepper, "rotation_distance", std::nullopt, "stepper_a");
    const double steps = Number(stepper, "full_steps_per_rotation", 200.0);
    const double micro = Number(stepper, "microsteps", std::nullopt, "stepper_a");
    double gears = 1.0;
    if (const Entry* entry = Find(stepper, "gear_ratio")) {
      for (std::size_t begin = 0; begin <= entry->value.size();) {
        const std::size_t end = std::min(entry->value.find(',', begin), entry->value.size());
        const std::vector<double> pair = Numbers(
            {.value = entry->value.substr(begin, end - begin), .line = entry->line}, 2, ':');
        gears *= pair[0] / pair[1];
        begin = end + 1;
      }
    }
    const double step = turn / (steps * micro * gears);
    if (!(step > 0.0) || !std::isfinite(step)) {
      Complain(Find(stepper, "rotation_distance"),
               fmt::format("the step of {} would be {:g} mm", stepper, step));
    }
    return step;
  }

  std::string Travels(const Entry& entry) {
    std::string out;
    const std::vector<double> steps = Numbers(entry, 3);
    for (std::size_t i = 0; i < 3; ++i) out += fmt::format(",{}", steps[i] * step_mm_[i]);
    return out;
  }

  /// Every number of a kind with its positions; complains of a number without them.
  int ReadKind(const std::string& name,
               std::string_view kind,
               const std::vector<std::string>& positions,
               std::string* csv) {
    int count = 0;
    while (count < kMostProbings) {
      const std::string key = fmt::format("{}{}", name, count);
      const Entry* value = Find("delta_calibrate", key);
      if (value == nullptr) break;
      ++count;
      std::string line = fmt::format("{},{}", kind, Numbers(*value, 1).front());
      for (const std::string& position : positions) {
        const Entry* at = Find("delta_calibrate", key + position);
        if (at == nullptr) {
          Complain(value, fmt::format("{} has no '{}{}'", key, key, position));
          break;
        }
        line += Travels(*at);
      }
      *csv += line + (positions.size() == 1 ? ",,,\n" : "\n");
    }
    return count;
  }

  void ReadProbings(KlipperConfig* config) {
    std::string csv;
    config->heights = ReadKind("height", "height", {"_pos"}, &csv);
    config->heights += ReadKind("manual_height", "height", {"_pos"}, &csv);
    config->distances = ReadKind("distance", "distance", {"_pos1", "_pos2"}, &csv);
    if (csv.empty()) return;
    config->run_csv = "kind,value_mm,s1_a_mm,s1_b_mm,s1_c_mm,s2_a_mm,s2_b_mm,s2_c_mm\n" + csv;
  }

  std::string_view text_;
  std::string_view file_;
  std::map<std::string, Section, std::less<>> sections_;
  std::array<double, 3> step_mm_{1.0, 1.0, 1.0};
  Diagnostics complaints_;
};

}  // namespace

Parsed<KlipperConfig> ReadKlipperConfig(std::string_view text, std::string_view file) {
  if (Diagnostics refused = JudgeText(text, file); !refused.empty()) {
    return tl::unexpected(std::move(refused));
  }
  return ConfigReader(text, file).Read();
}

}  // namespace kompono::calibration
