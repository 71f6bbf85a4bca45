// SPDX-License-Identifier: Apache-2.0
#include "freedoms.hpp"

#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

#include "kompono/analysis/freedoms.hpp"

namespace kompono::cli {
namespace {

using nlohmann::ordered_json;

ordered_json FreedomsJson(const std::vector<analysis::BlockFreedoms>& blocks) {
  ordered_json out{{"mechanisms", ordered_json::array()}};
  for (const analysis::BlockFreedoms& block : blocks) {
    ordered_json entry{{"block", block.block},
                       {"module", block.module},
                       {"struts", block.struts},
                       {"length_mm", block.length_mm},
                       {"choices", ordered_json::array()}};
    for (const analysis::FreedomChoice& choice : block.choices) {
      const ordered_json condition =
          std::isfinite(choice.condition) ? ordered_json(choice.condition) : ordered_json(nullptr);
      entry["choices"].push_back({{"letters", choice.letters}, {"condition", condition}});
    }
    out["mechanisms"].push_back(std::move(entry));
  }
  return out;
}

std::string FreedomsText(const analysis::BlockFreedoms& block) {
  if (block.choices.empty()) {
    return fmt::format(
        "{} ({}): not every drive has a strut of its own that ends on the platform\n",
        block.block,
        block.module);
  }
  TextTable table({{"choice"}, {"condition", true}});
  for (const analysis::FreedomChoice& choice : block.choices) {
    table.Row({choice.letters,
               std::isfinite(choice.condition) ? fmt::format("{:.4f}", choice.condition)
                                               : std::string("singular")});
  }
  return fmt::format(
      "{} ({}): which {} of the six motions its {} struts can meet at home; a radian "
      "counts {:.6g} mm\n\n{}",
      block.block,
      block.module,
      block.struts,
      block.struts,
      block.length_mm,
      table.Render());
}

}  // namespace

void PrintFreedoms(Session& session,
                   const kinematics::Machine& machine,
                   std::optional<double> length_mm) {
  const std::vector<analysis::BlockFreedoms> blocks =
      analysis::Freedoms(machine, machine.home(), length_mm);
  if (session.json) return session.console.Json(FreedomsJson(blocks));
  if (blocks.empty()) return session.console.Out("the machine has no parallel mechanism\n");
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    session.console.Out((i > 0 ? "\n" : "") + FreedomsText(blocks[i]));
  }
}

}  // namespace kompono::cli
