// SPDX-License-Identifier: Apache-2.0
// kompono import tracker: points of a laser tracker and the machine's readings as measurements.
#include "files.hpp"
#include "session.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

#include "kompono/calibration/tracker.hpp"

namespace kompono::cli {
namespace {

constexpr const char* kExamples =
    "  kompono import tracker points.txt readings.csv --layout machine.toml -o measured.csv\n"
    "  kompono import tracker points.txt readings.csv --layout machine.toml --align --unit m\n"
    "  kompono calibrate machine.toml measured.csv -o calibrated.toml";

struct Options {
  std::string points, readings, layout, out, unit = "mm";
  double sigma_mm = 0.0;
  bool align = false;
  bool force = false;
};

double MmPerUnit(const std::string& unit) {
  if (unit == "m") return 1000.0;
  return unit == "in" ? 25.4 : 1.0;
}

std::vector<std::string> Comments(const Options& options,
                                  const calibration::TrackerMeasurements& joined) {
  std::vector<std::string> out{
      fmt::format("points of {} at the readings of {}", options.points, options.readings)};
  if (!joined.X_WL) return out;
  out.push_back(fmt::format("aligned with {}, which leaves {:.4f} mm RMS; rows of [R | p]:",
                            options.layout,
                            joined.fit_rms_mm));
  for (int i = 0; i < 3; ++i) {
    const Pose<double>& X = *joined.X_WL;
    out.push_back(
        fmt::format("{:.9f} {:.9f} {:.9f} {:.6f}", X.R(i, 0), X.R(i, 1), X.R(i, 2), X.p[i]));
  }
  return out;
}

ExitCode Run(Session& session, const Options& options) {
  if (const auto exists = RefuseToOverwrite(options.out, options.force))
    return session.Refuse(*exists);
  ExitCode code = ExitCode::kOk;
  const std::optional<kinematics::Machine> machine = session.ReadMachine(options.layout, code);
  if (!machine) return code;
  const Parsed<std::string> text = ReadWhole(options.points);
  if (!text) return session.Refuse(text.error());
  const Parsed<std::string> readings = ReadWhole(options.readings);
  if (!readings) return session.Refuse(readings.error());
  const auto points =
      calibration::ReadTrackerPoints(*text, options.points, MmPerUnit(options.unit));
  if (!points) return session.Refuse(points.error());
  calibration::TrackerOptions join{.sigma_mm = std::nullopt, .align = options.align};
  if (options.sigma_mm > 0.0) join.sigma_mm = options.sigma_mm;
  const auto joined = calibration::JoinTracker(
      *points, options.points, *readings, options.readings, *machine, join);
  if (!joined) return session.Refuse(joined.error());
  session.console.Report(joined->warnings);
  const std::string csv =
      calibration::WriteMeasurements(joined->set, *machine, Comments(options, *joined));
  if (!options.out.empty()) {
    if (const auto failure = WriteFileAside(options.out, csv, options.force))
      return session.Refuse(*failure);
  }
  if (session.json) {
    nlohmann::ordered_json out{{"rows", joined->set.measurements.size()}};
    if (joined->X_WL) out["fit_rms_mm"] = joined->fit_rms_mm;
    out[options.out.empty() ? "csv" : "file"] = options.out.empty() ? csv : options.out;
    session.console.Json(std::move(out));
    return ExitCode::kOk;
  }
  if (options.out.empty()) session.console.Out(csv);
  std::string said = Counted(joined->set.measurements.size(), "point");
  if (joined->X_WL) {
    said += fmt::format(", aligned with the nominal machine, which leaves {:.4f} mm RMS",
                        joined->fit_rms_mm);
  }
  session.console.Say(said);
  return ExitCode::kOk;
}

}  // namespace

void AddImportTracker(CLI::App& import, Session& session) {
  CLI::App* command = session.Command(
      import, "tracker", "Points of a laser tracker as measurements of a machine", kExamples);
  const auto options = std::make_shared<Options>();
  const auto file = [&](const char* name, std::string& value, const char* text) {
    CLI::Option* option = command->add_option(name, value, text)->type_name("FILE");
    session.Hint(option, ValueHint::Kind::kFile);
    return option;
  };
  file("POINTS", options->points, "Lines x y z, or name x y z")->required();
  file("READINGS", options->readings, "CSV with the drives' readings, by line or by name")
      ->required();
  file("--layout", options->layout, "Layout of the machine")->required();
  session.Choices(command->add_option("--unit", options->unit, "Of the points: mm, m or in (mm)")
                      ->type_name("UNIT"),
                  {"mm", "m", "in"});
  command
      ->add_option("--sigma-mm", options->sigma_mm, "Deviation of the tracker; else none is given")
      ->type_name("MM")
      ->check(CLI::PositiveNumber);
  command->add_flag(
      "--align", options->align, "Turn and shift the points to fit the nominal machine best");
  file("-o,--out", options->out, "CSV file to write; else stdout");
  command->add_flag("--force", options->force, "Replace the file if it exists");
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
