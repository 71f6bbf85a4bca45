// SPDX-License-Identifier: Apache-2.0
#include "help.hpp"
#include "session.hpp"
#include "usage.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include <CLI/CLI.hpp>

#include "kompono/plugin/abi.h"

namespace kompono::cli {
namespace {

constexpr const char* kExamples =
    "  kompono solve machine.toml --pose X=10,Y=20,Z=300    drives for a tool pose\n"
    "  kompono check layouts/machines/*.toml                every fault of every file\n"
    "  kompono formula 'part_xy (XY):drive O|O Z P_z'       a machine as a line of letters\n"
    "  kompono calibrate machine.toml points.csv -o calibrated.toml";

std::string Version() {
  return fmt::format("kompono {} (plugin contract {}.{})",
                     KOMPONO_PROGRAM_VERSION,
                     KOMPONO_CONTRACT_MAJOR,
                     KOMPONO_CONTRACT_MINOR);
}

void AddCommonOptions(CLI::App& root, Session& session, bool& version) {
  root.set_help_flag("-h,--help", "This text");
  root.add_flag("--version", version, "Version of the program and of the plugin contract");
  root.add_flag("--json", session.json, "Data and diagnostics as one JSON document on stdout");
  session.Choices(
      root.add_option(
              "--color", session.color, "auto (on a terminal, without NO_COLOR), always or never")
          ->type_name("WHEN"),
      {"auto", "always", "never"});
  session.Hint(root.add_option("--plugin-dir",
                               session.plugin_dirs,
                               "Look for plugins here first; may be repeated, see also "
                               "KOMPONO_PLUGIN_PATH")
                   ->type_name("DIR")
                   ->allow_extra_args(false),
               ValueHint::Kind::kFolder);
}

ColorChoice ColorOf(const std::string& word) {
  return word == "always"  ? ColorChoice::kAlways
         : word == "never" ? ColorChoice::kNever
                           : ColorChoice::kAuto;
}

/// --json and --color count for complaints about the command line too, before it is understood.
void LookAhead(int argc, char** argv, Session& session) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--json") session.json = true;
    if (word.starts_with("--color=")) session.color = word.substr(8);
    if (word == "--color" && i + 1 < argc) session.color = argv[i + 1];
  }
  session.console.Configure(ColorOf(session.color), session.json);
}

ExitCode RunCommand(const CLI::App& root, Session& session, bool version) {
  if (version) {
    if (session.json) {
      session.console.Json(
          {{"version", KOMPONO_PROGRAM_VERSION},
           {"contract", fmt::format("{}.{}", KOMPONO_CONTRACT_MAJOR, KOMPONO_CONTRACT_MINOR)}});
    } else {
      session.console.Out(Version() + "\n");
    }
    return ExitCode::kOk;
  }
  const Session::Run* run = session.RunOf(DeepestCommand(root));
  if (run == nullptr) return session.Refuse(UsageProblems(root, nullptr));
  return (*run)();
}

ExitCode Main(int argc, char** argv, Session& session) {
  CLI::App root("Composes machine tools out of mechanism plugins.", "kompono");
  root.formatter(std::make_shared<HelpFormatter>());
  root.footer(kExamples);
  root.fallthrough();
  root.require_subcommand(0, 1);
  bool version = false;
  AddCommonOptions(root, session, version);
  for (const auto add : {AddPlugins,
                         AddFormula,
                         AddCheck,
                         AddSchema,
                         AddDescribe,
                         AddSolve,
                         AddAnalyze,
                         AddSynthesize,
                         AddMeasure,
                         AddCalibrate,
                         AddErrorBudget,
                         AddCompensate,
                         AddImport,
                         AddExport,
                         AddCatalog,
                         AddCompletion}) {
    add(root, session);
  }
  LookAhead(argc, argv, session);
  if (argc < 2) {
    session.console.Say(ShortHelp(root));
    return ExitCode::kUsage;
  }
  try {
    root.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    session.console.Out(root.help());
    return ExitCode::kOk;
  } catch (const CLI::ParseError& error) {
    return session.Refuse(UsageProblems(root, &error));
  }
  session.console.Configure(ColorOf(session.color), session.json);
  return RunCommand(root, session, version);
}

}  // namespace
}  // namespace kompono::cli

int main(int argc, char** argv) {
  using kompono::cli::ExitCode;
  // A reader that goes away is noticed by the write that fails.
  std::signal(SIGPIPE, SIG_IGN);
  kompono::cli::Session session;
  ExitCode code = ExitCode::kInternal;
  try {
    code = kompono::cli::Main(argc, argv, session);
  } catch (const std::exception& error) {
    std::fprintf(
        stderr, "error: %s\nThis is a fault of kompono, please report it.\n", error.what());
  } catch (...) {
    std::fprintf(stderr, "error: unknown\nThis is a fault of kompono, please report it.\n");
  }
  return static_cast<int>(session.console.Finish(code));
}
