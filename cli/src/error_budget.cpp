// SPDX-License-Identifier: Apache-2.0
// kompono error-budget: what small errors of the elements do at the tool.
#include "kompono/calibration/error_budget.hpp"

#include "patterns.hpp"
#include "session.hpp"
#include "text.hpp"
#include "zone.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace kompono::cli {
namespace {

using kinematics::Machine;
using nlohmann::ordered_json;

constexpr const char* kExamples =
    "  kompono error-budget machine.toml\n"
    "  kompono error-budget machine.toml --sigma 'open_base.x=0.3,open_base.y=0.3' --mass 4\n"
    "  kompono error-budget machine.toml --mass 2.8 --direction X --region drive.Y=200:800\n"
    "  kompono error-budget machine.toml --true real.toml          the known errors of one machine";

struct Options {
  std::string file, truth;
  std::vector<std::string> sigma, region;
  int poses = calibration::BudgetOptions{}.poses;
  int samples = calibration::BudgetOptions{}.samples;
  std::uint64_t seed = 1;
  double mass_kg = 0.0;
  std::optional<double> acceleration;
  std::string direction;
};

constexpr std::size_t kMostShown = 20;

std::string Length(double mm) {
  return fmt::format("{:.4f}", mm);
}

std::string BudgetText(const calibration::Budget& budget) {
  TextTable table(
      {{"element"}, {"part"}, {"error", true}, {""}, {"RMS mm", true}, {"max mm", true}});
  std::size_t shown = 0;
  for (const calibration::Contribution& c : budget.contributions) {
    if (++shown > kMostShown) break;
    table.Row({c.name,
               std::string(calibration::Name(c.part)),
               fmt::format("{:.4g}", Outward(c.sigma, c.angle)),
               std::string(UnitOf(c.angle)),
               Length(c.rms_mm),
               Length(c.max_mm)});
  }
  std::string text = "errors at the tool point over the work zone\n" + table.Render();
  if (budget.contributions.size() > kMostShown) {
    text += fmt::format("  and {} smaller ones\n", budget.contributions.size() - kMostShown);
  }
  text +=
      fmt::format("  base and part (SO's db) {} mm, mechanism's geometry {} mm, tool (dn) {} mm\n",
                  Length(budget.part_mm[0]),
                  Length(budget.part_mm[1]),
                  Length(budget.part_mm[2]));
  if (budget.dynamic_mm > 0.0) {
    text += fmt::format("  dynamic error {} mm RMS, {} to {} mm; mechanism with it (dm) {} mm\n",
                        Length(budget.dynamic_mm),
                        Length(budget.dynamic_least_mm),
                        Length(budget.dynamic_most_mm),
                        Length(budget.mechanism_mm));
  }
  text += fmt::format("  geometry: first order {} mm, Monte Carlo {} mm\n",
                      Length(budget.geometry_mm),
                      Length(budget.monte_carlo_mm));
  return text + fmt::format("  in all, root of squares: {} mm\n", Length(budget.total_mm));
}

ordered_json BudgetJson(const calibration::Budget& budget) {
  ordered_json out{{"base_mm", budget.part_mm[0]},
                   {"mechanism_geometry_mm", budget.part_mm[1]},
                   {"tool_mm", budget.part_mm[2]},
                   {"dynamic_mm", budget.dynamic_mm},
                   {"dynamic_least_mm", budget.dynamic_least_mm},
                   {"dynamic_most_mm", budget.dynamic_most_mm},
                   {"mechanism_mm", budget.mechanism_mm},
                   {"geometry_mm", budget.geometry_mm},
                   {"monte_carlo_mm", budget.monte_carlo_mm},
                   {"total_mm", budget.total_mm},
                   {"contributions", ordered_json::array()}};
  for (const calibration::Contribution& c : budget.contributions) {
    out["contributions"].push_back({{"name", c.name},
                                    {"part", calibration::Name(c.part)},
                                    {c.angle ? "error_deg" : "error_mm", Outward(c.sigma, c.angle)},
                                    {"rms_mm", c.rms_mm},
                                    {"max_mm", c.max_mm}});
  }
  return out;
}

ExitCode Run(Session& session, const Options& options) {
  ExitCode code = ExitCode::kOk;
  const std::optional<Machine> machine = session.ReadMachine(options.file, code);
  if (!machine) return code;
  Diagnostics problems;
  calibration::BudgetOptions budget_options;
  budget_options.poses = options.poses;
  budget_options.samples = options.samples;
  budget_options.seed = options.seed;
  budget_options.mass_kg = options.mass_kg;
  budget_options.acceleration = options.acceleration;
  if (!options.direction.empty()) {
    budget_options.direction = Eigen::Vector3d::Unit(options.direction[0] - 'X');
  }
  budget_options.region = ReadRegion(options.region, *machine, problems);
  if (!options.sigma.empty()) {
    budget_options.sigma = ReadPatternNumbers(Argument("--sigma", options.sigma),
                                              *machine,
                                              FormsOf(*machine, session.registry()),
                                              problems);
  }
  if (!options.truth.empty()) {
    const std::optional<Machine> truth = session.ReadMachine(options.truth, code);
    if (!truth) return code;
    if (truth->parameters().size() != machine->parameters().size()) {
      problems.push_back({.code = "E0443",
                          .file = options.truth,
                          .message = "the true machine has other numbers than the nominal one"});
    } else {
      budget_options.change = truth->nominal() - machine->nominal();
    }
  }
  if (!problems.empty()) return session.Refuse(problems);
  const Parsed<calibration::Budget> budget = calibration::ErrorBudget(*machine, budget_options);
  if (!budget) return session.Refuse(budget.error());
  if (session.json) {
    session.console.Json(BudgetJson(*budget));
  } else {
    session.console.Out(BudgetText(*budget));
  }
  return ExitCode::kOk;
}

}  // namespace

void AddErrorBudget(CLI::App& root, Session& session) {
  CLI::App* command = session.Command(
      root, "error-budget", "What small errors of the elements do at the tool", kExamples);
  const auto options = std::make_shared<Options>();
  session.Hint(command->add_option("LAYOUT", options->file, "Layout of the machine")->required(),
               ValueHint::Kind::kFile);
  command
      ->add_option(
          "--sigma", options->sigma, "Deviations over the manufacturing tolerances, mm or deg")
      ->type_name("PATTERN=..,")
      ->allow_extra_args(false);
  session.Hint(
      command
          ->add_option("--true",
                       options->truth,
                       "Layout of the real machine: its known errors instead of deviations")
          ->type_name("FILE"),
      ValueHint::Kind::kFile);
  command->add_option("--region", options->region, "Ranges of virtual coordinates")
      ->type_name("NAME=LO:HI,")
      ->allow_extra_args(false);
  command->add_option("--poses", options->poses, "Poses over the work zone (200)")
      ->type_name("N")
      ->check(CLI::Range(1, 100000));
  command->add_option("--samples", options->samples, "Machines of the Monte Carlo check (500)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000));
  command->add_option("--seed", options->seed, "Of poses and samples (1)")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--mass", options->mass_kg, "Moved mass: adds the dynamic error (0)")
      ->type_name("KG")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--acceleration",
                   options->acceleration,
                   "Of the moved mass; else the slowest drive's in the layout")
      ->type_name("MM/S2")
      ->check(CLI::PositiveNumber);
  session.Choices(command
                      ->add_option("--direction",
                                   options->direction,
                                   "Of the acceleration, X, Y or Z; else the worst everywhere")
                      ->type_name("LETTER"),
                  {"X", "Y", "Z"});
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
