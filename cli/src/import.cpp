// SPDX-License-Identifier: Apache-2.0
// kompono import: layouts from other programs' files.
#include "codes.hpp"
#include "files.hpp"
#include "session.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>

#include "kompono/calibration/klipper_delta.hpp"
#include "kompono/calibration/measurements.hpp"

namespace kompono::cli {
namespace {

constexpr const char* kExamples =
    "  kompono import klipper_delta run.csv --layout delta.toml     geometry from run.json\n"
    "  kompono calibrate delta.toml run.csv --published run.json -o calibrated.toml";
constexpr const char* kKlipperExamples =
    "  kompono import klipper_delta run.csv --layout delta.toml     geometry from run.json\n"
    "  kompono import klipper_delta run.csv --geometry printer.json --which published_fit";

struct Options {
  std::string csv, geometry, which = "nominal", layout;
  bool force = false;
};

Diagnostic NotADeltaRun(const std::string& file) {
  return {.code = std::string(codes::kUnknownFormat.code),
          .file = file,
          .message = "no delta run of Klipper",
          .help = "its heading is kind,value_mm,s1_a_mm,..."};
}

/// The layout read back, and the run against it: what is written can be calibrated.
std::optional<std::size_t> CountMeasurements(Session& session,
                                             const std::string& layout_text,
                                             const std::string& csv_text,
                                             const Options& options,
                                             ExitCode& code) {
  const std::string name = options.layout.empty() ? "layout" : options.layout;
  Parsed<layout::Layout> layout = layout::ParseLayout(layout_text, name, session.registry());
  if (!layout) {
    code = session.Refuse(layout.error());
    return std::nullopt;
  }
  const Parsed<kinematics::Machine> machine =
      kinematics::Machine::Build(std::move(*layout), session.registry());
  if (!machine) {
    code = session.Refuse(machine.error());
    return std::nullopt;
  }
  Diagnostics notes;
  const Parsed<calibration::MeasurementSet> set =
      calibration::ParseMeasurements(csv_text, options.csv, *machine, {}, &notes);
  if (!set) {
    notes.insert(notes.end(), set.error().begin(), set.error().end());
    code = session.Refuse(notes);
    return std::nullopt;
  }
  session.console.Report(notes);
  return set->measurements.size();
}

ExitCode Run(Session& session, const Options& options) {
  if (const auto exists = RefuseToOverwrite(options.layout, options.force))
    return session.Refuse(*exists);
  const Parsed<std::string> csv = ReadWhole(options.csv);
  if (!csv) return session.Refuse(csv.error());
  if (!calibration::IsKlipperDelta(*csv)) return session.Refuse(NotADeltaRun(options.csv));
  const std::string json =
      options.geometry.empty()
          ? std::filesystem::path(options.csv).replace_extension(".json").string()
          : options.geometry;
  const Parsed<calibration::KlipperRun> run = calibration::ReadKlipperRun(json);
  if (!run) return session.Refuse(run.error());
  const calibration::KlipperGeometry& geometry =
      options.which == "nominal" ? run->nominal : run->published_fit;
  const std::string text = calibration::KlipperLayout(
      geometry,
      run->machine,
      fmt::format("{} geometry of {} ({})", options.which, run->name, run->source));
  ExitCode code = ExitCode::kOk;
  const auto rows = CountMeasurements(session, text, *csv, options, code);
  if (!rows) return code;
  const std::string next = fmt::format("kompono calibrate {} {} --published {} -o calibrated.toml",
                                       options.layout.empty() ? "LAYOUT" : options.layout,
                                       options.csv,
                                       json);
  if (!options.layout.empty()) {
    if (const auto failure = WriteFileAside(options.layout, text, options.force))
      return session.Refuse(*failure);
    session.console.Say(fmt::format("{} written; {} fit it, continue with\n  {}",
                                    options.layout,
                                    Counted(*rows, "measurement"),
                                    next));
  }
  if (session.json) {
    nlohmann::ordered_json out{{"name", run->name}, {"measurements", *rows}, {"next", next}};
    if (options.layout.empty()) {
      out["text"] = text;
    } else {
      out["file"] = options.layout;
    }
    session.console.Json(std::move(out));
  } else if (options.layout.empty()) {
    session.console.Out(text);
  }
  return ExitCode::kOk;
}

}  // namespace

void AddImport(CLI::App& root, Session& session) {
  CLI::App* import =
      session.Command(root, "import", "Layouts from other programs' files", kExamples);
  import->require_subcommand(0, 1);
  CLI::App* command = session.Command(*import,
                                      "klipper_delta",
                                      "A linear delta whose calibration run Klipper has recorded",
                                      kKlipperExamples);
  const auto options = std::make_shared<Options>();
  session.Hint(
      command->add_option("CSV", options->csv, "Measured heights and distances")->required(),
      ValueHint::Kind::kFile);
  session.Hint(command
                   ->add_option("--geometry",
                                options->geometry,
                                "The run's description; else CSV with .json in place of .csv")
                   ->type_name("JSON"),
               ValueHint::Kind::kFile);
  session.Choices(command->add_option("--which", options->which, "nominal or published_fit")
                      ->type_name("GEOMETRY"),
                  {"nominal", "published_fit"});
  session.Hint(command->add_option("--layout", options->layout, "Layout to write; else stdout")
                   ->type_name("FILE"),
               ValueHint::Kind::kFile);
  command->add_flag("--force", options->force, "Replace the file if it exists");
  session.OnRun(command, [&session, options] { return Run(session, *options); });
  AddImportKlipperConfig(*import, session);
  AddImportTracker(*import, session);
}

}  // namespace kompono::cli
