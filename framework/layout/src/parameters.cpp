// SPDX-License-Identifier: Apache-2.0
// The `parameters` table of a block or end against its module's description.
#include "reader.hpp"
#include "shape.hpp"
#include <fmt/format.h>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::layout {
namespace {

using plugin::ParameterDescription;
using plugin::ParameterShape;

class ParameterReader {
 public:
  ParameterReader(const toml::table& owner,
                  const plugin::ModuleDescription& module,
                  const Units& units,
                  Complaints& complaints)
      : owner_(owner), module_(module), units_(units), complaints_(complaints) {}

  std::optional<std::vector<double>> Read() {
    const toml::table* given = TableAt(owner_, "parameters");
    if (given != nullptr) JudgeKeys(*given);
    std::vector<double> numbers;
    for (const ParameterDescription& parameter : module_.parameters) {
      const toml::node* node =
          given == nullptr || parameter.fixed ? nullptr : given->get(parameter.name);
      if (node == nullptr) {
        TakeDefault(parameter, given, numbers);
      } else {
        const std::size_t before = numbers.size();
        Take(parameter, *node, numbers);
        good_ = good_ && numbers.size() == before + static_cast<std::size_t>(parameter.Numbers());
      }
    }
    if (!good_) return std::nullopt;
    return numbers;
  }

 private:
  void JudgeKeys(const toml::table& given) {
    std::vector<std::string> names;
    for (const ParameterDescription& parameter : module_.parameters) {
      if (!parameter.fixed) names.push_back(parameter.name);
    }
    for (const auto& [key, node] : given) {
      const ParameterDescription* parameter = module_.FindParameter(key.str());
      if (parameter == nullptr) {
        complaints_.Error(codes::kUnknownParameter,
                          complaints_.Span(key.source()),
                          fmt::format("'{}' has no parameter '{}'", module_.id, key.str()),
                          DidYouMean(key.str(), names));
      } else if (parameter->fixed) {
        complaints_.Error(
            codes::kFixedParameter,
            complaints_.Span(key.source()),
            fmt::format("'{}' has fixed the parameter '{}'", module_.id, key.str()),
            fmt::format("leave it out, or use the module '{}', which lets it be chosen",
                        module_.implementation));
      }
    }
  }

  void TakeDefault(const ParameterDescription& parameter,
                   const toml::table* given,
                   std::vector<double>& numbers) {
    if (!parameter.default_value.empty()) {
      for (const double value : parameter.default_value)
        numbers.push_back(value * parameter.ToInternal());
      return;
    }
    good_ = false;
    const toml::node* place = given != nullptr ? given : owner_.get("module");
    complaints_.Error(
        codes::kMissingParameter,
        complaints_.Span(place != nullptr ? *place : owner_),
        fmt::format(
            "'{}' needs the parameter '{}': {}", module_.id, parameter.name, parameter.meaning),
        fmt::format("write {} = {}", parameter.name, Pattern(parameter)));
  }

  /// How a value is written, with its unit.
  [[nodiscard]] std::string Pattern(const ParameterDescription& parameter) const {
    const std::string unit = UnitName(parameter);
    const std::string in = unit.empty() ? "" : " (" + unit + ")";
    switch (parameter.shape) {
      case ParameterShape::kNumber:
        return "a number" + in;
      case ParameterShape::kNumbers:
        return fmt::format("{} numbers in brackets, or one for all{}", parameter.count, in);
      case ParameterShape::kPoint:
        return "[x, y, z]" + in;
      case ParameterShape::kPoints:
        break;
    }
    return fmt::format("[[x, y, z], …], {} points{}", parameter.count, in);
  }

  [[nodiscard]] std::string UnitName(const ParameterDescription& parameter) const {
    return parameter.unit == "1" ? "" : units_.NameOf(parameter.angle());
  }
  [[nodiscard]] double Factor(const ParameterDescription& parameter) const {
    return parameter.unit == "1" ? 1.0 : units_.Of(parameter.angle());
  }

