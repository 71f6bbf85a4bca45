// SPDX-License-Identifier: Apache-2.0
// kompono check: every fault of every file. Plugin code runs for the geometry of layouts whose text
// is good, unless --no-code is given, and for measurements, whose units are judged by what the
// machine predicts.
#include "calibration_files.hpp"
#include "campaign.hpp"
#include "codes.hpp"
#include "files.hpp"
#include "session.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/measurements.hpp"
#include "kompono/plugin/description.hpp"
#include "kompono/synthesis/candidate.hpp"
#include "kompono/synthesis/evaluation.hpp"

namespace kompono::cli {
namespace {

using nlohmann::ordered_json;

constexpr const char* kExamples =
    "  kompono check machine.toml                             a layout\n"
    "  kompono check layouts/machines/*.toml                  all of them, all faults in one run\n"
    "  kompono check --layout machine.toml points.csv         measurements of that machine\n"
    "  kompono check campaign.toml                            a description of measurements, with\n"
    "                                                         its layout and its files\n"
    "  kompono check machine.toml --no-code                   the text only\n"
    "  kompono check plugins/lambda/plugin.toml               a plugin's sidecar";

struct Options {
  std::vector<std::string> files;
  std::string layout;
  bool no_code = false;
};

enum class Kind { kUnknown, kLayout, kStudy, kMeasurements, kCampaign, kSidecar };

std::string_view Name(Kind kind) {
  switch (kind) {
    case Kind::kLayout:
      return "layout";
    case Kind::kStudy:
      return "study";
    case Kind::kMeasurements:
      return "measurements";
    case Kind::kCampaign:
      return "measurement description";
    case Kind::kSidecar:
      return "plugin";
    case Kind::kUnknown:
      break;
  }
  return "unknown";
}

/// Whether a line of `text` begins with `key` and an equals sign.
bool HasKey(std::string_view text, std::string_view key) {
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = Trimmed(text.substr(begin, end - begin));
    if (line.starts_with(key) && Trimmed(line.substr(key.size())).starts_with('=')) return true;
    begin = end + 1;
  }
  return false;
}

Kind KindOf(const std::filesystem::path& file, std::string_view text) {
  if (file.extension() == ".csv") return Kind::kMeasurements;
  if (file.filename() == "plugin.toml") return Kind::kSidecar;
  if (HasKey(text, "study")) return Kind::kStudy;
  if (HasKey(text, "measurements")) return Kind::kCampaign;
  if (file.extension() == ".toml") return Kind::kLayout;
  if (HasKey(text, "contract")) return Kind::kSidecar;
  if (HasKey(text, "formula") || HasKey(text, "kompono")) return Kind::kLayout;
  return Kind::kUnknown;
}

struct Verdict {
  std::string file;
  Kind kind = Kind::kUnknown;
  Diagnostics diagnostics;
  bool readable = true;
  [[nodiscard]] bool ok() const { return !HasErrors(diagnostics); }
};

Diagnostic Problem(const CodeTitle& code,
                   const std::string& file,
                   std::string message,
                   std::string help) {
  return {.code = std::string(code.code),
          .file = file,
          .message = std::move(message),
          .help = std::move(help)};
}

template <class T>
void Take(const Parsed<T>& parsed, Diagnostics& diagnostics) {
  if (!parsed) diagnostics.insert(diagnostics.end(), parsed.error().begin(), parsed.error().end());
}

/// The text, and if that is good what the plugins say of the geometry.
std::optional<kinematics::Machine> JudgeLayout(Session& session,
                                               std::string_view text,
                                               const std::string& file,
                                               bool run_code,
                                               Diagnostics& diagnostics) {
  Parsed<layout::Layout> layout = layout::ParseLayout(text, file, session.registry(), &diagnostics);
  Take(layout, diagnostics);
  if (!layout || !run_code) return std::nullopt;
  Parsed<kinematics::Machine> machine =
      kinematics::Machine::Build(std::move(*layout), session.registry());
  Take(machine, diagnostics);
  if (!machine) return std::nullopt;
  return std::move(*machine);
}

/// The text, the layout that it names, every file with it, and at last the patterns of its fit.
void JudgeCampaign(Session& session, std::string_view text, bool run_code, Verdict& verdict) {
  const Parsed<Campaign> campaign = ReadCampaign(text, verdict.file);
  Take(campaign, verdict.diagnostics);
  if (!campaign) return;
  const Parsed<std::string> layout = ReadWhole(campaign->layout);
  Take(layout, verdict.diagnostics);
  std::optional<kinematics::Machine> machine;
  if (layout) {
    machine = JudgeLayout(session, *layout, campaign->layout, run_code, verdict.diagnostics);
  }
  if (!machine) return;
  const Parsed<MeasurementFiles> files =
      ReadMeasurementFiles(campaign->files, *machine, {}, verdict.diagnostics);
  Take(files, verdict.diagnostics);
  if (!files) return;
  Diagnostics patterns = calibration::JudgeOptions(
      *machine, files->set, {.free = campaign->free, .lock = campaign->lock});
  for (Diagnostic& problem : patterns) {
    problem.file = verdict.file;  // they stand here, not in the layout
    verdict.diagnostics.push_back(std::move(problem));
  }
}

/// The text, then whether its space has layouts and each alternative makes good ones.
void JudgeStudy(Session& session, std::string_view text, Verdict& verdict) {
  Parsed<synthesis::Study> study = synthesis::ParseStudy(
      text, verdict.file, session.registry(), synthesis::MetricNames(), &verdict.diagnostics);
  Take(study, verdict.diagnostics);
  if (study) {
    Take(synthesis::StudySpace::Build(std::move(*study), session.registry(), &verdict.diagnostics),
         verdict.diagnostics);
  }
}

Verdict Judge(Session& session,
              const std::string& file,
              bool run_code,
              const std::optional<kinematics::Machine>& machine) {
  Verdict verdict{.file = file};
  const Parsed<std::string> text = ReadWhole(file);
  if (!text) {
    verdict.readable = false;
    verdict.diagnostics = text.error();
    return verdict;
  }
  verdict.kind = KindOf(file, *text);
  switch (verdict.kind) {
    case Kind::kLayout:
      (void)JudgeLayout(session, *text, file, run_code, verdict.diagnostics);
      break;
    case Kind::kStudy:
      JudgeStudy(session, *text, verdict);
      break;
    case Kind::kSidecar:
      Take(plugin::ParseSidecar(*text, file), verdict.diagnostics);
      break;
    case Kind::kCampaign:
      JudgeCampaign(session, *text, run_code, verdict);
      break;
    case Kind::kMeasurements:
      if (machine) {
        Take(calibration::ParseMeasurements(*text, file, *machine, {}, &verdict.diagnostics),
             verdict.diagnostics);
      } else {
        verdict.diagnostics.push_back(
            Problem(codes::kNeedsLayout,
                    file,
                    "measurements can be judged only with the layout of the machine",
                    "give it with --layout FILE"));
      }
      break;
    case Kind::kUnknown:
      verdict.diagnostics.push_back(
          Problem(codes::kUnknownFormat,
                  file,
                  "neither a layout nor a study nor measurements nor a plugin.toml",
                  "layouts and studies are called *.toml, measurements *.csv"));
      break;
  }
  return verdict;
}

void PrintText(Console& console, const std::vector<Verdict>& verdicts) {
  Diagnostics all;
  for (const Verdict& verdict : verdicts) {
    const auto errors = static_cast<std::size_t>(
        std::count_if(verdict.diagnostics.begin(), verdict.diagnostics.end(), [](const auto& d) {
          return d.severity == Severity::kError;
        }));
    console.Out(fmt::format("{}: {}\n",
                            verdict.file,
                            errors == 0 ? console.Paint("ok", Hue::kGreen)
                                        : console.Paint(Counted(errors, "error"), Hue::kRed)));
    all.insert(all.end(), verdict.diagnostics.begin(), verdict.diagnostics.end());
  }
  console.Report(all);
}

void PrintJson(Console& console, const std::vector<Verdict>& verdicts) {
  ordered_json files = ordered_json::array();
  for (const Verdict& verdict : verdicts) {
    files.push_back({{"file", verdict.file},
                     {"kind", Name(verdict.kind)},
                     {"ok", verdict.ok()},
                     {"diagnostics", ToJson(verdict.diagnostics)}});
  }
  console.Json({{"files", std::move(files)}});
}

ExitCode Run(Session& session, const Options& options) {
  std::optional<kinematics::Machine> machine;
  if (!options.layout.empty()) {
    ExitCode code = ExitCode::kOk;
    machine = session.ReadMachine(options.layout, code);
    if (!machine) return code;
  }
  std::vector<Verdict> verdicts;
  for (const std::string& file : options.files)
    verdicts.push_back(Judge(session, file, !options.no_code, machine));
  if (session.json) {
    PrintJson(session.console, verdicts);
  } else {
    PrintText(session.console, verdicts);
  }
  ExitCode code = ExitCode::kOk;
  for (const Verdict& verdict : verdicts) {
    if (!verdict.readable) return ExitCode::kInputOutput;
    if (!verdict.ok()) code = ExitCode::kNegative;
  }
  return code;
}

}  // namespace

void AddCheck(CLI::App& root, Session& session) {
  CLI::App* command = session.Command(
      root, "check", "Judge layouts, studies, measurement files and plugin sidecars", kExamples);
  const auto options = std::make_shared<Options>();
  session.Hint(
      command->add_option("FILE", options->files, "Layouts, studies, measurements, plugin.toml")
          ->required(),
      ValueHint::Kind::kFile);
  session.Hint(
      command
          ->add_option(
              "--layout", options->layout, "Layout of the machine that the measurements are of")
          ->type_name("FILE"),
      ValueHint::Kind::kFile);
  command->add_flag(
      "--no-code", options->no_code, "Run no plugin code: the geometry of layouts is not judged");
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
