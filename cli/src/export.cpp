// SPDX-License-Identifier: Apache-2.0
// kompono export: a layout's control formulas and its drawing, for other programs.
#include "assignments.hpp"
#include "files.hpp"
#include "session.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

#include "kompono/exporting/drawing.hpp"
#include "kompono/exporting/formulas.hpp"
#include "kompono/exporting/mjcf.hpp"

namespace kompono::cli {
namespace {

using kinematics::Machine;

constexpr const char* kExamples =
    "  kompono export machine.toml --to formula                     what each drive must read\n"
    "  kompono export machine.toml --to latex --digits 4            for a paper\n"
    "  kompono export machine.toml --to c -o kinematics.c           for a controller\n"
    "  kompono export machine.toml --to formula --drive struts.q1   one drive only\n"
    "  kompono export machine.toml --to svg -o machine.svg          a drawing of it at home\n"
    "  kompono export machine.toml --to mjcf -o machine.xml         its bodies and joints, for "
    "MuJoCo";

struct Options {
  std::string file, to, out;
  int digits = 6;
  bool no_expand = false;
  std::vector<std::string> drives;
  bool force = false;
};

/// Full names of the drives wanted; complaints about the others.
std::vector<std::string> WantedDrives(const Machine& machine,
                                      const Options& options,
                                      Diagnostics& problems) {
  std::vector<std::string> names;
  for (const kinematics::Drive& drive : machine.drives()) names.push_back(drive.name);
  const NameTable table("drive", names);
  const Argument argument("--drive", options.drives);
  std::vector<bool> taken(names.size(), false);
  std::vector<std::string> out;
  std::size_t begin = 0;
  for (const std::string& word : options.drives) {
    const auto index = table.Find(argument, {.name = word, .name_begin = begin}, taken, problems);
    if (index) out.push_back(names[*index]);
    begin += word.size() + 1;
  }
  return out;
}

std::string Rendered(const exporting::MachineFormulas& formulas,
                     const Machine& machine,
                     const std::string& to,
                     const exporting::FormulaOptions& options) {
  if (to == "latex") return exporting::FormulaLatex(formulas, options);
  if (to == "c") return exporting::FormulaC(formulas, machine);
  return exporting::FormulaText(formulas, options);
}

/// What an export gives: its text and, for formulas, their parts as JSON.
struct Exported {
  std::string text;
  nlohmann::json formulas;
};

Parsed<Exported> Export(const Machine& machine, const Options& options) {
  if (options.to == "svg")
    return Exported{exporting::DrawSvg(machine, machine.home(), machine.nominal()), nullptr};
  if (options.to == "mjcf") {
    Parsed<std::string> model = exporting::Mjcf(machine, machine.nominal());
    if (!model) return tl::unexpected(std::move(model.error()));
    return Exported{std::move(*model), nullptr};
  }
  Diagnostics problems;
  const exporting::FormulaOptions wanted{.digits = options.digits,
                                         .expand = !options.no_expand,
                                         .drives = WantedDrives(machine, options, problems)};
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  const Parsed<exporting::MachineFormulas> formulas = exporting::DriveFormulas(machine, wanted);
  if (!formulas) return tl::unexpected(formulas.error());
  return Exported{Rendered(*formulas, machine, options.to, wanted),
                  exporting::FormulaJson(*formulas, wanted)};
}

ExitCode Run(Session& session, const Options& options) {
  if (const auto exists = RefuseToOverwrite(options.out, options.force))
    return session.Refuse(*exists);
  ExitCode code = ExitCode::kOk;
  const std::optional<Machine> machine = session.ReadMachine(options.file, code);
  if (!machine) return code;
  const Parsed<Exported> exported = Export(*machine, options);
  if (!exported) return session.Refuse(exported.error());
  if (!options.out.empty()) {
    if (const auto failure = WriteFileAside(options.out, exported->text, options.force))
      return session.Refuse(*failure);
    session.console.Say(options.out + " written");
  }
  if (session.json) {
    nlohmann::ordered_json out{{"format", options.to}};
    if (!exported->formulas.is_null()) out["formulas"] = exported->formulas;
    if (options.out.empty()) {
      out["text"] = exported->text;
    } else {
      out["file"] = options.out;
    }
    session.console.Json(std::move(out));
  } else if (options.out.empty()) {
    session.console.Out(exported->text);
  }
  return ExitCode::kOk;
}

}  // namespace

void AddExport(CLI::App& root, Session& session) {
  CLI::App* command = session.Command(
      root, "export", "Control formulas or a drawing of a layout for other programs", kExamples);
  const auto options = std::make_shared<Options>();
  session.Hint(command->add_option("FILE", options->file, "Layout")->required(),
               ValueHint::Kind::kFile);
  session.Choices(command->add_option("--to", options->to, "formula, latex, c, svg or mjcf")
                      ->type_name("FORMAT")
                      ->required(),
                  {"formula", "latex", "c", "svg", "mjcf"});
  command->add_option("--digits", options->digits, "Significant digits in formula and latex (6)")
      ->type_name("N")
      ->check(CLI::Range(1, 17));
  command->add_flag("--no-expand", options->no_expand, "Leave polynomials as they were recorded");
  command->add_option("--drive", options->drives, "This drive only; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  session.Hint(command->add_option("-o,--out", options->out, "File to write; else stdout")
                   ->type_name("FILE"),
               ValueHint::Kind::kFile);
  command->add_flag("--force", options->force, "Replace the file if it exists");
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