  void Take(const ParameterDescription& parameter,
            const toml::node& node,
            std::vector<double>& numbers) {
    const auto count = static_cast<std::size_t>(parameter.count);
    switch (parameter.shape) {
      case ParameterShape::kNumber:
        return TakeNumber(parameter, node, numbers);
      case ParameterShape::kNumbers:
        if (node.is_number()) {
          const std::size_t before = numbers.size();
          TakeNumber(parameter, node, numbers);
          if (numbers.size() > before) numbers.insert(numbers.end(), count - 1, numbers.back());
          return;
        }
        return TakeList(parameter, node, count, "numbers", numbers);
      case ParameterShape::kPoint:
        return TakeList(parameter, node, 3, "numbers", numbers);
      case ParameterShape::kPoints:
        return TakePoints(parameter, node, numbers);
    }
  }

  void WrongType(const ParameterDescription& parameter, const toml::node& node) {
    complaints_.Error(codes::kWrongType,
                      complaints_.Span(node),
                      fmt::format("'{}' cannot be {}", parameter.name, TypeName(node)),
                      fmt::format("write {} = {}", parameter.name, Pattern(parameter)));
  }

  void TakeList(const ParameterDescription& parameter,
                const toml::node& node,
                std::size_t count,
                std::string_view what,
                std::vector<double>& numbers) {
    const toml::array* list = node.as_array();
    if (list == nullptr) return WrongType(parameter, node);
    WrongCount(parameter, *list, count, what);
    for (const toml::node& element : *list) TakeNumber(parameter, element, numbers);
  }

  void TakePoints(const ParameterDescription& parameter,
                  const toml::node& node,
                  std::vector<double>& numbers) {
    const toml::array* list = node.as_array();
    if (list == nullptr) return WrongType(parameter, node);
    WrongCount(parameter, *list, static_cast<std::size_t>(parameter.count), "points");
    for (const toml::node& element : *list) {
      if (!element.is_array()) {
        complaints_.Error(codes::kWrongType,
                          complaints_.Span(element),
                          fmt::format("each point of '{}' must be a list [x, y, z], not {}",
                                      parameter.name,
                                      TypeName(element)));
        return;
      }
      TakeList(parameter, element, 3, "numbers for each point", numbers);
    }
  }

  void WrongCount(const ParameterDescription& parameter,
                  const toml::array& list,
                  std::size_t count,
                  std::string_view what) {
    if (list.size() == count) return;
    good_ = false;
    complaints_.Error(
        codes::kWrongCount,
        complaints_.Span(list),
        fmt::format("'{}' needs {} {}, not {}", parameter.name, count, what, list.size()));
  }

  void TakeNumber(const ParameterDescription& parameter,
                  const toml::node& node,
                  std::vector<double>& numbers) {
    if (!node.is_number()) return WrongType(parameter, node);
    const auto value = JudgeNumber(node, "'" + parameter.name + "'", complaints_);
    if (!value) return;
    JudgeRange(parameter, node, *value);
    numbers.push_back(*value * Factor(parameter));
  }

  void JudgeRange(const ParameterDescription& parameter, const toml::node& node, double value) {
    const double to_file = parameter.ToInternal() / Factor(parameter);
    const std::string unit = UnitName(parameter).empty() ? "" : " " + UnitName(parameter);
    std::string limits;
    if (parameter.lower && parameter.upper) {
      limits = fmt::format("between {:.6g} and {:.6g}{}",
                           *parameter.lower * to_file,
                           *parameter.upper * to_file,
                           unit);
    } else if (parameter.lower) {
      limits = fmt::format("at least {:.6g}{}", *parameter.lower * to_file, unit);
    } else if (parameter.upper) {
      limits = fmt::format("at most {:.6g}{}", *parameter.upper * to_file, unit);
    }
    const bool low = parameter.lower && value < *parameter.lower * to_file;
    const bool high = parameter.upper && value > *parameter.upper * to_file;
    if (!low && !high) return;
    good_ = false;
    complaints_.Error(codes::kOutOfRange,
                      complaints_.Span(node),
                      fmt::format("'{}' must be {}, not {}", parameter.name, limits, value),
                      parameter.meaning);
  }

  const toml::table& owner_;
  const plugin::ModuleDescription& module_;
  const Units& units_;
  Complaints& complaints_;
  bool good_ = true;
};

}  // namespace

std::optional<std::vector<double>> ReadParameters(const toml::table& owner,
                                                  const plugin::ModuleDescription& module,
                                                  const Units& units,
                                                  Complaints& complaints) {
  return ParameterReader(owner, module, units, complaints).Read();
}

}  // namespace kompono::layout
