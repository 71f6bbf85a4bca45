// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/positioning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kompono::calibration {
namespace {

constexpr std::size_t kApproaches = 5;
constexpr double kDegPerRad = 180.0 / std::numbers::pi;

using Approaches = std::vector<double> TargetDeviations::*;

struct MeanAndDeviation {
  double mean = 0.0, s = 0.0;
};

MeanAndDeviation Of(const std::vector<double>& deviations) {
  const auto n = static_cast<double>(deviations.size());
  MeanAndDeviation result;
  for (const double d : deviations) result.mean += d / n;
  double squares = 0.0;
  for (const double d : deviations) squares += (d - result.mean) * (d - result.mean);
  result.s = std::sqrt(squares / (n - 1.0));
  return result;
}

/// Largest less smallest of what it was given.
struct Spread {
  double least = 1e300, most = -1e300;
  void Take(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  [[nodiscard]] double width() const { return most - least; }
};

bool AllApproached(const std::vector<TargetDeviations>& targets, Approaches side) {
  return !targets.empty() && std::all_of(targets.begin(), targets.end(), [side](const auto& t) {
    return (t.*side).size() >= 2;
  });
}

UnidirectionalFigures FromOneSide(const std::vector<TargetDeviations>& targets, Approaches side) {
  Spread accuracy;
  Spread systematic;
  UnidirectionalFigures figures;
  for (const TargetDeviations& target : targets) {
    const MeanAndDeviation at = Of(target.*side);
    accuracy.Take(at.mean + 2.0 * at.s);
    accuracy.Take(at.mean - 2.0 * at.s);
    systematic.Take(at.mean);
    figures.repeatability = std::max(figures.repeatability, 4.0 * at.s);
  }
  figures.accuracy = accuracy.width();
  figures.systematic = systematic.width();
  return figures;
}

BidirectionalFigures FromBothSides(const std::vector<TargetDeviations>& targets) {
  Spread accuracy;
  Spread systematic;
  Spread means;
  BidirectionalFigures figures;
  for (const TargetDeviations& target : targets) {
    const MeanAndDeviation up = Of(target.positive);
    const MeanAndDeviation down = Of(target.negative);
    const double reversal = up.mean - down.mean;
    for (const MeanAndDeviation& side : {up, down}) {
      accuracy.Take(side.mean + 2.0 * side.s);
      accuracy.Take(side.mean - 2.0 * side.s);
      systematic.Take(side.mean);
    }
    means.Take(0.5 * (up.mean + down.mean));
    figures.repeatability = std::max({figures.repeatability,
                                      2.0 * up.s + 2.0 * down.s + std::abs(reversal),
                                      4.0 * up.s,
                                      4.0 * down.s});
    figures.reversal = std::max(figures.reversal, std::abs(reversal));
    figures.mean_reversal += reversal / static_cast<double>(targets.size());
  }
  figures.accuracy = accuracy.width();
  figures.systematic = systematic.width();
  figures.mean_deviation = means.width();
  return figures;
}

/// Targets that a measured travel asks for.
std::size_t TargetsAskedFor(double travel, bool rotary) {
  if (!rotary) {
    constexpr double kOneEvery = 200.0;  // mm
    return std::max<std::size_t>(5, static_cast<std::size_t>(std::floor(travel / kOneEvery)));
  }
  const double degrees = travel * kDegPerRad;
  return degrees <= 90.0 ? 3 : degrees <= 180.0 ? 5 : 8;
}

}  // namespace

PositioningFigures PositioningFiguresOf(const std::vector<TargetDeviations>& targets) {
  PositioningFigures figures;
  if (AllApproached(targets, &TargetDeviations::positive)) {
    figures.positive = FromOneSide(targets, &TargetDeviations::positive);
  }
  if (AllApproached(targets, &TargetDeviations::negative)) {
    figures.negative = FromOneSide(targets, &TargetDeviations::negative);
  }
  if (figures.positive && figures.negative) figures.bidirectional = FromBothSides(targets);
  return figures;
}

std::vector<std::string> MissingForPositioning(const std::vector<TargetDeviations>& targets,
                                               bool rotary) {
  if (targets.empty()) return {"no targets"};
  std::vector<std::string> missing;
  Spread travel;
  for (const TargetDeviations& target : targets) travel.Take(target.target);
  const std::size_t asked = TargetsAskedFor(travel.width(), rotary);
  if (targets.size() < asked) {
    missing.push_back(fmt::format(
        "{} target{}, {} asked for", targets.size(), targets.size() == 1 ? "" : "s", asked));
  }
  for (const auto& [side, sign] :
       {std::pair{&TargetDeviations::positive, '+'}, std::pair{&TargetDeviations::negative, '-'}}) {
    if (std::all_of(targets.begin(), targets.end(), [side = side](const auto& t) {
          return (t.*side).empty();
        })) {
      continue;
    }
    for (const TargetDeviations& target : targets) {
      const std::size_t count = (target.*side).size();
      if (count >= kApproaches) continue;
      missing.push_back(fmt::format("{} of {} approaches in {} at {:.6g} {}",
                                    count,
                                    kApproaches,
                                    sign,
                                    target.target * (rotary ? kDegPerRad : 1.0),
                                    rotary ? "deg" : "mm"));
    }
  }
  return missing;
}

}  // namespace kompono::calibration
