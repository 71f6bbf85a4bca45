// SPDX-License-Identifier: Apache-2.0
// kompono import klipper_config: a linear delta and its probings from Klipper's printer.cfg.
#include "files.hpp"
#include "session.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>

#include "kompono/calibration/klipper_config.hpp"
#include "kompono/calibration/klipper_delta.hpp"

namespace kompono::cli {
namespace {

constexpr const char* kExamples =
    "  kompono import klipper_config printer.cfg --layout delta.toml --run run.csv\n"
    "  kompono calibrate delta.toml run.csv --folds 8 -o calibrated.toml";

struct Options {
  std::string config, layout, run;
  bool force = false;
};

ExitCode Run(Session& session, const Options& options) {
  for (const std::string& file : {options.layout, options.run}) {
    if (const auto exists = RefuseToOverwrite(file, options.force)) return session.Refuse(*exists);
  }
  const Parsed<std::string> text = ReadWhole(options.config);
  if (!text) return session.Refuse(text.error());
  const Parsed<calibration::KlipperConfig> config =
      calibration::ReadKlipperConfig(*text, options.config);
  if (!config) return session.Refuse(config.error());
  const std::string layout =
      calibration::KlipperLayout(config->geometry,
                                 std::filesystem::path(options.config).stem().string(),
                                 fmt::format("Linear delta from {}", options.config));
  if (!options.run.empty() && config->run_csv.empty()) {
    return session.Refuse(
        Diagnostic{.code = "E0402",
                   .file = options.config,
                   .message = "the file has no probings, so that there is no run to write",
                   .help = "run DELTA_CALIBRATE and SAVE_CONFIG on the printer; they stand in "
                           "[delta_calibrate]"});
  }
  nlohmann::ordered_json out{{"heights", config->heights}, {"distances", config->distances}};
  const auto give = [&](const std::string& file, const char* what, const std::string& content) {
    if (file.empty()) {
      out[what] = content;
      return std::optional<ExitCode>();
    }
    if (const auto failure = WriteFileAside(file, content, options.force)) {
      return std::optional(session.Refuse(*failure));
    }
    out[fmt::format("{}_file", what)] = file;
    session.console.Say(file + " written");
    return std::optional<ExitCode>();
  };
  if (const auto failed = give(options.layout, "layout", layout)) return *failed;
  if (const auto failed = give(options.run, "run", config->run_csv)) return *failed;
  if (session.json) {
    session.console.Json(std::move(out));
    return ExitCode::kOk;
  }
  if (options.layout.empty()) session.console.Out(layout);
  session.console.Say(
      fmt::format("{} and {} probed",
                  Counted(static_cast<std::size_t>(config->heights), "height"),
                  Counted(static_cast<std::size_t>(config->distances), "distance")));
  return ExitCode::kOk;
}

}  // namespace

void AddImportKlipperConfig(CLI::App& import, Session& session) {
  CLI::App* command = session.Command(import,
                                      "klipper_config",
                                      "A linear delta and its probings from Klipper's printer.cfg",
                                      kExamples);
  const auto options = std::make_shared<Options>();
  session.Hint(
      command
          ->add_option("CONFIG", options->config, "printer.cfg, with what SAVE_CONFIG put into it")
          ->required(),
      ValueHint::Kind::kFile);
  session.Hint(command->add_option("--layout", options->layout, "Layout to write; else stdout")
                   ->type_name("FILE"),
               ValueHint::Kind::kFile);
  session.Hint(
      command->add_option("--run", options->run, "Delta run to write, for kompono calibrate")
          ->type_name("CSV"),
      ValueHint::Kind::kFile);
  command->add_flag("--force", options->force, "Replace files that exist");
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
