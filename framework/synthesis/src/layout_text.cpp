// SPDX-License-Identifier: Apache-2.0
// A candidate as a layout file.
#include "end_tables.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "kompono/diagnostics/expects.hpp"
#include "kompono/geometry/pose.hpp"
#include "kompono/layout/letters.hpp"
#include "kompono/synthesis/candidate.hpp"

namespace kompono::synthesis {
namespace {

constexpr double kDegPerRad = 57.295779513082320877;
constexpr double kSecondsPerMinute = 60.0;
constexpr double kStiffnessFactor = 1000.0;

/// A TOML string.
std::string Quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < 0x20U ? ' ' : c;
  }
  return quoted + "\"";
}

/// A number that reads back the same; angles lose the dust of their conversion.
std::string Number(double value, bool angle) {
  if (!angle) return fmt::format("{}", value + 0.0);
  return fmt::format("{:.15g}", value * kDegPerRad + 0.0);
}

class LayoutWriter {
 public:
  LayoutWriter(const StudySpace& space, const Candidate& candidate, std::span<const Size> sizes)
      : space_(space), study_(space.study()), candidate_(candidate), sizes_(sizes) {}

  std::string Write() {
    Line("kompono = 1");
    Line("name = {}", Quoted(fmt::format("{}, layout {}", study_.name, candidate_.index)));
    Line("formula = {}", Quoted(formula::Canonical(space_.FormulaOf(candidate_))));
    const Matrix3<double> R_tool = WriteSide(false);
    const Matrix3<double> R_part = WriteSide(true);
    text_ += TurnedTables(EndOf(candidate_.part_end), R_part.transpose());
    text_ += TurnedTables(EndOf(candidate_.tool_end), R_tool.transpose());
    return std::move(text_);
  }

 private:
  [[nodiscard]] const EndChoice& EndOf(int end) const {
    return study_.ends[static_cast<std::size_t>(end)];
  }

  /// The items of one side from the base outward. A platform keeps the turn of its mount and hands
  /// it on; what stands on it is turned back, so that letters mean the same directions everywhere.
  /// Returns how the last item's frame lies in the base's.
  Matrix3<double> WriteSide(bool part_side) {
    std::vector<Candidate::Placed> side;
    for (const Candidate::Placed& placed : candidate_.chain) {
      if (placed.part_side == part_side) side.push_back(placed);
    }
    if (part_side) std::reverse(side.begin(), side.end());
    Matrix3<double> R = Matrix3<double>::Identity();
    for (const Candidate::Placed& placed : side) {
      const Item& item = space_.items()[static_cast<std::size_t>(placed.item)];
      if (item.module < 0) {
        const Motion& motion = study_.motions[static_cast<std::size_t>(item.motions[0])];
        WriteAxis(motion, part_side, R);
      } else {
        const Candidate::Block& block = BlockOf(item);
        WriteBlock(item, block, part_side);
        const auto& turn = study_.modules[static_cast<std::size_t>(block.module)]
                               .mounts[static_cast<std::size_t>(block.mount)]
                               .placement.rotation_rad;
        R = RotationXYZ(turn[0], turn[1], turn[2]);
      }
    }
    return R;
  }

  template <class... Values>
  void Line(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    text_ += '\n';
  }

  [[nodiscard]] const Candidate::Block& BlockOf(const Item& item) const {
    const auto found = std::find_if(candidate_.blocks.begin(),
                                    candidate_.blocks.end(),
                                    [&item](const auto& one) { return one.module == item.module; });
    KOMPONO_EXPECTS(found != candidate_.blocks.end());
    return *found;
  }

  /// What the axis itself does so that the tool does the motion: seen from the carrier, a part
  /// moves the other way.
  static Interval Way(const Motion& motion, bool part_side) {
    return part_side ? Interval{-motion.range.upper, -motion.range.lower} : motion.range;
  }

  void WriteDrive(const layout::Drive& drive, bool rotary) {
    const double unit = rotary ? kDegPerRad : 1.0;
    if (drive.lower && drive.upper) {
      Line("range = [{}, {}]", Number(*drive.lower, rotary), Number(*drive.upper, rotary));
    }
    if (drive.speed) Line("speed = {:.12g}", *drive.speed * unit * kSecondsPerMinute);
    if (drive.acceleration) Line("acceleration = {:.12g}", *drive.acceleration * unit);
    if (drive.stiffness) Line("stiffness = {:.12g}", *drive.stiffness / kStiffnessFactor);
  }

  void WriteAxis(const Motion& motion, bool part_side, const Matrix3<double>& R) {
    const bool rotary = motion.axis.rotary();
    const Interval way = Way(motion, part_side);
    Line("\n[axis.{}]", motion.name);
    Line("range = [{}, {}]", Number(way.lower, rotary), Number(way.upper, rotary));
    Line("home = {}", Number(way.middle(), rotary));
    WriteDrive(motion.drive, rotary);
    const auto& pivot = part_side ? motion.part_pivot_mm : motion.tool_pivot_mm;
    const Vector3<double> position = R.transpose() * Vector3<double>(pivot.data());
    const std::array<double, 3> turn = AnglesOf(R.transpose());
    if (!position.isZero(0.0)) {
      Line("position = [{}, {}, {}]",
           Cleaned(position[0]),
           Cleaned(position[1]),
           Cleaned(position[2]));
    }
    if (!R.isApprox(Matrix3<double>::Identity(), 1e-12)) {
      Line("rotation = [{}, {}, {}]",
           Number(turn[0], true),
           Number(turn[1], true),
           Number(turn[2], true));
    }
  }

