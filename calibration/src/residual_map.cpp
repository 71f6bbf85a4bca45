// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/residual_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <toml++/toml.h>

#include "kompono/calibration/codes.hpp"
#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::calibration {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kUmPerMm = 1000.0;

double ValueOf(const kinematics::Machine& machine,
               const MapAxis& axis,
               const Eigen::VectorXd& coordinates) {
  return coordinates[machine.FindCoordinate(axis.coordinate)];
}

/// The cell of an axis that holds a value, and where in it, 0 to 1.
std::pair<std::size_t, double> CellOf(const MapAxis& axis, double value) {
  const auto above = std::upper_bound(axis.values.begin() + 1, axis.values.end() - 1, value);
  const auto cell = static_cast<std::size_t>(above - axis.values.begin()) - 1;
  const double lower = axis.values[cell];
  return {cell, std::clamp((value - lower) / (axis.values[cell + 1] - lower), 0.0, 1.0)};
}

class MapReader {
 public:
  MapReader(std::string_view text, std::string_view file, const kinematics::Machine& machine)
      : text_(text), file_(file), machine_(machine) {
    for (const kinematics::Coordinate& c : machine.coordinates()) names_.push_back(c.name);
  }

  Parsed<ResidualMap> Read() {
    toml::table root;
    try {
      root = toml::parse(text_, file_);
    } catch (const toml::parse_error& error) {
      Complain(error.source(), std::string(error.description()));
      return tl::unexpected(std::move(complaints_));
    }
    for (const auto& [key, value] : root) {
      const std::string name(key.str());
      const std::vector<std::string> known{"residual_map", "source", "judged", "axis", "error_mm"};
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      Complain(key.source(), fmt::format("unknown key '{}'", name), DidYouMean(name, known));
    }
    const toml::node* version = root.get("residual_map");
    if (version == nullptr || version->value<std::int64_t>() != 1) {
      Complain(SourceOf(version, root),
               "'residual_map' must be 1, the version of this format",
               "such files are written by kompono calibrate --residual-map");
    }
    ResidualMap map;
    const toml::node* axes = root.get("axis");
    if (axes == nullptr || !axes->is_array() || axes->as_array()->empty()) {
      Complain(SourceOf(axes, root), "no [[axis]] with the values of a coordinate");
    } else {
      for (const toml::node& node : *axes->as_array()) map.axes.push_back(Axis(node));
    }
    ReadErrors(root, &map);
    if (!complaints_.empty()) return tl::unexpected(std::move(complaints_));
    return map;
  }

 private:
  static const toml::source_region& SourceOf(const toml::node* node, const toml::table& parent) {
    return node != nullptr ? node->source() : parent.source();
  }

  void Complain(const toml::source_region& where, std::string message, std::string help = "") {
    Diagnostic complaint{.code = codes::kBadMap.code,
                         .file = std::string(file_),
                         .message = std::move(message),
                         .help = std::move(help)};
    if (where.begin.line > 0) {
      complaint.span = SpanAt(
          text_, static_cast<int>(where.begin.line), static_cast<int>(where.begin.column), 1);
    }
    complaints_.push_back(std::move(complaint));
  }

  MapAxis Axis(const toml::node& node) {
    MapAxis axis;
    const toml::table* table = node.as_table();
    if (table == nullptr) {
      Complain(node.source(), "an [[axis]] must be a table");
      return axis;
    }
    const toml::node* name = table->get("coordinate");
    axis.coordinate = name != nullptr ? name->value_or(std::string()) : std::string();
    const int index = machine_.FindCoordinate(axis.coordinate);
    if (index < 0) {
      Complain(SourceOf(name, *table),
               fmt::format("the machine has no coordinate '{}'", axis.coordinate),
               DidYouMean(axis.coordinate, names_));
      return axis;
    }
    const bool rotary = machine_.coordinates()[static_cast<std::size_t>(index)].rotary;
    const char* key = rotary ? "values_deg" : "values_mm";
    const toml::node* values = table->get(key);
    if (values != nullptr && values->is_array()) {
      for (const toml::node& value : *values->as_array()) {
        axis.values.push_back(value.value<double>().value_or(std::nan("")) /
                              (rotary ? kDegPerRad : 1.0));
      }
    }
    const bool ascending =
        std::adjacent_find(axis.values.begin(), axis.values.end(), [](double a, double b) {
          return !(a < b);
        }) == axis.values.end();
    if (axis.values.size() < 2 || !ascending) {
      Complain(SourceOf(values, *table),
               fmt::format("'{}' must be at least two numbers in ascending order", key));
    }
    return axis;
  }

