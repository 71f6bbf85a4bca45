// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_CODES_HPP_
#define KOMPONO_CALIBRATION_CODES_HPP_

/// What can be said about measurements and an identification: E04xx are errors, W04xx warnings,
/// N04xx notes. A code keeps its meaning between versions. docs/calibration.md explains them.
namespace kompono::calibration {

struct CodeTitle {
  const char* code;
  const char* title;
};

namespace codes {
inline constexpr CodeTitle kCannotRead{"E0401", "file that cannot be read"};
inline constexpr CodeTitle kNoRows{"E0402", "file without rows"};
inline constexpr CodeTitle kUnknownColumn{"E0403", "unknown column"};
inline constexpr CodeTitle kMissingColumn{"E0404", "missing column"};
inline constexpr CodeTitle kRepeatedColumn{"E0405", "quantity with two columns"};
inline constexpr CodeTitle kUnit{"E0406", "unit missing or not of this quantity"};
inline constexpr CodeTitle kRagged{"E0407", "row of another length than the header"};
inline constexpr CodeTitle kNotANumber{"E0408", "text in place of a number"};
inline constexpr CodeTitle kNotFinite{"E0409", "number that is not finite"};
inline constexpr CodeTitle kUnknownKind{"E0410", "unknown kind of measurement"};
inline constexpr CodeTitle kMissingValue{"E0411", "value that the kind of measurement needs"};
inline constexpr CodeTitle kOutOfRange{"E0412", "number out of range"};
inline constexpr CodeTitle kNotYesOrNo{"E0413", "neither yes nor no"};
inline constexpr CodeTitle kRepeatedRow{"W0414", "row that is there twice"};
inline constexpr CodeTitle kWrongScale{"E0415",
                                       "numbers that look as if they were in another unit"};
inline constexpr CodeTitle kUnclearKind{"E0416", "row of an unclear kind"};
inline constexpr CodeTitle kIgnoredColumns{"N0417", "columns that are not used"};
inline constexpr CodeTitle kKlipperRun{"N0418", "delta run of Klipper"};
inline constexpr CodeTitle kTwoPlaces{"E0419", "fixture that is said to be in two places"};
inline constexpr CodeTitle kNoFixture{"E0420", "row without the fixture that its kind needs"};
inline constexpr CodeTitle kNotJson{"E0421", "not a JSON object"};
inline constexpr CodeTitle kRunMember{"E0422", "missing or wrong member of a run"};
inline constexpr CodeTitle kSwapped{"E0423", "columns that look swapped"};
inline constexpr CodeTitle kNegated{"E0426", "column that looks negated"};
inline constexpr CodeTitle kOtherFrame{"W0474", "tracker points in another frame"};
inline constexpr CodeTitle kSlip{"E0473", "row with a slip"};
inline constexpr CodeTitle kFarRow{"W0427", "row far from what the nominal machine predicts"};
inline constexpr CodeTitle kSameReadings{"W0428", "same readings, other measurement"};
inline constexpr CodeTitle kNotThreeTowers{"E0424", "machine without three drives for a delta run"};
inline constexpr CodeTitle kNotADelta{"E0425", "machine that is no linear delta"};
inline constexpr CodeTitle kUnknownParameter{"E0431", "pattern that names no parameter"};
inline constexpr CodeTitle kNothingFree{"E0432", "nothing to identify"};
inline constexpr CodeTitle kBadPrior{"E0433", "prior or bound that makes no sense"};
inline constexpr CodeTitle kBadStart{"E0434", "start of the wrong size"};
inline constexpr CodeTitle kNothingFitted{"E0435", "no row left for the fit"};
inline constexpr CodeTitle kNoRange{"E0441", "coordinate without a range to draw from"};
inline constexpr CodeTitle kFewPoses{"E0442", "too few poses inside the ranges"};
inline constexpr CodeTitle kOtherDrives{"E0443", "true machine with other drives"};
inline constexpr CodeTitle kBadSimulation{"E0444", "simulation option that makes no sense"};
inline constexpr CodeTitle kNoStiffness{"E0445", "dynamic error without stiffness"};
inline constexpr CodeTitle kKlipperConfig{"E0465", "no printer.cfg of a delta"};
inline constexpr CodeTitle kTrackerLine{"E0466", "line that is no point of a tracker"};
inline constexpr CodeTitle kTrackerMismatch{"E0467", "points that do not go with the readings"};
inline constexpr CodeTitle kNoPose{"E0451", "row at whose readings the machine has no pose"};
inline constexpr CodeTitle kTooFew{"E0452", "fewer measured numbers than unknowns"};
inline constexpr CodeTitle kExactFit{"W0452", "as many measured numbers as unknowns"};
inline constexpr CodeTitle kNotDetermined{"W0453",
                                          "combination of parameters that is not determined"};
inline constexpr CodeTitle kContradiction{"W0454", "errors larger than the given deviations allow"};
inline constexpr CodeTitle kOutlier{"W0455", "row that stands out"};
inline constexpr CodeTitle kFarFromNominal{"W0456", "parameter far from its nominal value"};
inline constexpr CodeTitle kAtBound{"W0457", "parameter at its bound"};
inline constexpr CodeTitle kNotConverged{"E0458", "identification that did not converge"};
inline constexpr CodeTitle kRejected{"W0460", "row left out of the fit"};
inline constexpr CodeTitle kTooManyOutliers{"W0461", "too many rows that stand out"};
inline constexpr CodeTitle kBadCampaign{"E0468", "wrong description of measurements"};
inline constexpr CodeTitle kArmsOnHeights{"W0462", "arms fitted to heights alone"};
inline constexpr CodeTitle kMapRows{"E0470", "too few rows for a residual map"};
inline constexpr CodeTitle kBadMap{"E0471", "wrong residual map"};
inline constexpr CodeTitle kMapRefused{"W0472", "residual map that does not help"};
inline constexpr CodeTitle kBeyondMap{"W0476", "program that leaves the residual map"};
inline constexpr CodeTitle kNoText{"E0477", "file that is no text of lines"};
inline constexpr CodeTitle kBadApproach{"E0475", "direction of approach that cannot be used"};
inline constexpr CodeTitle kHeldOutWorse{"W0459", "held-out rows that became worse"};
}  // namespace codes

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_CODES_HPP_
