// SPDX-License-Identifier: Apache-2.0
#include "keys.hpp"

#include <algorithm>
#include <array>

namespace kompono::layout {
namespace {

constexpr std::array<std::string_view, 4> kLengthUnits{"mm", "m", "um", "in"};
constexpr std::array<std::string_view, 2> kAngleUnits{"deg", "rad"};
constexpr std::array<std::string_view, 2> kRotations{"xyz", "zyx"};

constexpr std::array kUnitsKeys{
    KeyRule{.key = "length",
            .kind = ValueKind::kWord,
            .meaning = "unit of every length in this file; mm if not given",
            .words = kLengthUnits},
    KeyRule{.key = "angle",
            .kind = ValueKind::kWord,
            .meaning = "unit of every angle in this file; deg if not given",
            .words = kAngleUnits},
};
constexpr TableRule kUnits{.title = "units", .keys = kUnitsKeys};

constexpr std::array kPoseKeys{
    KeyRule{.key = "rotation",
            .kind = ValueKind::kWord,
            .meaning = "how A B C of a pose are meant: xyz is Rx(A) Ry(B) Rz(C), zyx is Rz(C) "
                       "Ry(B) Rx(A) as in "
                       "LinuxCNC",
            .words = kRotations},
};
constexpr TableRule kPose{.title = "pose", .keys = kPoseKeys};

constexpr KeyRule kPosition{.key = "position",
                            .kind = ValueKind::kTriple,
                            .meaning = "origin of the frame in its carrier, x y z",
                            .quantity = Quantity::kLength};
constexpr KeyRule kRotation{
    .key = "rotation",
    .kind = ValueKind::kTriple,
    .meaning = "angles a b c of the frame in its carrier, Rx(a) Ry(b) Rz(c)",
    .quantity = Quantity::kAngle};

constexpr std::array kPlacementKeys{kPosition, kRotation};
constexpr TableRule kMount{.title = "mount", .keys = kPlacementKeys};
constexpr TableRule kOpenBase{.title = "[open_base]", .keys = kPlacementKeys};

constexpr KeyRule kRange{.key = "range",
                         .kind = ValueKind::kInterval,
                         .meaning = "lowest and highest reading of the drive",
                         .quantity = Quantity::kByLetter};
constexpr KeyRule kSpeed{.key = "speed",
                         .kind = ValueKind::kNumber,
                         .meaning = "highest speed of the drive",
                         .quantity = Quantity::kSpeed,
                         .positive = true};
constexpr KeyRule kAcceleration{.key = "acceleration",
                                .kind = ValueKind::kNumber,
                                .meaning = "highest acceleration of the drive",
                                .quantity = Quantity::kAcceleration,
                                .positive = true};
constexpr KeyRule kStiffness{.key = "stiffness",
                             .kind = ValueKind::kNumber,
                             .meaning = "stiffness of the drive",
                             .quantity = Quantity::kStiffness,
                             .positive = true};
constexpr KeyRule kZero{.key = "zero",
                        .kind = ValueKind::kNumber,
                        .meaning = "drive coordinate where the control reads 0; 0 if not given",
                        .quantity = Quantity::kByLetter};
constexpr KeyRule kDirection{
    .key = "direction",
    .kind = ValueKind::kSign,
    .meaning = "'-' if the reading counts against the drive coordinate; '+' if not given"};

constexpr std::array kDriveKeys{kRange, kSpeed, kAcceleration, kStiffness, kZero, kDirection};
constexpr TableRule kDrive{.title = "[block.<name>.drive.<drive>]", .keys = kDriveKeys};

constexpr KeyRule kModule{.key = "module",
                          .kind = ValueKind::kText,
                          .meaning = "id of the module (kompono plugins lists them)"};
constexpr KeyRule kParameters{.key = "parameters",
                              .kind = ValueKind::kParameters,
                              .meaning = "the module's geometry, by the names of its description"};
constexpr KeyRule kMountKey{.key = "mount",
                            .kind = ValueKind::kTable,
                            .meaning = "base frame of the module in its carrier",
                            .table = &kMount};

constexpr KeyRule Required(KeyRule rule) {
  rule.required = true;
  return rule;
}

constexpr std::array kBlockKeys{
    Required(kModule),
    kParameters,
    KeyRule{
        .key = "mode",
        .kind = ValueKind::kSignsByName,
        .meaning = "assembly modes, '+' or '-'; those of the module's description if not given"},
    kMountKey,
    KeyRule{.key = "home",
            .kind = ValueKind::kNumbersByName,
            .meaning = "a regular place of the mechanism, by the letters of the formula; the "
                       "module's own if not given",
            .quantity = Quantity::kByLetter},
    KeyRule{.key = "range",
            .kind = ValueKind::kIntervalsByName,
            .meaning = "limits of the mechanism's coordinates, by the letters of the formula",
            .quantity = Quantity::kByLetter},
    KeyRule{.key = "swing",
            .kind = ValueKind::kNumbersByName,
            .meaning = "how far struts may swing in their joints from where they point at home, by "
                       "the points of the module's description; * stands for any characters",
            .quantity = Quantity::kAngle,
            .positive = true},
    KeyRule{.key = "strut_diameter",
            .kind = ValueKind::kNumber,
            .meaning = "diameter of the struts, for the clearance between them",
            .quantity = Quantity::kLength,
            .positive = true},
    KeyRule{.key = "clearance",
            .kind = ValueKind::kNumber,
            .meaning = "what struts that share no joint must keep between their surfaces; 0 if "
                       "only their diameter is given",
            .quantity = Quantity::kLength,
            .positive = true},
    KeyRule{.key = "drive",
            .kind = ValueKind::kTablesByName,
            .meaning = "what is known of each drive, by the names of the module's description",
            .table = &kDrive},
};
constexpr TableRule kBlock{.title = "[block.<name>]", .keys = kBlockKeys};

constexpr std::array kAxisKeys{
    kRange,
    KeyRule{
        .key = "home",
        .kind = ValueKind::kNumber,
        .meaning = "a regular value of the axis; if not given, the value of its range nearest to 0",
        .quantity = Quantity::kByLetter},
    KeyRule{.key = "position",
            .kind = ValueKind::kTriple,
            .meaning = "a point on the axis in its carrier, x y z",
            .quantity = Quantity::kLength},
    KeyRule{.key = "rotation",
            .kind = ValueKind::kTriple,
            .meaning = "tilt a b c of the axis in its carrier, Rx(a) Ry(b) Rz(c)",
            .quantity = Quantity::kAngle},
    kSpeed,
    kAcceleration,
    kStiffness,
    kZero,
    kDirection,
    KeyRule{.key = "positioning",
            .kind = ValueKind::kFlag,
            .meaning = "true: a main-motion spindle that is also positioned (a C axis)"},
};
constexpr TableRule kAxis{.title = "[axis.<name>]", .keys = kAxisKeys};

constexpr std::array kEndKeys{
    kModule,
    kParameters,
    kMountKey,
    KeyRule{.key = "station",
            .kind = ValueKind::kText,
            .meaning = "which station of the unit is used; the first if not given"},
    KeyRule{
        .key = "state",
        .kind = ValueKind::kIndex,
        .meaning = "discrete position of the unit, such as the index of a turret; 0 if not given"},
};
constexpr TableRule kEnd{.title = "[part], [tool], [process]", .keys = kEndKeys};

constexpr std::array kCalibrationKeys{
    KeyRule{.key = "free",
            .kind = ValueKind::kTexts,
            .meaning = "patterns of the numbers to identify; all identifiable ones if not given"},
    KeyRule{.key = "lock",
            .kind = ValueKind::kTexts,
            .meaning = "patterns of numbers that stay as they are, taken out of 'free'"},
    KeyRule{.key = "prior",
            .kind = ValueKind::kNumbersByName,
            .meaning = "pattern = standard deviation of what is known beforehand",
            .quantity = Quantity::kByLetter,
            .positive = true},
    KeyRule{.key = "bounds",
            .kind = ValueKind::kIntervalsByName,
            .meaning = "pattern = [lower, upper]",
            .quantity = Quantity::kByLetter},
};
constexpr TableRule kCalibration{.title = "[calibration]", .keys = kCalibrationKeys};

constexpr std::array kCalibratedKeys{
    KeyRule{
        .key = "source", .kind = ValueKind::kText, .meaning = "measurements the numbers come from"},
    KeyRule{.key = "nominal",
            .kind = ValueKind::kNumbersByName,
            .meaning = "the numbers before the calibration",
            .quantity = Quantity::kByLetter},
    KeyRule{.key = "sigma",
            .kind = ValueKind::kNumbersByName,
            .meaning = "standard deviations of the identified numbers",
            .quantity = Quantity::kByLetter},
};
constexpr TableRule kCalibrated{.title = "[calibrated]", .keys = kCalibratedKeys, .open = true};

constexpr KeyRule EndTable(std::string_view key, std::string_view meaning, bool numbered) {
  return {.key = key,
          .kind = ValueKind::kTable,
          .meaning = meaning,
          .table = &kEnd,
          .numbered = numbered};
}

constexpr std::array kFileKeys{
    KeyRule{.key = "kompono",
            .kind = ValueKind::kVersion,
            .meaning = "version of the format, 1",
            .required = true},
    KeyRule{.key = "name",
            .kind = ValueKind::kText,
            .meaning = "name of the machine; the file's name if not given"},
    KeyRule{.key = "description", .kind = ValueKind::kText, .meaning = "anything worth knowing"},
    KeyRule{.key = "formula",
            .kind = ValueKind::kText,
            .meaning = "structural formula (docs/formula.md)",
            .required = true},
    KeyRule{.key = "units",
            .kind = ValueKind::kTable,
            .meaning = "units of the numbers of this file",
            .table = &kUnits},
    KeyRule{.key = "pose",
            .kind = ValueKind::kTable,
            .meaning = "how poses of this machine are written",
            .table = &kPose},
    KeyRule{.key = "block",
            .kind = ValueKind::kTablesByName,
            .meaning = "what ':name' in the formula means",
            .table = &kBlock},
    KeyRule{.key = "axis",
            .kind = ValueKind::kTablesByName,
            .meaning = "what is known of a plain axis, by its name in the formula",
            .table = &kAxis},
    KeyRule{.key = "open_base",
            .kind = ValueKind::kTable,
            .meaning = "pose of the tool-side foundation in the workpiece-side one; only with O|O",
            .table = &kOpenBase},
    EndTable("part", "unit that holds the workpiece", true),
    EndTable("tool", "unit that holds the tool, or makes the process", true),
    EndTable("process", "unit that makes the process, as [tool]", false),
    EndTable("P_x", "unit of the process P_x", false),
    EndTable("P_y", "unit of the process P_y", false),
    EndTable("P_z", "unit of the process P_z", false),
    KeyRule{.key = "calibration",
            .kind = ValueKind::kTable,
            .meaning = "what 'kompono calibrate' may change",
            .table = &kCalibration},
    KeyRule{.key = "calibrated",
            .kind = ValueKind::kTable,
            .meaning = "where the numbers of a calibrated layout come from; further keys are kept "
                       "and not judged",
            .table = &kCalibrated},
};
constexpr TableRule kFile{.title = "layout file", .keys = kFileKeys};

bool IsDigits(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

const KeyRule* TableRule::Find(std::string_view key) const {
  for (const KeyRule& rule : keys) {
    if (rule.key == key) return &rule;
    if (rule.numbered && key.substr(0, rule.key.size()) == rule.key &&
        IsDigits(key.substr(rule.key.size())))
      return &rule;
  }
  return nullptr;
}

std::vector<std::string> TableRule::KeyNames() const {
  std::vector<std::string> names;
  names.reserve(keys.size());
  for (const KeyRule& rule : keys) names.emplace_back(rule.key);
  return names;
}

const TableRule& FileRule() {
  return kFile;
}

}  // namespace kompono::layout