  void ReadErrors(const toml::table& root, ResidualMap* map) {
    const toml::node* errors = root.get("error_mm");
    std::size_t wanted = 1;
    for (const MapAxis& axis : map->axes) wanted *= axis.values.size();
    if (errors == nullptr || !errors->is_array()) {
      Complain(SourceOf(errors, root), "no 'error_mm' with the errors of the nodes");
      return;
    }
    for (const toml::node& node : *errors->as_array()) {
      const toml::array* numbers = node.as_array();
      Eigen::Vector3d error = Eigen::Vector3d::Constant(std::nan(""));
      if (numbers != nullptr && numbers->size() == 3) {
        for (std::size_t i = 0; i < 3; ++i) {
          error[static_cast<Eigen::Index>(i)] =
              (*numbers)[i].value<double>().value_or(std::nan(""));
        }
      }
      if (!error.allFinite()) Complain(node.source(), "a node's error must be three numbers, mm");
      map->error_mm.push_back(error);
    }
    if (complaints_.empty() && map->error_mm.size() != wanted) {
      Complain(errors->source(),
               fmt::format("{} errors for {} nodes", map->error_mm.size(), wanted),
               "one for every node, the last axis running fastest");
    }
  }

  std::string_view text_, file_;
  const kinematics::Machine& machine_;
  std::vector<std::string> names_;
  Diagnostics complaints_;
};

std::string GainText(const char* what, const MapGain& gain) {
  return fmt::format("  {:<34} {:>4} rows  {:.4g} µm without, {:.4g} µm with the map\n",
                     what,
                     gain.rows,
                     gain.without_mm * kUmPerMm,
                     gain.with_mm * kUmPerMm);
}

}  // namespace

Eigen::Vector3d ResidualMap::At(const kinematics::Machine& machine,
                                const Eigen::VectorXd& coordinates) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::vector<std::pair<std::size_t, double>> cells;
  for (const MapAxis& axis : axes) {
    cells.push_back(CellOf(axis, ValueOf(machine, axis, coordinates)));
  }
  for (std::size_t corner = 0; corner < (std::size_t{1} << axes.size()); ++corner) {
    double weight = 1.0;
    std::size_t node = 0;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const std::size_t upper = (corner >> a) & 1U;
      weight *= upper == 1 ? cells[a].second : 1.0 - cells[a].second;
      node = node * axes[a].values.size() + cells[a].first + upper;
    }
    if (weight > 0.0) sum += weight * error_mm[node];
  }
  return sum;
}

bool ResidualMap::Covers(const kinematics::Machine& machine,
                         const Eigen::VectorXd& coordinates) const {
  return std::all_of(axes.begin(), axes.end(), [&](const MapAxis& axis) {
    const double value = ValueOf(machine, axis, coordinates);
    return value >= axis.values.front() && value <= axis.values.back();
  });
}

std::string WriteResidualMap(const kinematics::Machine& machine,
                             const MappedResiduals& mapped,
                             std::string_view source) {
  const MapJudgement& judged = mapped.judged;
  std::string text =
      "# Where the tool point really is less where the identified geometry says, in the workpiece\n"
      "# datum, mm: nodes of a grid, the last axis running fastest, multilinear between them.\n"
      "residual_map = 1\n";
  text += fmt::format("source = \"{}\"\n\n[judged]\n", source);
  const auto gain = [&text](const char* name, const MapGain& g) {
    text += fmt::format("{} = {{ rows = {}, without_mm = {:.6f}, with_mm = {:.6f} }}\n",
                        name,
                        g.rows,
                        g.without_mm,
                        g.with_mm);
  };
  gain("fitted", judged.fitted);
  gain("validated", judged.validated);
  if (judged.held_out) gain("held_out", *judged.held_out);
  for (const MapAxis& axis : mapped.map.axes) {
    const auto index = static_cast<std::size_t>(machine.FindCoordinate(axis.coordinate));
    const bool rotary = machine.coordinates()[index].rotary;
    std::vector<std::string> values;
    for (const double value : axis.values) {
      values.push_back(fmt::format("{}", rotary ? value * kDegPerRad : value));
    }
    text += fmt::format("\n[[axis]]\ncoordinate = \"{}\"\n{} = [{}]\n",
                        axis.coordinate,
                        rotary ? "values_deg" : "values_mm",
                        fmt::join(values, ", "));
  }
  std::string nodes;
  for (const Eigen::Vector3d& e : mapped.map.error_mm) {
    nodes += fmt::format("  [{:.6f}, {:.6f}, {:.6f}],\n", e.x(), e.y(), e.z());
  }
  // The array belongs to the root and has to stand before the first table.
  text.insert(text.find("\n[judged]"), fmt::format("error_mm = [\n{}]\n", nodes));
  return text;
}

Parsed<ResidualMap> ParseResidualMap(std::string_view text,
                                     std::string_view file,
                                     const kinematics::Machine& machine) {
  return MapReader(text, file, machine).Read();
}

std::string RenderText(const MapJudgement& judged) {
  std::string text = fmt::format("\nmap of what the geometry leaves: {}\n", judged.verdict);
  text += GainText("fitted", judged.fitted);
  text += GainText("validated, each row not seen before", judged.validated);
  if (judged.held_out) text += GainText("held out", *judged.held_out);
  return text;
}

}  // namespace kompono::calibration
