// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_WORKSHOP_HPP_
#define KOMPONO_ANALYSIS_WORKSHOP_HPP_

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "kompono/kinematics/machine.hpp"
#include "kompono/plugin/registry.hpp"

namespace kompono::analysis {

/// The way from the base to one end of the formula.
struct Way {
  std::string leaf;             ///< "part_xy", as Machine::Between wants it
  std::string end;              ///< "part"
  std::set<std::string> moves;  ///< working coordinates on the way, by their names in the machine
  std::set<std::string> facts;  ///< capabilities of the unit's module
  bool main_motion = false;     ///< a spindle on the way, or the unit's own

  [[nodiscard]] bool Is(std::string_view fact) const { return facts.contains(std::string(fact)); }
};

/// Two holders of parts seen along the axis of the first.
struct Facing {
  double angle_rad = 0.0;   ///< between the first's axis and the second's, turned about
  double offset_mm = 0.0;   ///< between the axes, at the second's stop
  double nearest_mm = 0.0;  ///< between the stops, within the ranges; may be -inf and +inf
  double furthest_mm = 0.0;
  std::vector<std::string> closing;  ///< working motions that change the distance

  [[nodiscard]] bool Coaxial() const;
  [[nodiscard]] bool Faces() const;
};

/// The formula's ends with what carries them, and questions about pairs of them.
class Workshop {
 public:
  Workshop(const kinematics::Machine& machine, const plugin::Registry& registry);

  [[nodiscard]] const std::vector<Way>& parts() const { return parts_; }  ///< hold a part
  [[nodiscard]] const std::vector<Way>& supports() const { return supports_; }
  /// Tools that move together: each inner list is one carrier, whose tools have the same motions or
  /// share so many that they cannot work at different places at once.
  [[nodiscard]] const std::vector<std::vector<Way>>& carriers() const { return carriers_; }

  [[nodiscard]] Facing FacingOf(const Way& first, const Way& second) const;

  /// Distance from the part's stop, along its axis, at which the tool's tip can stand on the axis.
  [[nodiscard]] std::optional<double> Reaches(const Way& part, const Way& tool) const;
  /// The first tool of the carrier that reaches the part.
  [[nodiscard]] const Way* Reaches(const Way& part, const std::vector<Way>& carrier) const;

  /// Working turns of the tool's way about an axis across the part's.
  [[nodiscard]] std::vector<std::string> Swings(const Way& part, const Way& tool) const;

  /// Working translations of the part's way in directions in which the tool's way translates too.
  [[nodiscard]] std::vector<std::string> SharedTravel(const Way& part, const Way& tool) const;

  /// How many tools the end holds; counts of turrets from their parameters.
  [[nodiscard]] int ToolsOf(const Way& tool) const;

 private:
  [[nodiscard]] const kinematics::Machine& Chain(const Way& part, const Way& tool) const;
  [[nodiscard]] bool MoveApart(const Way& one, const Way& other) const;
  void GroupTools(std::vector<Way> tools);

  const kinematics::Machine& machine_;
  const plugin::Registry& registry_;
  std::vector<Way> parts_, supports_;
  std::vector<std::vector<Way>> carriers_;
  mutable std::map<std::pair<std::string, std::string>, kinematics::Machine> chains_;
};

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_WORKSHOP_HPP_
