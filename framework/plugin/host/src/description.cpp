// SPDX-License-Identifier: Apache-2.0
#include "kompono/plugin/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace kompono::plugin {

int ParameterDescription::Numbers() const {
  const bool points = shape == ParameterShape::kPoint || shape == ParameterShape::kPoints;
  return points ? 3 * count : count;
}

double ParameterDescription::ToInternal() const {
  return angle() ? std::numbers::pi / 180.0 : 1.0;
}

std::vector<std::string> ParameterDescription::NumberNames() const {
  std::vector<std::string> names;
  switch (shape) {
    case ParameterShape::kNumber:
      names.push_back(name);
      break;
    case ParameterShape::kNumbers:
      for (int i = 1; i <= count; ++i) names.push_back(fmt::format("{}[{}]", name, i));
      break;
    case ParameterShape::kPoint:
      for (const char axis : {'x', 'y', 'z'}) names.push_back(fmt::format("{}.{}", name, axis));
      break;
    case ParameterShape::kPoints:
      for (int i = 1; i <= count; ++i) {
        for (const char axis : {'x', 'y', 'z'})
          names.push_back(fmt::format("{}[{}].{}", name, i, axis));
      }
      break;
  }
  return names;
}

int ModuleDescription::ParameterNumbers() const {
  int numbers = 0;
  for (const ParameterDescription& parameter : parameters) numbers += parameter.Numbers();
  return numbers;
}

const ParameterDescription* ModuleDescription::FindParameter(std::string_view wanted) const {
  const auto found = std::find_if(
      parameters.begin(), parameters.end(), [wanted](const ParameterDescription& parameter) {
        return parameter.name == wanted;
      });
  return found == parameters.end() ? nullptr : &*found;
}

}  // namespace kompono::plugin
