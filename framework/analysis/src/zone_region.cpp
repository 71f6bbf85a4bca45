// SPDX-License-Identifier: Apache-2.0
// Which coordinates a zone is made of, and where to look for it.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numbers>

#include "kompono/analysis/work_zone.hpp"
#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::analysis {
namespace {

/// Farthest point of the machine at home from the middle of its points, or of its ranges; mm.
double SizeOf(const Machine& machine) {
  double size = 1.0;
  const auto skeleton = machine.Skeleton(machine.home(), machine.nominal());
  for (const auto& a : skeleton.points) {
    for (const auto& b : skeleton.points) size = std::max(size, (a.p_M - b.p_M).norm());
  }
  for (const kinematics::Drive& drive : machine.drives()) {
    if (!drive.rotary && drive.lower && drive.upper)
      size = std::max(size, *drive.upper - *drive.lower);
  }
  return size;
}

/// The translations: X Y Z before U V W, at most three.
std::vector<int> Translations(const Machine& machine) {
  std::vector<int> out;
  for (const std::string_view letters : {"XYZ", "UVW", "PQR"}) {
    for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
      const kinematics::Coordinate& c = machine.coordinates()[i];
      if (!c.rotary && letters.find(c.letter) != std::string_view::npos && out.size() < 3)
        out.push_back(static_cast<int>(i));
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

void Add(const Machine& machine,
         int index,
         std::optional<double> lower,
         std::optional<double> upper,
         Region& out) {
  const kinematics::Coordinate& c = machine.coordinates()[static_cast<std::size_t>(index)];
  const double far = c.rotary ? std::numbers::pi : 2.0 * SizeOf(machine);
  if (!lower) lower = c.lower;
  if (!upper) upper = c.upper;
  if (!lower) lower = std::min(c.home, upper.value_or(c.home)) - far;
  if (!upper) upper = std::max(c.home, *lower) + far;
  out.varied.push_back(index);
  out.lower.push_back(std::max(*lower, c.lower.value_or(*lower)));
  out.upper.push_back(std::min(*upper, c.upper.value_or(*upper)));
}

/// By full name, or by its last part where only one has it.
int Find(const Machine& machine, const std::string& name) {
  const auto same = [](std::string_view a, std::string_view b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) {
             return std::tolower(static_cast<unsigned char>(x)) ==
                    std::tolower(static_cast<unsigned char>(y));
           });
  };
  int found = -1;
  int count = 0;
  for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
    const std::string& full = machine.coordinates()[i].name;
    if (same(full, name)) return static_cast<int>(i);
    const std::size_t dot = full.rfind('.');
    if (dot == std::string::npos || !same(std::string_view(full).substr(dot + 1), name)) continue;
    found = static_cast<int>(i);
    ++count;
  }
  return count == 1 ? found : -1;
}

}  // namespace

Parsed<Region> RegionOf(const Machine& machine,
                        const std::vector<Span>& varied,
                        const VectorXd& held) {
  Region out{.z = held};
  Diagnostics problems;
  if (varied.empty()) {
    for (const int index : Translations(machine)) Add(machine, index, {}, {}, out);
  }
  for (const Span& span : varied) {
    const int index = Find(machine, span.coordinate);
    if (index >= 0) {
      Add(machine, index, span.lower, span.upper, out);
      continue;
    }
    std::vector<std::string> names;
    for (const kinematics::Coordinate& c : machine.coordinates()) names.push_back(c.name);
    problems.push_back({.code = "E0724",
                        .message = fmt::format("no coordinate is called '{}'", span.coordinate),
                        .help = DidYouMean(span.coordinate, names)});
  }
  for (std::size_t i = 0; i < out.dimension() && problems.empty(); ++i) {
    if (out.lower[i] < out.upper[i]) continue;
    const auto& c = machine.coordinates()[static_cast<std::size_t>(out.varied[i])];
    problems.push_back(
        {.code = "E0725",
         .message = fmt::format("nothing is left of {} to vary", c.name),
         .help = "give a lower end below the upper one, both within the layout's range"});
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return out;
}

}  // namespace kompono::analysis