  void WriteBlock(const Item& item, const Candidate::Block& block, bool part_side) {
    const StudyModule& module = study_.modules[static_cast<std::size_t>(block.module)];
    const plugin::ModuleDescription& description = *space_.registry().Find(module.module);
    const MountChoice& mount = module.mounts[static_cast<std::size_t>(block.mount)];
    Line("\n[block.{}]", module.name);
    Line("module = {}", Quoted(module.module));
    WriteModes(description, module.modes[static_cast<std::size_t>(block.mode)]);
    WriteCoordinates(item, block, description, mount, part_side);
    WriteParameters(description, block);
    for (std::size_t i = 0; i < module.drives.size(); ++i) {
      const layout::Drive& drive = module.drives[i];
      if (!drive.lower && !drive.speed && !drive.acceleration && !drive.stiffness) continue;
      Line("\n[block.{}.drive.{}]", module.name, description.drives[i].name);
      WriteDrive(drive, description.drives[i].rotary);
    }
  }

  void WriteModes(const plugin::ModuleDescription& description, const ModeChoice& mode) {
    std::string signs;
    for (std::size_t i = 0; i < description.modes.size(); ++i) {
      signs += fmt::format("{}{} = \"{}\"",
                           i == 0 ? "" : ", ",
                           description.modes[i].name,
                           mode.signs[i] > 0 ? '+' : '-');
    }
    if (!signs.empty()) Line("mode = {{ {} }}", signs);
  }

  /// Mount, home and range. The mount takes back what the home is away from the middle of the
  /// work zone, so that coordinates of the tool are those of the motions.
  void WriteCoordinates(const Item& item,
                        const Candidate::Block& block,
                        const plugin::ModuleDescription& description,
                        const MountChoice& mount,
                        bool part_side) {
    std::vector<formula::Axis> wanted;
    for (const int motion : item.motions) {
      wanted.push_back(study_.motions[static_cast<std::size_t>(motion)].axis);
    }
    const layout::LetterFit fit = layout::FitLetters(description.letters, mount.placement, wanted);
    KOMPONO_EXPECTS(fit.ok());
    const std::vector<double> home = HomeOf(space_, block, sizes_);
    Vector3<double> shift = Vector3<double>::Zero();
    std::string homes;
    std::string ranges;
    for (std::size_t i = 0; i < description.letters.size(); ++i) {
      const layout::Block::LetterMap& letter = fit.letters[i];
      const Motion& motion = MotionOf(item, letter.axis);
      const bool rotary = motion.axis.rotary();
      const Interval way = Way(motion, part_side);
      const double sign = letter.sign;
      const double middle = rotary ? way.middle() : sign * home[i];
      if (!rotary) {
        shift[AxisOfLetter(description.letters[i])] = sign * way.middle() - home[i];
      }
      const char* comma = i == 0 ? "" : ", ";
      homes += fmt::format("{}{} = {}", comma, letter.axis, Number(middle, rotary));
      ranges += fmt::format("{}{} = [{}, {}]",
                            comma,
                            letter.axis,
                            Number(middle - 0.5 * way.width(), rotary),
                            Number(middle + 0.5 * way.width(), rotary));
    }
    const auto& turn = mount.placement.rotation_rad;
    const Vector3<double> position = RotationXYZ(turn[0], turn[1], turn[2]) * shift +
                                     Vector3<double>(mount.placement.position_mm.data());
    Line("mount = {{ position = [{}, {}, {}], rotation = [{}, {}, {}] }}",
         Cleaned(position[0]),
         Cleaned(position[1]),
         Cleaned(position[2]),
         Number(turn[0], true),
         Number(turn[1], true),
         Number(turn[2], true));
    Line("home = {{ {} }}", homes);
    Line("range = {{ {} }}", ranges);
  }

  /// Without what right angles leave of a length of a kilometre: 1e-10 mm.
  static double Cleaned(double length) { return std::abs(length) < 1e-9 ? 0.0 : length + 0.0; }

  [[nodiscard]] const Motion& MotionOf(const Item& item, const std::string& axis) const {
    const auto found = std::find_if(item.motions.begin(), item.motions.end(), [&](int motion) {
      return study_.motions[static_cast<std::size_t>(motion)].name == axis;
    });
    KOMPONO_EXPECTS(found != item.motions.end());
    return study_.motions[static_cast<std::size_t>(*found)];
  }

  void WriteParameters(const plugin::ModuleDescription& description,
                       const Candidate::Block& block) {
    const std::vector<double> numbers = ParametersOf(space_, block, sizes_);
    const StudyModule& module = study_.modules[static_cast<std::size_t>(block.module)];
    Line("\n[block.{}.parameters]", module.name);
    for (const plugin::ParameterDescription& parameter : description.parameters) {
      if (parameter.fixed) continue;
      const auto begin = static_cast<std::size_t>(parameter.offset);
      const auto number = [&](std::size_t i) {
        return Number(numbers[begin + i], parameter.angle());
      };
      std::string value;
      const auto count = static_cast<std::size_t>(parameter.Numbers());
      const bool points = parameter.shape == plugin::ParameterShape::kPoints;
      if (parameter.shape == plugin::ParameterShape::kNumber) {
        value = number(0);
      } else {
        for (std::size_t i = 0; i < count; ++i) {
          value += i == 0 ? "" : ", ";
          if (points && i % 3 == 0) value += '[';
          value += number(i);
          if (points && i % 3 == 2) value += ']';
        }
        value = fmt::format("[{}]", value);
      }
      Line("{} = {}", parameter.name, value);
    }
  }

  const StudySpace& space_;
  const Study& study_;
  const Candidate& candidate_;
  std::span<const Size> sizes_;
  std::string text_;
};

}  // namespace

std::string LayoutText(const StudySpace& space,
                       const Candidate& candidate,
                       std::span<const Size> sizes) {
  return LayoutWriter(space, candidate, sizes).Write();
}

}  // namespace kompono::synthesis
