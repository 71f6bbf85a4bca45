// SPDX-License-Identifier: Apache-2.0
// kompono calibrate plan: where to measure.
#include "files.hpp"
#include "patterns.hpp"
#include "pose_limits.hpp"
#include "session.hpp"
#include "text.hpp"
#include "zone.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

#include "kompono/calibration/planning.hpp"

namespace kompono::cli {
namespace {

using calibration::MeasurementKind;
using kinematics::Machine;
using nlohmann::ordered_json;

constexpr const char* kExamples =
    "  kompono calibrate plan machine.toml --points 20 --kind pose --sigma-mm 0.005 -o plan.csv\n"
    "  kompono calibrate plan machine.toml --points 30 --kind position --criterion d\n"
    "  kompono calibrate plan machine.toml --strut-diameter 40 --joint 'struts.base*=30' -o "
    "plan.csv";

struct Options {
  std::string file, out, kind = "position", criterion = "tool";
  std::vector<std::string> free, lock, region;
  PoseLimitOptions limits;
  double least_margin = calibration::PlanOptions{}.least_margin;
  int points = 20, candidates = calibration::PlanOptions{}.candidates;
  double sigma_mm = 0.01, sigma_deg = 0.00057;
  std::uint64_t seed = 1;
  bool force = false;
};

MeasurementKind KindOf(const std::string& word) {
  for (const MeasurementKind kind : {MeasurementKind::kHeight,
                                     MeasurementKind::kDistance,
                                     MeasurementKind::kPose,
                                     MeasurementKind::kRelative}) {
    if (calibration::Name(kind) == word) return kind;
  }
  return MeasurementKind::kPosition;  // the parser lets no other word through
}

std::string Micrometres(double mm) {
  return std::isfinite(mm) ? fmt::format("{:.2f} um", 1e3 * mm) : std::string("not determined");
}

std::string PlanText(const calibration::Plan& plan) {
  std::string text = fmt::format(
      "{} rows for {} free numbers, rank {}\n", plan.set.measurements.size(), plan.free, plan.rank);
  if (plan.near_singular + plan.obstructed > 0) {
    text += fmt::format(
        "of {} poses drawn {} were too near a singularity, and in {} a joint swings too far or "
        "struts touch\n",
        plan.drawn,
        plan.near_singular,
        plan.obstructed);
  }
  TextTable table({{"rows", true}, {"expected deviation of the tool point", true}});
  const std::size_t step = std::max<std::size_t>(1, plan.tool_sigma_mm.size() / 10);
  for (std::size_t i = 0; i < plan.tool_sigma_mm.size(); ++i) {
    const bool last = i + 1 == plan.tool_sigma_mm.size();
    if ((i + 1) % step != 0 && !last) continue;
    table.Row({fmt::format("{}", i + 1), Micrometres(plan.tool_sigma_mm[i])});
  }
  text += table.Render();
  const double random = plan.random_tool_sigma_mm;
  text += fmt::format("  median of 200 random sets of as many rows: {}", Micrometres(random));
  if (std::isfinite(random)) {
    text += fmt::format(", {:.2f} times the chosen ones", random / plan.tool_sigma_mm.back());
  }
  return text + "\n";
}

ordered_json PlanJson(const calibration::Plan& plan) {
  ordered_json sigmas = ordered_json::array();
  for (const double sigma : plan.tool_sigma_mm) {
    sigmas.push_back(std::isfinite(sigma) ? ordered_json(sigma) : ordered_json(nullptr));
  }
  return {{"rows", plan.set.measurements.size()},
          {"free_parameters", plan.free},
          {"rank", plan.rank},
          {"poses_drawn", plan.drawn},
          {"near_singular", plan.near_singular},
          {"obstructed", plan.obstructed},
          {"tool_sigma_mm", sigmas},
          {"random_tool_sigma_mm",
           std::isfinite(plan.random_tool_sigma_mm) ? ordered_json(plan.random_tool_sigma_mm)
                                                    : ordered_json(nullptr)}};
}

ExitCode Run(Session& session, const Options& options) {
  if (const auto exists = RefuseToOverwrite(options.out, options.force))
    return session.Refuse(*exists);
  ExitCode code = ExitCode::kOk;
  const std::optional<Machine> machine = session.ReadMachine(options.file, code);
  if (!machine) return code;
  Diagnostics problems;
  calibration::PlanOptions plan_options;
  plan_options.points = options.points;
  plan_options.candidates = std::max(options.candidates, 4 * options.points);
  plan_options.criterion = options.criterion == "d" ? calibration::PlanCriterion::kDOptimal
                                                    : calibration::PlanCriterion::kToolError;
  plan_options.instrument.kind = KindOf(options.kind);
  plan_options.instrument.sigma_mm = options.sigma_mm;
  plan_options.instrument.sigma_rad = options.sigma_deg / kDegPerRad;
  plan_options.instrument.seed = options.seed;
  plan_options.instrument.region = ReadRegion(options.region, *machine, problems);
  plan_options.least_margin = options.least_margin;
  plan_options.limits = ReadPoseLimits(options.limits, problems);
  plan_options.identify.free = SplitWords(options.free);
  plan_options.identify.lock = SplitWords(options.lock);
  if (!problems.empty()) return session.Refuse(problems);
  const Parsed<calibration::Plan> plan = calibration::PlanMeasurements(*machine, plan_options);
  if (!plan) return session.Refuse(plan.error());
  const std::string csv = calibration::WriteMeasurements(
      plan->set,
      *machine,
      {"planned: readings to go to; the measured columns are what the nominal machine predicts"});
  if (!options.out.empty()) {
    if (const auto failure = WriteFileAside(options.out, csv, options.force))
      return session.Refuse(*failure);
  }
  if (session.json) {
    ordered_json out = PlanJson(*plan);
    if (options.out.empty()) {
      out["csv"] = csv;
    } else {
      out["file"] = options.out;
    }
    session.console.Json(std::move(out));
  } else {
    session.console.Out(PlanText(*plan));
    if (options.out.empty()) {
      session.console.Out("\n" + csv);
    } else {
      session.console.Say(options.out + " written");
    }
  }
  return ExitCode::kOk;
}

}  // namespace

void AddCalibratePlan(CLI::App& calibrate, Session& session) {
  CLI::App* command = session.Command(
      calibrate, "plan", "Chooses where to measure, and says what to expect", kExamples);
  const auto options = std::make_shared<Options>();
  session.Hint(command->add_option("LAYOUT", options->file, "Layout of the machine")->required(),
               ValueHint::Kind::kFile);
  command->add_option("--points", options->points, "How many rows (20)")
      ->type_name("N")
      ->check(CLI::Range(1, 2000));
  command->add_option("--candidates", options->candidates, "Poses to choose from (600)")
      ->type_name("N")
      ->check(CLI::Range(10, 20000));
  session.Choices(
      command
          ->add_option(
              "--kind", options->kind, "position, pose, height, distance or relative (position)")
          ->type_name("KIND"),
      {"position", "pose", "height", "distance", "relative"});
  session.Choices(command
                      ->add_option("--criterion",
                                   options->criterion,
                                   "tool: smallest error of the tool point; d: D-optimal (tool)")
                      ->type_name("WHAT"),
                  {"tool", "d"});
  command->add_option("--sigma-mm", options->sigma_mm, "Deviation of each length (0.01)")
      ->type_name("MM")
      ->check(CLI::PositiveNumber);
  command->add_option("--sigma-deg", options->sigma_deg, "Deviation of each angle (0.00057)")
      ->type_name("DEG")
      ->check(CLI::PositiveNumber);
  command->add_option("--free", options->free, "What will be identified; else as the layout says")
      ->type_name("PATTERN,..")
      ->allow_extra_args(false);
  command->add_option("--lock", options->lock, "What will not")
      ->type_name("PATTERN,..")
      ->allow_extra_args(false);
  command->add_option("--region", options->region, "Ranges of virtual coordinates to measure in")
      ->type_name("NAME=LO:HI,")
      ->allow_extra_args(false);
  AddPoseLimits(*command, options->limits);
  command
      ->add_option("--least-margin",
                   options->least_margin,
                   "Singularity margin that every pose keeps (0.02)")
      ->type_name("MARGIN")
      ->check(CLI::Range(0.0, 1.0));
  command->add_option("--seed", options->seed, "Of the candidates (1)")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  session.Hint(command->add_option("-o,--out", options->out, "CSV file to write; else stdout")
                   ->type_name("FILE"),
               ValueHint::Kind::kFile);
  command->add_flag("--force", options->force, "Replace the file if it exists");
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
