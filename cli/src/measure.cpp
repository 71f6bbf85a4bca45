// SPDX-License-Identifier: Apache-2.0
// kompono measure: measurements of a machine that exists only as numbers.
#include "files.hpp"
#include "patterns.hpp"
#include "session.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <memory>

#include "kompono/calibration/measurements.hpp"
#include "kompono/calibration/simulation.hpp"

namespace kompono::cli {
namespace {

using calibration::MeasurementKind;
using kinematics::Machine;

constexpr const char* kExamples =
    "  kompono measure machine.toml --set open_base.x=500.8 --points 60 -o points.csv\n"
    "  kompono measure machine.toml --true real.toml --kind pose --sigma-mm 0.005 -o poses.csv\n"
    "  kompono measure machine.toml --as-made 7 --region drive.X=200:800 --held-out 0.3 -o p.csv";

struct Options {
  std::string file, truth, out;
  std::vector<std::string> set, change, region;
  std::optional<std::uint64_t> as_made;
  int points = 60;
  std::string kind = "position";
  std::string components = "xyz";
  double sigma_mm = 0.0, sigma_deg = 0.0;
  std::uint64_t seed = 1;
  double held_out = 0.0;
  bool held_out_exact = false;
  bool force = false;
};

MeasurementKind KindOf(const std::string& word) {
  for (const MeasurementKind kind : {MeasurementKind::kHeight,
                                     MeasurementKind::kDistance,
                                     MeasurementKind::kPosition,
                                     MeasurementKind::kPose,
                                     MeasurementKind::kRelative}) {
    if (calibration::Name(kind) == word) return kind;
  }
  return MeasurementKind::kPosition;  // the parser lets no other word through
}

/// θ of the machine that is measured.
Eigen::VectorXd TrueGeometry(const Machine& truth,
                             const plugin::Registry& registry,
                             const Options& options,
                             Diagnostics& problems) {
  Eigen::VectorXd theta = options.as_made
                              ? calibration::ManufacturedGeometry(truth, *options.as_made)
                              : truth.nominal();
  const GeometryForms forms = FormsOf(truth, registry);
  if (!options.set.empty()) {
    const auto numbers = ReadNumbers(
        Argument("--set", options.set), NameTable("number of the geometry", forms), problems);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i])
        theta[static_cast<Eigen::Index>(i)] = Inward(*numbers[i], truth.parameters()[i].angle);
    }
  }
  if (!options.change.empty()) {
    const auto changes =
        ReadPatternNumbers(Argument("--change", options.change), truth, forms, problems);
    const Parsed<Eigen::VectorXd> changed = calibration::ChangedGeometry(truth, changes);
    if (changed) {
      theta += *changed - truth.nominal();
    } else if (problems.empty()) {
      problems = changed.error();
    }
  }
  return theta;
}

calibration::SimulateOptions SimulationOf(const Machine& machine,
                                          const Options& options,
                                          Diagnostics& problems) {
  calibration::SimulateOptions out;
  out.held_out = static_cast<int>(std::lround(options.held_out * options.points));
  out.count = options.points - out.held_out;
  out.seed = options.seed;
  out.kind = KindOf(options.kind);
  for (std::size_t k = 0; k < 3; ++k)
    out.components[k] = options.components.find("xyz"[k]) != std::string::npos;
  out.sigma_mm = options.sigma_mm;
  out.sigma_rad = options.sigma_deg / kDegPerRad;
  out.held_out_without_noise = options.held_out_exact;
  if (options.region.empty()) return out;
  std::vector<std::string> names;
  for (const kinematics::Coordinate& coordinate : machine.coordinates())
    names.push_back(coordinate.name);
  const NameTable table("coordinate", names);
  const Argument argument("--region", options.region);
  std::vector<bool> taken(names.size(), false);
  for (const Assignment& assignment : argument.Split(problems)) {
    const auto index = table.Find(argument, assignment, taken, problems);
    const auto range = argument.Range(assignment, problems);
    if (!index || !range) continue;
    const bool angle = machine.coordinates()[*index].rotary;
    out.region[names[*index]] = {Inward(range->lower, angle), Inward(range->upper, angle)};
  }
  return out;
}

std::vector<std::string> Comments(const Options& options) {
  std::vector<std::string> out{
      fmt::format("simulated by kompono {} from {}", KOMPONO_PROGRAM_VERSION, options.file)};
  if (!options.truth.empty()) out.push_back("true machine: " + options.truth);
  if (options.as_made) out.push_back(fmt::format("as made, seed {}", *options.as_made));
  for (const std::string& word : options.set) out.push_back("set " + word);
  for (const std::string& word : options.change) out.push_back("changed by " + word);
  out.push_back(fmt::format("noise {} mm, {} deg, seed {}",
                            Brief(options.sigma_mm),
                            Brief(options.sigma_deg),
                            options.seed));
  return out;
}

