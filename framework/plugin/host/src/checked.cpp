// SPDX-License-Identifier: Apache-2.0
#include "kompono/plugin/checked.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <string>

namespace kompono::plugin {
namespace {

constexpr std::string_view kCode = "E0211";

std::string_view Explain(Status status) {
  switch (status) {
    case Status::kOk:
      return "nothing is wrong";
    case Status::kUnsupported:
      return "it does not offer this quantity";
    case Status::kBadSize:
      return "it was called with spans of wrong lengths";
    case Status::kException:
      return "its code threw an exception";
  }
  return "it returned a status the contract does not know";
}

/// Number of the first bad value from 1, or 0.
std::size_t FirstBad(std::span<const double> values, bool nan_is_an_answer) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isinf(values[i]) || (std::isnan(values[i]) && !nan_is_an_answer)) return i + 1;
  }
  return 0;
}

}  // namespace

std::string_view QuantityName(Quantity quantity) {
  switch (quantity) {
    case Quantity::kPlatform:
      return "platform";
    case Quantity::kDrives:
      return "drives";
    case Quantity::kReach:
      return "reach";
    case Quantity::kClosure:
      return "closure";
    case Quantity::kSkeleton:
      return "skeleton";
    case Quantity::kCoordinates:
      return "coordinates";
    case Quantity::kHome:
      return "home";
  }
  return "unknown quantity";
}

std::optional<Diagnostic> EvaluateChecked(const Mechanism& mechanism,
                                          std::string_view module_id,
                                          Quantity quantity,
                                          const MechanismState& state,
                                          const MechanismValues& values) {
  const std::string_view name = QuantityName(quantity);
  const Status status = mechanism.Evaluate(quantity, state, values);
  if (status != Status::kOk) {
    return Diagnostic{
        .code = std::string(kCode),
        .message =
            fmt::format("module '{}' failed to give its {}: {}", module_id, name, Explain(status)),
        .help = status == Status::kException ? "the fault lies in the plugin" : ""};
  }
  struct Part {
    std::string_view suffix;
    std::span<const double> numbers;
  };
  const Part parts[] = {{"", values.values},
                        {" derivatives by coordinates", values.by_coordinates},
                        {" derivatives by drives", values.by_drives},
                        {" derivatives by parameters", values.by_parameters}};
  for (const Part& part : parts) {
    const std::size_t bad = FirstBad(part.numbers, quantity == Quantity::kDrives);
    if (bad == 0) continue;
    return Diagnostic{
        .code = std::string(kCode),
        .message = fmt::format(
            "module '{}' gave something that is no finite number as value {} of {} of its {}{}",
            module_id,
            bad,
            part.numbers.size(),
            name,
            part.suffix),
        .help = "check the parameters; if they are sound, the fault lies in the plugin"};
  }
  return std::nullopt;
}

}  // namespace kompono::plugin
