// SPDX-License-Identifier: Apache-2.0
// kompono solve: tool pose -> drives, drives -> tool pose, for one pose or a table of them.
#include "assembly_modes.hpp"
#include "assignments.hpp"
#include "session.hpp"
#include "solve_table.hpp"
#include "solving.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>

namespace kompono::cli {
namespace {

using kinematics::Machine;

constexpr const char* kExamples =
    "  kompono solve machine.toml --pose X=600,Y=450,Z=-50               drives for a tool pose\n"
    "  kompono solve machine.toml --drives drive.q1=100,q2=900,Z=20      where the tool then is\n"
    "  kompono solve machine.toml --drives q1=100,q2=900,Z=20 --all      every way it can stand\n"
    "  kompono solve machine.toml --pose X=1,Y=2,Z=3,A=5 --json          everything, for programs\n"
    "  kompono solve machine.toml --poses path.csv > drives.csv          columns x,y,z[,a,b,c]";

struct Options {
  std::string file;
  std::vector<std::string> pose, drives, start;
  std::string poses, drives_file;
  std::string rotation, part, tool;
  bool all = false;
};

Diagnostic UsageProblem(std::string message, std::string help) {
  return {.code = std::string(codes::kUsage.code),
          .message = std::move(message),
          .help = std::move(help)};
}

std::optional<Diagnostic> NotExactlyOne(const Options& options) {
  const int given = (options.pose.empty() ? 0 : 1) + (options.drives.empty() ? 0 : 1) +
                    (options.poses.empty() ? 0 : 1) + (options.drives_file.empty() ? 0 : 1);
  if (given == 1 && options.all && options.drives.empty()) {
    return UsageProblem("--all lists the assembly modes for given drives",
                        "give --drives; a tool pose has the drives of the layout's modes");
  }
  if (given == 1) return std::nullopt;
  return UsageProblem(given == 0 ? "nothing to solve" : "several things to solve",
                      "give one of --pose, --drives, --poses, --drives-file");
}

std::vector<std::string> PoseNames() {
  std::vector<std::string> names;
  names.reserve(kPoseLetters.size());
  for (const char letter : kPoseLetters) names.emplace_back(1, letter);
  return names;
}

void ReadPose(const Options& options, Question& question, Diagnostics& problems) {
  const Argument argument("--pose", options.pose);
  const auto numbers = ReadNumbers(argument, NameTable("pose component", PoseNames()), problems);
  kinematics::PoseTarget target{.order = question.order};
  for (std::size_t k = 0; k < 6; ++k) {
    if (numbers[k]) target.component[k] = Inward(*numbers[k], IsAngle(k));
  }
  question.pose = target;
}

void ReadDrives(const Machine& machine,
                const Options& options,
                Question& question,
                Diagnostics& problems) {
  std::vector<std::string> names;
  for (const kinematics::Drive& drive : machine.drives()) names.push_back(drive.name);
  const Argument argument("--drives", options.drives);
  const auto numbers = ReadNumbers(argument, NameTable("drive", names), problems);
  Eigen::VectorXd readings(static_cast<Eigen::Index>(names.size()));
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!numbers[i]) missing.push_back(names[i]);
    readings[static_cast<Eigen::Index>(i)] =
        Inward(numbers[i].value_or(0.0), machine.drives()[i].rotary);
  }
  if (!missing.empty() && problems.empty()) {
    problems.push_back(
        argument.Complaint(codes::kMissingName,
                           argument.text().size(),
                           1,
                           fmt::format("no reading is given for {}", Joined(missing)),
                           "the tool pose needs the readings of all drives: " + Joined(names)));
  }
  question.readings = readings;
}

