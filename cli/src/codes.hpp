// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_CODES_HPP_
#define KOMPONO_CLI_CODES_HPP_

#include <array>
#include <string_view>

/// What the command line itself complains of, E06xx. A code keeps its meaning between versions.
/// docs/commands.md lists them.
namespace kompono::cli {

struct CodeTitle {
  std::string_view code;
  std::string_view title;
};

namespace codes {
inline constexpr CodeTitle kUnknownCommand{"E0601", "unknown command"};
inline constexpr CodeTitle kUnknownOption{"E0602", "unknown option"};
inline constexpr CodeTitle kUsage{"E0603", "wrong use of an argument or option"};
inline constexpr CodeTitle kUnknownName{"E0604", "unknown name"};
inline constexpr CodeTitle kRepeatedName{"E0605", "name given twice"};
inline constexpr CodeTitle kAmbiguousName{"E0606", "short name that several things have"};
inline constexpr CodeTitle kMissingName{"E0607", "drive without a reading"};
inline constexpr CodeTitle kBadNumber{"E0608", "not a number"};
inline constexpr CodeTitle kBadAssignment{"E0609", "not of the form name=value"};
inline constexpr CodeTitle kBadTable{"E0610", "wrong CSV table"};
inline constexpr CodeTitle kMixedUnits{"E0611", "pattern that names lengths and angles"};
inline constexpr CodeTitle kNeedsLayout{"E0612", "measurements without their layout"};
inline constexpr CodeTitle kCannotRead{"E0613", "file that cannot be read"};
inline constexpr CodeTitle kCannotWrite{"E0614", "file that cannot be written"};
inline constexpr CodeTitle kFileExists{"E0615", "file that exists already"};
inline constexpr CodeTitle kUnknownModule{"E0616", "neither plugin nor module"};
inline constexpr CodeTitle kBadJson{"E0617", "wrong JSON file"};
inline constexpr CodeTitle kUnknownFormat{"E0618", "file of an unknown kind"};
}  // namespace codes

/// All of them in ascending order.
inline constexpr std::array kCodes{
    codes::kUnknownCommand,
    codes::kUnknownOption,
    codes::kUsage,
    codes::kUnknownName,
    codes::kRepeatedName,
    codes::kAmbiguousName,
    codes::kMissingName,
    codes::kBadNumber,
    codes::kBadAssignment,
    codes::kBadTable,
    codes::kMixedUnits,
    codes::kNeedsLayout,
    codes::kCannotRead,
    codes::kCannotWrite,
    codes::kFileExists,
    codes::kUnknownModule,
    codes::kBadJson,
    codes::kUnknownFormat,
};

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_CODES_HPP_
