// SPDX-License-Identifier: Apache-2.0
#include "study_keys.hpp"

#include <algorithm>

namespace kompono::synthesis {
namespace {

constexpr std::array<std::string_view, 3> kEquivalences{
    "string", "distribution", "relative_motion"};
constexpr std::array<std::string_view, 2> kBases{"closed", "open"};
constexpr std::array<std::string_view, 2> kSideWords{"part", "tool"};
constexpr std::array<std::string_view, 3> kDirections{"x", "y", "z"};
constexpr std::array<std::string_view, 3> kKinds{"logical", "empirical", "normative"};
constexpr std::array<std::string_view, 2> kGoals{"min", "max"};

constexpr std::array kPartKeys{
    KeyRule{.key = "size", .kind = ValueKind::kTriple, .meaning = "of the part along x y z, mm"},
    KeyRule{.key = "mass", .kind = ValueKind::kNumber, .meaning = "of the part, kg"},
};
constexpr TableRule kPart{.title = "[part]", .keys = kPartKeys};

constexpr KeyRule kSpeed{.key = "speed",
                         .kind = ValueKind::kNumber,
                         .meaning = "highest speed of the drive, mm/min or deg/min",
                         .positive = true};
constexpr KeyRule kAcceleration{.key = "acceleration",
                                .kind = ValueKind::kNumber,
                                .meaning = "highest acceleration of the drive, mm/s² or deg/s²",
                                .positive = true};
constexpr KeyRule kStiffness{.key = "stiffness",
                             .kind = ValueKind::kNumber,
                             .meaning = "of the drive, N/µm, of rotary drives N·m/rad",
                             .positive = true};
constexpr KeyRule kSides{.key = "sides",
                         .kind = ValueKind::kWords,
                         .meaning = "which side of the base it may be on; both if not given",
                         .words = kSideWords};

constexpr std::array kMotionKeys{
    KeyRule{.key = "range",
            .kind = ValueKind::kInterval,
            .meaning = "work zone: what the tool does seen from the part, mm or deg",
            .required = true},
    kSides,
    KeyRule{.key = "plain",
            .kind = ValueKind::kFlag,
            .meaning = "whether a plain axis may realise it; true if not given"},
    KeyRule{.key = "part_pivot",
            .kind = ValueKind::kTriple,
            .meaning = "a point on the plain axis when it carries the part, from the middle of "
                       "coordinates, mm"},
    KeyRule{.key = "tool_pivot",
            .kind = ValueKind::kTriple,
            .meaning = "the same when it carries the tool, mm"},
    kSpeed,
    kAcceleration,
    kStiffness,
};
constexpr TableRule kMotion{.title = "[motions.<name>]", .keys = kMotionKeys};

constexpr std::array kEndKeys{
    KeyRule{.key = "side",
            .kind = ValueKind::kWord,
            .meaning = "of the base on which the chain ends so",
            .words = kSideWords,
            .required = true},
    KeyRule{.key = "chain",
            .kind = ValueKind::kText,
            .meaning = "as in a formula: \"part_xy\", \"C_v tool\", \"(tool1 + tool2)\"",
            .required = true},
    KeyRule{.key = "layout",
            .kind = ValueKind::kAnything,
            .meaning = "tables that a layout with this end has besides: part, tool1, axis, block"},
};
constexpr TableRule kEnd{.title = "[ends.<name>]", .keys = kEndKeys};

constexpr std::array kMountKeys{
    KeyRule{.key = "position",
            .kind = ValueKind::kTriple,
            .meaning = "beside the place that puts the mechanism's home into the middle of the "
                       "work zone, mm"},
    KeyRule{.key = "rotation",
            .kind = ValueKind::kTriple,
            .meaning = "angles a b c in the carrier, Rx(a) Ry(b) Rz(c), deg"},
};
constexpr TableRule kMount{.title = "[modules.<name>.mounts.<name>]", .keys = kMountKeys};

constexpr std::array kDriveKeys{
    KeyRule{.key = "range",
            .kind = ValueKind::kInterval,
            .meaning = "lowest and highest reading of the drive, mm or deg"},
    kSpeed,
    kAcceleration,
    kStiffness,
};
constexpr TableRule kDrive{.title = "[modules.<name>.drive.<drive>]", .keys = kDriveKeys};

constexpr std::array kModuleKeys{
    KeyRule{.key = "module",
            .kind = ValueKind::kText,
            .meaning = "id of a mechanism (kompono plugins lists them)",
            .required = true},
    KeyRule{.key = "letters",
            .kind = ValueKind::kTexts,
            .meaning = "sets of motions it may realise, \"XY\"; all that it can if not given"},
    kSides,
    KeyRule{.key = "mounts",
            .kind = ValueKind::kTablesByName,
            .meaning = "ways to mount it; one for each set of motions if not given",
            .table = &kMount},
    KeyRule{.key = "modes",
            .kind = ValueKind::kAnything,
            .meaning = "\"all\", or a list of tables of signs { q1 = \"+\" }; the module's own if "
                       "not given"},
    KeyRule{.key = "parameters",
            .kind = ValueKind::kAnything,
            .meaning = "value, { levels = […] } to choose from, or { range = [a, b], start = c } "
                       "to size; mm or deg"},
    KeyRule{.key = "home",
            .kind = ValueKind::kAnything,
            .meaning = "the module's own translations in the middle of the work zone, as "
                       "parameters are given; 0 if not given, mm"},
    KeyRule{.key = "drive",
            .kind = ValueKind::kTablesByName,
            .meaning = "what is known of each drive, by the names of the module's description",
            .table = &kDrive},
};
constexpr TableRule kModule{.title = "[modules.<name>]", .keys = kModuleKeys};

constexpr std::array kRuleKeys{
    KeyRule{.key = "name", .kind = ValueKind::kText, .meaning = "for reports", .required = true},
    KeyRule{.key = "forbid",
            .kind = ValueKind::kAnything,
            .meaning = "one or two terms that may not go together; a term is a tag or a list of "
                       "tags, all of which must be met, \"!tag\" is its opposite"},
    KeyRule{.key = "forbid_order",
            .kind = ValueKind::kAnything,
            .meaning = "two terms: an item that meets the first may not stand nearer to the "
                       "workpiece than one that meets the second"},
    KeyRule{.key = "kind",
            .kind = ValueKind::kWord,
            .meaning = "why: it contradicts itself, experience, or a standard or decision",
            .words = kKinds,
            .required = true},
    KeyRule{.key = "reason",
            .kind = ValueKind::kText,
            .meaning = "one sentence for people",
            .required = true},
    KeyRule{.key = "author",
            .kind = ValueKind::kText,
            .meaning = "a person, paper or standard",
            .required = true},
    KeyRule{.key = "off", .kind = ValueKind::kFlag, .meaning = "true: the rule does not count"},
};
constexpr TableRule kRule{.title = "[[rule]]", .keys = kRuleKeys};

constexpr std::array kLimitKeys{
    KeyRule{.key = "min", .kind = ValueKind::kNumber, .meaning = "least value"},
    KeyRule{.key = "max", .kind = ValueKind::kNumber, .meaning = "greatest value"},
};
constexpr TableRule kLimit{.title = "[limits.<metric>]", .keys = kLimitKeys};

constexpr std::array kReferenceKeys{
    KeyRule{.key = "formula",
            .kind = ValueKind::kText,
            .meaning = "of the layout that the others are compared with",
            .required = true},
    KeyRule{.key = "choices",
            .kind = ValueKind::kTextsByName,
            .meaning = "alternatives of further features: { \"drive.mount\" = \"flat\" }"},
};
constexpr TableRule kReference{.title = "[reference]", .keys = kReferenceKeys};

constexpr std::array kFileKeys{
    KeyRule{.key = "kompono",
            .kind = ValueKind::kVersion,
            .meaning = "version of the file format",
            .required = true},
    KeyRule{.key = "study", .kind = ValueKind::kText, .meaning = "its name", .required = true},
    KeyRule{.key = "description", .kind = ValueKind::kText, .meaning = "what is asked"},
    KeyRule{.key = "equivalence",
            .kind = ValueKind::kWord,
            .meaning = "which layouts count as one; distribution if not given",
            .words = kEquivalences},
    KeyRule{.key = "base",
            .kind = ValueKind::kWords,
            .meaning = "one base (closed), two foundations O|O (open), or both; closed if not "
                       "given",
            .words = kBases},
    KeyRule{.key = "process",
            .kind = ValueKind::kWord,
            .meaning = "direction of the process or of the tool's axis; z if not given",
            .words = kDirections},
    KeyRule{.key = "part", .kind = ValueKind::kTable, .meaning = "the workpiece", .table = &kPart},
    KeyRule{.key = "motions",
            .kind = ValueKind::kTablesByName,
            .meaning = "required motions of the tool relative to the part, by letter",
            .table = &kMotion,
            .required = true},
    KeyRule{.key = "ends",
            .kind = ValueKind::kTablesByName,
            .meaning = "how the chains may end: leaf, units, spindles beside it; bare part and "
                       "tool if not given",
            .table = &kEnd},
    KeyRule{.key = "modules",
            .kind = ValueKind::kTablesByName,
            .meaning = "mechanisms that may realise motions, by the names of their blocks",
            .table = &kModule},
    KeyRule{.key = "rule",
            .kind = ValueKind::kTableList,
            .meaning = "what a designer would not combine",
            .table = &kRule},
    KeyRule{.key = "objectives",
            .kind = ValueKind::kWordsByName,
            .meaning = "metrics to rank by",
            .words = kGoals},
    KeyRule{.key = "limits",
            .kind = ValueKind::kTablesByName,
            .meaning = "metrics that must keep within limits",
            .table = &kLimit},
    KeyRule{.key = "reference",
            .kind = ValueKind::kTable,
            .meaning = "a layout to compare with",
            .table = &kReference},
    KeyRule{.key = "evaluation",
            .kind = ValueKind::kAnything,
            .meaning = "assumptions of the evaluation, the same for all layouts"},
};
constexpr TableRule kFile{.title = "study file", .keys = kFileKeys};

}  // namespace

const KeyRule* TableRule::Find(std::string_view key) const {
  const auto found =
      std::find_if(keys.begin(), keys.end(), [key](const auto& rule) { return rule.key == key; });
  return found == keys.end() ? nullptr : &*found;
}

std::vector<std::string> TableRule::KeyNames() const {
  std::vector<std::string> names;
  names.reserve(keys.size());
  for (const KeyRule& rule : keys) names.emplace_back(rule.key);
  return names;
}

const TableRule& StudyRuleOfFile() {
  return kFile;
}

}  // namespace kompono::synthesis
