// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_LAYOUT_LAYOUT_HPP_
#define KOMPONO_LAYOUT_LAYOUT_HPP_

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/formula/formula.hpp"
#include "kompono/plugin/registry.hpp"

/// A machine's layout as a value: what a `layout.toml` says, judged and converted to millimetres,
/// radians, seconds and newtons. Everything a Machine needs and nothing that runs. File format:
/// docs/design.md, section 5.
namespace kompono::layout {

/// Position and rotation of a frame in its carrier: T(position) Rx(a) Ry(b) Rz(c).
struct Placement {
  std::array<double, 3> position_mm{};
  std::array<double, 3> rotation_rad{};
  bool operator==(const Placement&) const = default;
};

/// What is known of one drive. The control reads `reading`; the mechanism's drive coordinate is
/// zero + sign * reading.
struct Drive {
  std::optional<double> lower, upper;  ///< of the reading; mm or rad
  std::optional<double> speed;         ///< mm/s or rad/s
  std::optional<double> acceleration;  ///< mm/s² or rad/s²
  std::optional<double> stiffness;     ///< N/mm or N mm/rad
  double zero = 0.0;                   ///< drive coordinate when the control reads 0; mm or rad
  int sign = 1;                        ///< -1: the reading counts against the drive coordinate
};

/// How far a strut may swing in its joint, away from its direction at home as the body that carries
/// the joint sees it.
struct JointLimit {
  std::string points;  ///< pattern of skeleton points that end struts, "base*"
  double swing = 0.0;  ///< rad
};

/// One parallel mechanism: what ":name" in the formula means.
struct Block {
  std::string name;
  std::string module;
  std::vector<double> parameters;  ///< flat, in the order of the module's description; mm, rad
  std::vector<int> modes;          ///< +1 / -1 in the order of the description
  Placement mount;                 ///< the mechanism's base in its carrier
  std::vector<Drive> drives;       ///< in the order of the description
  /// Local coordinate i of the module is sign * the formula's letter; "YZBC" of the formula may be
  /// "XYAB" of the module.
  struct LetterMap {
    char formula_letter = 'X';  ///< the letter (of the group's axis) this local coordinate realises
    std::string axis;           ///< the axis' name in the formula, "Z" or "X4"
    int sign = 1;
  };
  std::vector<LetterMap> letters;  ///< one per local coordinate
  std::vector<std::optional<double>>
      home;  ///< per local coordinate, in formula letters' sense; mm, rad
  std::vector<std::optional<double>> lower;  ///< optional limits of the coordinates, likewise
  std::vector<std::optional<double>> upper;
  std::vector<JointLimit> joints;
  std::optional<double> strut_diameter;  ///< mm; struts are capsules
  std::optional<double> clearance;       ///< mm, between struts that share no joint
};

/// A plain axis of the formula.
struct Axis {
  std::string name;  ///< "Z", "X4", "C_h" is "C"
  char letter = 'X';
  bool main_motion = false;  ///< a main-motion spindle: not positioned unless the layout says so
  Placement frame;           ///< a point on the axis and its tilt; at 0 the axis moves nothing
  Drive drive;
  double home = 0.0;
};

/// The end of a chain: workpiece, tool or process, with the unit that realises it.
struct End {
  std::string name;    ///< "part", "part1", "tool", "P_z"
  std::string module;  ///< unit module; empty: a bare frame
  std::vector<double> parameters;
  Placement mount;  ///< the unit's base in its carrier
  std::string station;
  int state = 0;
  std::string table;  ///< the table of the file that describes it or would: "tool" for "P_z"
};

/// What `kompono calibrate` may change; patterns such as "struts.base[*]", "open_base.*", "*.zero".
struct CalibrationSettings {
  std::vector<std::string> free;                        ///< empty: all identifiable ones
  std::vector<std::string> lock;                        ///< applied after `free`
  std::map<std::string, double> prior_sigma;            ///< pattern -> standard deviation; mm, rad
  std::map<std::string, std::array<double, 2>> bounds;  ///< pattern -> lower, upper; mm, rad
};

/// How the angles A B C of a pose are meant.
enum class RotationOrder {
  kXYZ,  ///< R = Rx(A) Ry(B) Rz(C), GIP and this project
  kZYX,  ///< R = Rz(C) Ry(B) Rx(A), LinuxCNC and most controllers
};

struct Layout {
  std::string name;
  std::string description;
  formula::Formula formula;
  std::vector<Block> blocks;
  std::vector<Axis> axes;
  std::vector<End> ends;  ///< every part, tool and process of the formula, in its order
  Placement
      open_base;  ///< the tool-side foundation in the workpiece-side one; identity for one base
  RotationOrder rotation_order = RotationOrder::kXYZ;
  CalibrationSettings calibration;
  std::filesystem::path file;  ///< where it was read from; may be empty
  std::string text;            ///< the TOML it was read from

  [[nodiscard]] const Block* FindBlock(std::string_view name) const;
  [[nodiscard]] const Axis* FindAxis(std::string_view name) const;
  [[nodiscard]] const End* FindEnd(std::string_view name) const;
};

/// Reads and judges a layout; every problem of the file in one run (codes E03xx and, for the
/// formula, E01xx placed in the file). `notes` receives warnings and notes of a good file, if not
/// null.
[[nodiscard]] Parsed<Layout> ParseLayout(std::string_view text,
                                         std::string_view file,
                                         const plugin::Registry& registry,
                                         Diagnostics* notes = nullptr);
[[nodiscard]] Parsed<Layout> ReadLayout(const std::filesystem::path& file,
                                        const plugin::Registry& registry,
                                        Diagnostics* notes = nullptr);

/// One number to be changed in a layout file: "delta.strut[2]", "delta.mount.x", "delta.q1.zero",
/// "open_base.c", "tool.length", "Z.zero"; value in mm or rad.
struct Replacement {
  std::string parameter;
  double value = 0.0;
  std::optional<double> sigma;
};

/// The text of `layout` with numbers replaced, comments and order kept as far as the file allows,
/// and a [calibrated] table that tells the source and the nominal values. The result parses back to
/// a layout with exactly these numbers.
[[nodiscard]] Parsed<std::string> ReplaceNumbers(const Layout& layout,
                                                 const plugin::Registry& registry,
                                                 const std::vector<Replacement>& replacements,
                                                 std::string_view source);

/// JSON Schema (draft 2020-12) of layout files for editors, built from the reader's own table of
/// keys; with the modules of `registry` as choices.
[[nodiscard]] std::string LayoutSchema(const plugin::Registry& registry);

}  // namespace kompono::layout

#endif  // KOMPONO_LAYOUT_LAYOUT_HPP_
