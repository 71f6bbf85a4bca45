// SPDX-License-Identifier: Apache-2.0
// The rules of KDD table 1, each from the facts that the workshop tells.
#include "kompono/analysis/abilities.hpp"

#include "workshop.hpp"
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kompono/plugin/capability_words.hpp"

namespace kompono::analysis {
namespace {

struct Words {
  std::string_view name, title;
};
constexpr std::array<Words, 9> kWords{{
    {"sequential_parts", "sequential work on two short parts"},
    {"take_over", "the part is taken over and its second end finished"},
    {"long_part_ends", "opposite ends of long parts"},
    {"more_tools", "more tools and less idle time"},
    {"two_tools_at_once", "two tools on a long part at once"},
    {"parallel_parts", "two short parts in parallel"},
    {"reclamped_ends", "both ends of a part with automatic re-clamping"},
    {"quick_changeover", "quick change-over to long parts"},
    {"larger_zone", "larger work zone"},
}};

using Carrier = std::vector<Way>;

std::string Listed(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string Length(double mm) {
  return std::isfinite(mm) ? fmt::format("{:.6g} mm", mm) : std::string("any length");
}

/// "120 to 900 mm"
std::string Distances(const Facing& facing) {
  const double nearest = std::max(0.0, facing.nearest_mm);
  return std::isfinite(facing.furthest_mm)
             ? fmt::format("{:.6g} to {:.6g} mm", nearest, facing.furthest_mm)
             : fmt::format("{:.6g} mm and more", nearest);
}

Ability Missing(std::string reason) {
  return {.kind = {}, .possible = false, .reason = std::move(reason), .by = {}};
}

Ability Given(std::string reason, std::vector<std::string> by) {
  Ability out{.kind = {}, .possible = true, .reason = std::move(reason), .by = {}};
  for (std::string& name : by) {
    if (std::find(out.by.begin(), out.by.end(), name) == out.by.end())
      out.by.push_back(std::move(name));
  }
  return out;
}

std::vector<std::string> Together(std::vector<std::string> some,
                                  const std::vector<std::string>& others) {
  some.insert(some.end(), others.begin(), others.end());
  return some;
}

/// Two spindles that hold parts, in the order of the formula.
struct Pair {
  const Way* first = nullptr;
  const Way* second = nullptr;
};

class Judge {
 public:
  explicit Judge(const Workshop& shop) : shop_(shop) {
    for (const Way& part : shop.parts()) {
      if (pair_.second != nullptr || !part.main_motion) continue;
      (pair_.first == nullptr ? pair_.first : pair_.second) = &part;
    }
    if (pair_.second != nullptr) facing_ = shop.FacingOf(*pair_.first, *pair_.second);
  }

  [[nodiscard]] Ability SequentialParts() const {
    if (pair_.second == nullptr) return Missing(NoSecondSpindle());
    for (const Carrier& carrier : shop_.carriers()) {
      const Way* first = shop_.Reaches(*pair_.first, carrier);
      const Way* second = shop_.Reaches(*pair_.second, carrier);
      if (first == nullptr || second == nullptr) continue;
      return Given(fmt::format("{} works on {}, then{} on {}",
                               first->end,
                               pair_.first->end,
                               first == second ? "" : " " + second->end,
                               pair_.second->end),
                   {pair_.first->end, pair_.second->end, first->end, second->end});
    }
    return Missing(
        fmt::format("no tool reaches both {} and {}", pair_.first->end, pair_.second->end));
  }

  [[nodiscard]] Ability TakeOver() const {
    if (pair_.second == nullptr) return Missing(NoSecondSpindle());
    const std::string& first = pair_.first->end;
    const std::string& second = pair_.second->end;
    if (!facing_.Faces())
      return Missing(fmt::format("{} does not look back at {}: {:.4g}° are left between their axes",
                                 second,
                                 first,
                                 facing_.angle_rad * 180.0 / std::numbers::pi));
    if (!facing_.Coaxial())
      return Missing(fmt::format(
          "{} stands {:.4g} mm beside the axis of {}", second, facing_.offset_mm, first));
    if (facing_.closing.empty())
      return Missing(fmt::format("no working motion brings {} and {} together", first, second));
    if (facing_.furthest_mm <= 0.0)
      return Missing(fmt::format("{} stands behind {} in all their range", second, first));
    return Given(fmt::format("{} and {} are coaxial and face each other, {} apart by {}",
                             first,
                             second,
                             Distances(facing_),
                             Listed(facing_.closing)),
                 Together({first, second}, facing_.closing));
  }

  [[nodiscard]] Ability LongPartEnds() const {
    const Ability taken = TakeOver();
    if (!taken.possible) return Missing("no take-over: " + taken.reason);
    for (const Carrier& carrier : shop_.carriers()) {
      const Way* first = shop_.Reaches(*pair_.first, carrier);
      const Way* second = shop_.Reaches(*pair_.second, carrier);
      if (first == nullptr || second == nullptr) continue;
      const BothWays both = FacesBothWays(carrier);
      if (both.by.empty()) continue;
      return Given(fmt::format("{} faces either end by {}; parts up to {}",
                               first->end,
                               both.means,
                               Length(facing_.furthest_mm)),
                   Together({pair_.first->end, pair_.second->end, first->end}, both.by));
    }
    const Pairing apart = OneEach();
    if (apart.first == nullptr)
      return Missing("no tool that reaches both ends can turn to either of them");
    return Given(fmt::format("{} works on the end at {}, {} on the other; parts up to {}",
                             apart.first->end,
                             pair_.first->end,
                             apart.second->end,
                             Length(facing_.furthest_mm)),
                 {pair_.first->end, pair_.second->end, apart.first->end, apart.second->end});
  }

  [[nodiscard]] Ability MoreTools() const {
    std::vector<std::string> names;
    std::vector<std::string> counted;
    bool twin = false;
    for (const Carrier& carrier : shop_.carriers()) {
      for (const Way& tool : carrier) {
        names.push_back(tool.end);
        const int tools = shop_.ToolsOf(tool);
        counted.push_back(tools == 1 ? tool.end : fmt::format("{} ({})", tool.end, tools));
        twin = twin || tool.Is(plugin::words::kTwoTurrets);
      }
    }
    if (names.size() > 1)
      return Given(fmt::format("{}: one makes ready while another cuts", Listed(counted)), names);
    if (twin)
      return Given(fmt::format("two turrets on {}, {} tools in each: one indexes while the other "
                               "cuts",
                               names.front(),
                               shop_.ToolsOf(shop_.carriers().front().front())),
                   names);
    return Missing(fmt::format("{} is the only set of tools", names.front()));
  }

  [[nodiscard]] Ability TwoToolsAtOnce() const {
    if (shop_.carriers().size() < 2) return Missing(OneCarrier());
    for (const Way& part : shop_.parts()) {
      const Way* end = OtherEnd(part);
      if (end == nullptr) continue;
      std::vector<const Way*> tools;
      for (const Carrier& carrier : shop_.carriers()) {
        if (const Way* tool = shop_.Reaches(part, carrier)) tools.push_back(tool);
      }
      if (tools.size() < 2) continue;
      return Given(fmt::format("{} and {} move by themselves and both reach the part between {} "
                               "and {}",
                               tools[0]->end,
                               tools[1]->end,
                               part.end,
                               end->end),
                   {tools[0]->end, tools[1]->end, part.end, end->end});
    }
    return Missing("no part held at both ends is reached by two tools that move by themselves");
  }

  [[nodiscard]] Ability ParallelParts() const {
    if (pair_.second == nullptr) return Missing(NoSecondSpindle());
    if (shop_.carriers().size() < 2) return Missing(OneCarrier());
    const Pairing each = OneEach();
    if (each.first == nullptr)
      return Missing(fmt::format("no two tools that move by themselves reach {} and {}",
                                 pair_.first->end,
                                 pair_.second->end));
    return Given(fmt::format("{} works on {} while {} works on {}",
                             each.first->end,
                             pair_.first->end,
                             each.second->end,
                             pair_.second->end),
                 {pair_.first->end, pair_.second->end, each.first->end, each.second->end});
  }

  [[nodiscard]] Ability ReclampedEnds() const {
    const Ability taken = TakeOver();
    if (!taken.possible) return Missing("no take-over: " + taken.reason);
    const Ability parallel = ParallelParts();
    if (!parallel.possible) return Missing(parallel.reason);
    return Given(fmt::format("{} passes the part to {} by {}; {}",
                             pair_.first->end,
                             pair_.second->end,
                             Listed(facing_.closing),
                             parallel.reason),
                 Together(parallel.by, facing_.closing));
  }

  [[nodiscard]] Ability QuickChangeover() const {
    const Ability parallel = ParallelParts();
    if (!parallel.possible) return Missing("no short parts in parallel: " + parallel.reason);
    const Ability at_once = TwoToolsAtOnce();
    if (!at_once.possible) return Missing("no two tools on a long part: " + at_once.reason);
    if (facing_.closing.empty())
      return Missing(fmt::format("no working motion changes the distance between {} and {}",
                                 pair_.first->end,
                                 pair_.second->end));
    return Given(fmt::format("{} changes between two short parts and one long part, {}",
                             Listed(facing_.closing),
                             Distances(facing_)),
                 Together({pair_.first->end, pair_.second->end}, facing_.closing));
  }

  [[nodiscard]] Ability LargerZone() const {
    if (shop_.parts().empty()) return Missing("no unit holds a part");
    std::vector<std::string> by;
    for (const Way& part : shop_.parts()) {
      std::vector<std::string> shared;
      for (const Carrier& carrier : shop_.carriers()) {
        for (const Way& tool : carrier) {
          if (shared.empty()) shared = shop_.SharedTravel(part, tool);
        }
      }
      if (shared.empty())
        return Missing(
            fmt::format("{} is not moved in a direction in which the tool is moved too", part.end));
      by = Together(std::move(by), shared);
    }
    Ability out = Given("", by);
    out.reason = fmt::format("the travel of {} adds to that of the tools", Listed(out.by));
    return out;
  }

 private:
  /// Different carriers, one for each spindle.
  struct Pairing {
    const Way* first = nullptr;
    const Way* second = nullptr;
  };

  [[nodiscard]] Pairing OneEach() const {
    const std::vector<Carrier>& carriers = shop_.carriers();
    for (std::size_t i = 0; i < carriers.size(); ++i) {
      for (std::size_t k = 0; k < carriers.size(); ++k) {
        if (i == k) continue;
        const Way* first = shop_.Reaches(*pair_.first, carriers[i]);
        const Way* second = shop_.Reaches(*pair_.second, carriers[k]);
        if (first != nullptr && second != nullptr) return {first, second};
      }
    }
    return {};
  }

  /// What lets the carrier's tools look at either end of a part.
  struct BothWays {
    std::string means;
    std::vector<std::string> by;
  };
  [[nodiscard]] BothWays FacesBothWays(const Carrier& carrier) const {
    for (const Way& tool : carrier) {
      if (tool.Is(plugin::words::kTwoTurrets)) return {"its two turrets", {tool.end}};
    }
    for (const Way& tool : carrier) {
      const std::vector<std::string> swings = shop_.Swings(*pair_.first, tool);
      if (!swings.empty()) return {Listed(swings), swings};
      if (tool.Is(plugin::words::kSwivelsTool)) return {"its swivel", {tool.end}};
    }
    return {};
  }

  /// The holder or support that takes the other end of a part held in `part`.
  [[nodiscard]] const Way* OtherEnd(const Way& part) const {
    for (const std::vector<Way>* list : {&shop_.parts(), &shop_.supports()}) {
      for (const Way& other : *list) {
        if (&other == &part) continue;
        const Facing facing = shop_.FacingOf(part, other);
        if (facing.Coaxial() && facing.furthest_mm > 0.0) return &other;
      }
    }
    return nullptr;
  }

  [[nodiscard]] std::string NoSecondSpindle() const {
    if (pair_.first == nullptr) return "no spindle turns a part";
    return fmt::format("{} is the only spindle that turns a part", pair_.first->end);
  }
  [[nodiscard]] std::string OneCarrier() const {
    const Carrier& carrier = shop_.carriers().front();
    if (carrier.size() == 1) return fmt::format("{} is the only tool", carrier.front().end);
    std::vector<std::string> names;
    names.reserve(carrier.size());
    for (const Way& tool : carrier) names.push_back(tool.end);
    return fmt::format("{} share their motions", Listed(names));
  }

  const Workshop& shop_;
  Pair pair_;
  Facing facing_;
};

}  // namespace

std::string_view Ability::name() const {
  return kWords.at(static_cast<std::size_t>(kind)).name;
}
std::string_view Ability::title() const {
  return kWords.at(static_cast<std::size_t>(kind)).title;
}

std::vector<Ability> Abilities(const kinematics::Machine& machine,
                               const plugin::Registry& registry) {
  const Workshop shop(machine, registry);
  const Judge judge(shop);
  std::vector<Ability> out{judge.SequentialParts(),
                           judge.TakeOver(),
                           judge.LongPartEnds(),
                           judge.MoreTools(),
                           judge.TwoToolsAtOnce(),
                           judge.ParallelParts(),
                           judge.ReclampedEnds(),
                           judge.QuickChangeover(),
                           judge.LargerZone()};
  for (std::size_t i = 0; i < out.size(); ++i) out[i].kind = static_cast<AbilityKind>(i);
  return out;
}

}  // namespace kompono::analysis