ExitCode Run(Session& session, const Options& options) {
  if (const auto exists = RefuseToOverwrite(options.out, options.force))
    return session.Refuse(*exists);
  ExitCode code = ExitCode::kOk;
  const std::optional<Machine> nominal = session.ReadMachine(options.file, code);
  if (!nominal) return code;
  std::optional<Machine> truth = nominal;
  if (!options.truth.empty()) truth = session.ReadMachine(options.truth, code);
  if (!truth) return code;
  Diagnostics problems;
  const Eigen::VectorXd theta = TrueGeometry(*truth, session.registry(), options, problems);
  const calibration::SimulateOptions simulation = SimulationOf(*nominal, options, problems);
  if (!problems.empty()) return session.Refuse(problems);
  const Parsed<calibration::MeasurementSet> set =
      calibration::Simulate(*nominal, *truth, theta, simulation);
  if (!set) return session.Refuse(set.error());
  const std::string text = calibration::WriteMeasurements(*set, *nominal, Comments(options));
  if (!options.out.empty()) {
    if (const auto failure = WriteFileAside(options.out, text, options.force))
      return session.Refuse(*failure);
  }
  if (session.json) {
    nlohmann::ordered_json out{
        {"kind", options.kind}, {"rows", set->measurements.size()}, {"held_out", set->Count(true)}};
    if (options.out.empty()) {
      out["csv"] = text;
    } else {
      out["file"] = options.out;
    }
    session.console.Json(std::move(out));
  } else if (options.out.empty()) {
    session.console.Out(text);
  } else {
    session.console.Say(
        fmt::format("{}: {}", options.out, Counted(set->measurements.size(), "row")));
  }
  return ExitCode::kOk;
}

void AddTruthOptions(CLI::App& command, Session& session, Options& options) {
  session.Hint(
      command.add_option("--true", options.truth, "Layout of the real machine; else FILE itself")
          ->type_name("FILE"),
      ValueHint::Kind::kFile);
  command
      .add_option("--set",
                  options.set,
                  "Real value of a number of the geometry, mm or deg; may be repeated")
      ->type_name("NAME=..,")
      ->allow_extra_args(false);
  command
      .add_option("--change", options.change, "By how much numbers are really off; patterns with *")
      ->type_name("PATTERN=..,")
      ->allow_extra_args(false);
  command
      .add_option("--as-made",
                  options.as_made,
                  "All numbers with a tolerance off by a random part of it; any whole number")
      ->type_name("SEED")
      ->check(CLI::NonNegativeNumber);
}

void AddInstrumentOptions(CLI::App& command, Session& session, Options& options) {
  command.add_option("--points", options.points, "How many rows (60)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000));
  session.Choices(
      command.add_option("--kind", options.kind, "position, pose, height, distance or relative")
          ->type_name("KIND"),
      {"position", "pose", "height", "distance", "relative"});
  session.Choices(
      command.add_option("--components", options.components, "Of a position: xyz, xy, z")
          ->type_name("XYZ"),
      {"xyz", "xy", "xz", "yz", "x", "y", "z"});
  command.add_option("--sigma-mm", options.sigma_mm, "Noise on each length (0)")
      ->type_name("MM")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--sigma-deg", options.sigma_deg, "Noise on each angle of a pose (0)")
      ->type_name("DEG")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--seed", options.seed, "Of the random poses and the noise (1)")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command
      .add_option("--region", options.region, "Ranges of virtual coordinates to draw poses from")
      ->type_name("NAME=LO:HI,")
      ->allow_extra_args(false);
  command.add_option("--held-out", options.held_out, "Share of the rows marked as held out (0)")
      ->type_name("FRACTION")
      ->check(CLI::Range(0.0, 0.99));
  command.add_flag("--held-out-exact", options.held_out_exact, "No noise on the held-out rows");
}

}  // namespace

void AddMeasure(CLI::App& root, Session& session) {
  CLI::App* command =
      session.Command(root, "measure", "Simulated measurements of a machine", kExamples);
  const auto options = std::make_shared<Options>();
  session.Hint(
      command->add_option("FILE", options->file, "Layout that the control believes in")->required(),
      ValueHint::Kind::kFile);
  AddTruthOptions(*command, session, *options);
  AddInstrumentOptions(*command, session, *options);
  session.Hint(command->add_option("-o,--out", options->out, "CSV file to write; else stdout")
                   ->type_name("FILE"),
               ValueHint::Kind::kFile);
  command->add_flag("--force", options->force, "Replace the file if it exists");
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