void ReadStart(const Machine& machine,
               const Options& options,
               Question& question,
               Diagnostics& problems) {
  question.start = machine.home();
  if (options.start.empty()) return;
  std::vector<std::string> names;
  for (const kinematics::Coordinate& coordinate : machine.coordinates())
    names.push_back(coordinate.name);
  const auto numbers =
      ReadNumbers(Argument("--start", options.start), NameTable("coordinate", names), problems);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!numbers[i]) continue;
    question.start[static_cast<Eigen::Index>(i)] =
        Inward(*numbers[i], machine.coordinates()[i].rotary);
  }
}

ExitCode SolveOne(Session& session, const Machine& machine, const Question& question) {
  const SolvedPose solved = Solve(machine, question);
  if (session.json) {
    session.console.Json(SolvedJson(machine, solved));
  } else {
    session.console.Out(SolvedText(session.console, machine, solved, question.order));
    session.console.Say(solved.Message());
  }
  return solved.Exit();
}

ExitCode Run(Session& session, const Options& options) {
  if (const auto problem = NotExactlyOne(options)) return session.Refuse(*problem);
  ExitCode code = ExitCode::kOk;
  std::optional<Machine> machine = session.ReadMachine(options.file, code);
  if (!machine) return code;
  if (!options.part.empty() || !options.tool.empty()) {
    Parsed<Machine> between = machine->Between(options.part, options.tool);
    if (!between) {
      session.console.Report(between.error());
      return ExitCode::kUsage;
    }
    machine = std::move(*between);
  }
  Question question{.order = OrderOf(options.rotation, machine->layout())};
  Diagnostics problems;
  ReadStart(*machine, options, question, problems);
  if (!options.pose.empty()) ReadPose(options, question, problems);
  if (!options.drives.empty()) ReadDrives(*machine, options, question, problems);
  if (!problems.empty()) return session.Refuse(problems);
  if (options.all) return ShowAssemblyModes(session, *machine, *question.readings, question.order);
  if (question.pose || question.readings) return SolveOne(session, *machine, question);
  return SolveTable(session,
                    *machine,
                    question,
                    options.poses.empty() ? options.drives_file : options.poses,
                    options.poses.empty() ? TableKind::kDrives : TableKind::kPoses);
}

void AddQuestionOptions(CLI::App& command, Session& session, Options& options) {
  const auto assignments =
      [&command](const char* name, std::vector<std::string>& value, const char* text) {
        command.add_option(name, value, text)->type_name("NAME=..,")->allow_extra_args(false);
      };
  assignments("--pose", options.pose, "Tool pose in the workpiece: X Y Z in mm, A B C in deg");
  assignments("--drives", options.drives, "Readings of all drives, mm or deg; q1 for drive.q1");
  session.Hint(command.add_option("--poses", options.poses, "CSV table with columns x,y,z,a,b,c")
                   ->type_name("FILE"),
               ValueHint::Kind::kFile);
  session.Hint(
      command.add_option("--drives-file", options.drives_file, "CSV table with a column per drive")
          ->type_name("FILE"),
      ValueHint::Kind::kFile);
  command.add_flag("--all", options.all, "With --drives: list all assembly modes");
  assignments("--start", options.start, "Virtual coordinates to start iterations from; else home");
}

}  // namespace

void AddSolve(CLI::App& root, Session& session) {
  CLI::App* command =
      session.Command(root, "solve", "Tool pose to drives, or drives to tool pose", kExamples);
  const auto options = std::make_shared<Options>();
  session.Hint(command->add_option("FILE", options->file, "Layout")->required(),
               ValueHint::Kind::kFile);
  AddQuestionOptions(*command, session, *options);
  session.Choices(command
                      ->add_option("--rotation",
                                   options->rotation,
                                   "xyz: Rx(A) Ry(B) Rz(C); zyx: Rz(C) Ry(B) Rx(A); else as the "
                                   "layout says")
                      ->type_name("ORDER"),
                  {"xyz", "zyx"});
  command->add_option("--part", options->part, "Workpiece of a forked formula; else the first")
      ->type_name("NAME");
  command->add_option("--tool", options->tool, "Tool of a forked formula; else the first")
      ->type_name("NAME");
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
