// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_POSITIONING_HPP_
#define KOMPONO_CALIBRATION_POSITIONING_HPP_

#include <optional>
#include <string>
#include <vector>

/// ISO 230-2: accuracy and repeatability of positioning of one axis, from targets approached again
/// and again from both sides. Symbols as in the standard; all figures in the deviations' unit.
namespace kompono::calibration {

/// Deviations, actual less commanded, at one target position.
struct TargetDeviations {
  double target = 0.0;
  std::vector<double> positive;  ///< approached in the axis' positive direction
  std::vector<double> negative;
};

/// Of one direction of approach.
struct UnidirectionalFigures {
  double accuracy = 0.0;       ///< A: spread of the mean deviations with two s on either side
  double systematic = 0.0;     ///< E: spread of the mean deviations
  double repeatability = 0.0;  ///< R: largest 4 s
};

struct BidirectionalFigures {
  double accuracy = 0.0;        ///< A
  double systematic = 0.0;      ///< E
  double repeatability = 0.0;   ///< R: largest of 2 s+ + 2 s- + |B_i|, 4 s+ and 4 s-
  double reversal = 0.0;        ///< B: largest |B_i|
  double mean_reversal = 0.0;   ///< mean of B_i = mean from + less mean from -
  double mean_deviation = 0.0;  ///< M: spread of the means of both directions
};

struct PositioningFigures {
  std::optional<UnidirectionalFigures> positive, negative;
  std::optional<BidirectionalFigures> bidirectional;  ///< if there are both
};

/// A direction has figures if every target was approached in it twice or more.
[[nodiscard]] PositioningFigures PositioningFiguresOf(const std::vector<TargetDeviations>& targets);

/// What the standard asks for and the targets do not give, in words; empty if it is all there. At
/// least five targets and five for every metre (of rotary axes 3 to 90 deg, 5 to 180 deg, 8
/// beyond), five approaches of each in every direction that is used at all. Targets in mm, of
/// rotary axes in rad.
[[nodiscard]] std::vector<std::string> MissingForPositioning(
    const std::vector<TargetDeviations>& targets, bool rotary);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_POSITIONING_HPP_
