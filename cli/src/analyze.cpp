// SPDX-License-Identifier: Apache-2.0
// kompono analyze: work zone, dexterity, singularities and geometry numbers of a layout.
#include "analyzing.hpp"
#include "assignments.hpp"
#include "csv.hpp"
#include "files.hpp"
#include "machine_sheet.hpp"
#include "patterns.hpp"
#include "pose_limits.hpp"
#include "session.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <memory>

#include "kompono/analysis/zone_files.hpp"

namespace kompono::cli {
namespace {

using kinematics::Machine;

constexpr const char* kExamples =
    "  kompono analyze machine.toml                               zone, dexterity, singularities\n"
    "  kompono analyze machine.toml --box 250x250x150             does this box fit?\n"
    "  kompono analyze machine.toml --slice Z=50 --svg slice.svg --map\n"
    "  kompono analyze machine.toml --zone --ply zone.ply         its surface for other programs\n"
    "  kompono analyze machine.toml --path poses.csv              singular between the samples?\n"
    "  kompono analyze machine.toml --geometry --at X=10,Y=20     points, struts, distances, "
    "angles";

struct Options {
  std::string file;
  bool zone = false, dexterity = false, singularities = false, geometry = false, map = false;
  bool indices = false;
  bool any_side = false, force = false;
  PoseLimitOptions limits;
  std::vector<std::string> over, region, at, slice;
  std::string path, point, box, cylinder, csv, ply, svg;
  std::optional<double> length;
  double tolerance_percent = 0.5, tilt_deg = 15.0;
  unsigned threads = 0;
};

std::atomic<bool>& Interrupted() {
  static std::atomic<bool> interrupted{false};
  return interrupted;
}

void OnInterrupt(int /*signal*/) {
  Interrupted() = true;
  // A second Ctrl-C ends the program as usual.
  std::signal(SIGINT, SIG_DFL);
}

NameTable CoordinateNames(const Machine& machine) {
  std::vector<std::string> names;
  for (const kinematics::Coordinate& coordinate : machine.coordinates())
    names.push_back(coordinate.name);
  return {"coordinate", names};
}

void ReadSpans(const Machine& machine,
               const Options& options,
               AnalysisTask& task,
               Diagnostics& problems) {
  const NameTable table = CoordinateNames(machine);
  std::vector<bool> taken(table.names().size(), false);
  const Argument over("--over", options.over);
  std::size_t begin = 0;
  for (const std::string& word : SplitWords(options.over)) {
    begin = over.text().find(word, begin);
    const auto index = table.Find(over, {.name = word, .name_begin = begin}, taken, problems);
    begin += word.size();
    if (index) task.over.push_back({.coordinate = table.names()[*index]});
  }
  const Argument region("--region", options.region);
  std::vector<bool> limited(table.names().size(), false);
  for (const Assignment& assignment : region.Split(problems)) {
    const auto index = table.Find(region, assignment, limited, problems);
    const auto range = region.Range(assignment, problems);
    if (!index || !range) continue;
    const bool angle = machine.coordinates()[*index].rotary;
    const std::string& name = table.names()[*index];
    auto found = std::find_if(task.over.begin(), task.over.end(), [&name](const auto& span) {
      return span.coordinate == name;
    });
    if (found == task.over.end())
      found = task.over.insert(found, analysis::Span{.coordinate = name});
    found->lower = Inward(range->lower, angle);
    found->upper = Inward(range->upper, angle);
  }
}

/// With --region alone the other translations still vary.
void CompleteSpans(const Machine& machine, const Options& options, AnalysisTask& task) {
  if (!options.over.empty() || task.over.empty()) return;
  const auto region = analysis::RegionOf(machine, {}, machine.home());
  if (!region) return;
  for (const int index : region->varied) {
    const std::string& name = machine.coordinates()[static_cast<std::size_t>(index)].name;
    const bool known = std::any_of(task.over.begin(), task.over.end(), [&name](const auto& span) {
      return span.coordinate == name;
    });
    if (!known && task.over.size() < 3) task.over.push_back({.coordinate = name});
  }
  std::sort(task.over.begin(), task.over.end(), [&machine](const auto& a, const auto& b) {
    return machine.FindCoordinate(a.coordinate) < machine.FindCoordinate(b.coordinate);
  });
}

void ReadHeld(const Machine& machine,
              const Options& options,
              AnalysisTask& task,
              Diagnostics& problems) {
  const NameTable table = CoordinateNames(machine);
  task.at = machine.home();
  const auto numbers = ReadNumbers(Argument("--at", options.at), table, problems);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i])
      task.at[static_cast<Eigen::Index>(i)] = Inward(*numbers[i], machine.coordinates()[i].rotary);
  }
  const Argument slice("--slice", options.slice);
  for (const Assignment& assignment : slice.Split(problems)) {
    std::vector<bool> taken(table.names().size(), false);  // many slices of one coordinate
    const auto index = table.Find(slice, assignment, taken, problems);
    const auto number = slice.Number(assignment, problems);
    if (index && number)
      task.slices.emplace_back(table.names()[*index],
                               Inward(*number, machine.coordinates()[*index].rotary));
  }
}

/// "250x250x150".
std::optional<std::vector<double>> ReadSizes(const std::string& option,
                                             const std::string& text,
                                             Diagnostics& problems) {
  if (text.empty()) return std::nullopt;
  std::vector<double> out;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find('x', begin), text.size());
    const auto number = ParseNumber(Trimmed(std::string_view(text).substr(begin, end - begin)));
    if (!number || !(*number > 0.0) || !std::isfinite(*number) || out.size() == 3) {
      problems.push_back({.code = std::string(codes::kBadNumber.code),
                          .message = fmt::format("{} '{}' is no list of sizes", option, text),
                          .help = "give sizes or proportions above 0 with x between: 250x250x150"});
      return std::nullopt;
    }
    out.push_back(*number);
    begin = end + 1;
  }
  return out;
}

Diagnostic TableProblem(const std::string& file,
                        const SourceSpan& place,
                        std::string message,
                        std::string help) {
  return {.code = std::string(codes::kBadTable.code),
          .file = file,
          .span = place,
          .message = std::move(message),
          .help = std::move(help)};
}

/// Columns are pose components (solved) or coordinates by their names.
Diagnostics ReadPath(const Machine& machine, const std::string& file, AnalysisTask& task) {
  const Parsed<std::string> text = ReadWhole(file);
  if (!text) return text.error();
  const Parsed<NumberTable> table = ReadNumberTable(*text, file);
  if (!table) return table.error();
  std::vector<std::pair<bool, std::size_t>> columns;  // of the pose, index
  Diagnostics problems;
  for (std::size_t i = 0; i < table->headings.size(); ++i) {
    std::string name = table->headings[i];
    for (const std::string_view unit : {"_mm", "_deg"}) {
      if (name.ends_with(unit)) name.resize(name.size() - unit.size());
    }
    const int coordinate = machine.FindCoordinate(name);
    const std::size_t component = name.size() == 1 ? std::string("xyzabc").find(name[0]) : 9;
    if (component < 6) {
      columns.emplace_back(true, component);
    } else if (coordinate >= 0) {
      columns.emplace_back(false, static_cast<std::size_t>(coordinate));
    } else {
      problems.push_back(
          TableProblem(file,
                       table->heading_places[i],
                       fmt::format("'{}' is neither a pose component nor a coordinate", name),
                       "columns are x y z a b c of the tool, or the machine's coordinates"));
    }
  }
  for (std::size_t k = 0; k < table->rows.size() && problems.empty(); ++k) {
    kinematics::PoseTarget target{.order = machine.layout().rotation_order};
    Eigen::VectorXd z = task.path.empty() ? task.at : task.path.back();
    bool solve = false;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto& [of_pose, index] = columns[i];
      const double value = table->rows[k][i];
      if (of_pose) {
        target.component[index] = Inward(value, IsAngle(index));
        solve = true;
      } else {
        z[static_cast<Eigen::Index>(index)] = Inward(value, machine.coordinates()[index].rotary);
      }
    }
    if (solve) z = machine.Inverse(target, machine.nominal(), z).coordinates;
    if (z.size() != task.at.size() || !z.allFinite()) {
      SourceSpan place = table->heading_places.front();
      place.line = table->lines[k];
      problems.push_back(TableProblem(
          file, place, "no coordinates for this pose", "look at it with kompono solve --pose"));
      break;
    }
    task.path.push_back(z);
  }
  if (problems.empty() && task.path.size() < 2 && task.point.empty()) {
    problems.push_back(TableProblem(file,
                                    table->heading_places.front(),
                                    "a path needs at least two rows",
                                    "for one pose use --geometry --at"));
  }
  return problems;
}

Parsed<AnalysisTask> TaskOf(const Machine& machine, const Options& options) {
  AnalysisTask task{.zone = options.zone || !options.box.empty() || !options.cylinder.empty() ||
                            !options.ply.empty(),
                    .dexterity = options.dexterity,
                    .singularities = options.singularities,
                    .geometry = options.geometry,
                    .point = options.point,
                    .regular = !options.any_side,
                    .tolerance = options.tolerance_percent / 100.0,
                    .length_mm = options.length,
                    .map = options.map,
                    .indices = options.indices,
                    .tilt_rad = options.tilt_deg / kDegPerRad};
  Diagnostics problems;
  ReadSpans(machine, options, task, problems);
  CompleteSpans(machine, options, task);
  ReadHeld(machine, options, task, problems);
  task.limits = ReadPoseLimits(options.limits, problems);
  task.box = ReadSizes("--box", options.box, problems);
  task.cylinder = ReadSizes("--cylinder", options.cylinder, problems);
  if (problems.empty() && !options.path.empty()) problems = ReadPath(machine, options.path, task);
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  const bool nothing = !task.zone && !task.dexterity && !task.singularities && !task.geometry &&
                       !task.indices && task.slices.empty() && task.path.empty() &&
                       task.point.empty();
  if (nothing) task.zone = task.dexterity = task.indices = task.singularities = true;
  if (!task.slices.empty()) task.singularities = true;
  task.control.threads = options.threads;
  return task;
}

/// Writes what files were asked for; the first failure.
std::optional<Diagnostic> WriteFiles(Session& session,
                                     const Options& options,
                                     const AnalysisTask& task,
                                     const AnalysisResult& result) {
  const auto write = [&](const std::string& file, const std::string& text) {
    auto failure = WriteFileAside(file, text, options.force);
    if (!failure) session.console.Say(file + " written");
    return failure;
  };
  std::optional<Diagnostic> failure;
  if (!options.csv.empty()) failure = write(options.csv, AnalysisCsv(result, task));
  if (!failure && !options.svg.empty()) failure = write(options.svg, AnalysisSvg(result, task));
  if (!failure && !options.ply.empty()) {
    if (result.function->region().dimension() != 3) {
      return Diagnostic{.code = std::string(codes::kUsage.code),
                        .message = "--ply needs a zone of three coordinates",
                        .help = "a planar zone is drawn by --svg"};
    }
    const analysis::ZoneSurface surface =
        analysis::SurfaceOfZone(*result.function, *result.zone, 64, task.control);
    failure = write(options.ply, analysis::SurfacePly(surface, result.machine->layout().name));
  }
  return failure;
}

ExitCode Run(Session& session, const Options& options) {
  for (const std::string& file : {options.csv, options.ply, options.svg}) {
    if (const auto exists = RefuseToOverwrite(file, options.force)) return session.Refuse(*exists);
  }
  ExitCode code = ExitCode::kOk;
  const std::optional<Machine> machine = session.ReadMachine(options.file, code);
  if (!machine) return code;
  Parsed<AnalysisTask> task = TaskOf(*machine, options);
  if (!task) return session.Refuse(task.error());
  if (!options.svg.empty() && task->slices.empty()) task->zone = true;
  if (!options.csv.empty() && task->point.empty()) task->zone = true;
  if (options.map) task->dexterity = task->zone || task->dexterity;
  task->control.stop = &Interrupted();
  task->control.progress = [&session](std::uint64_t done, std::uint64_t all) {
    session.console.Progress(fmt::format("{} of {} blocks", done, all));
  };
  std::signal(SIGINT, OnInterrupt);
  const Parsed<AnalysisResult> result = Analyze(*machine, *task);
  session.console.Progress("");
  if (!result) return session.Refuse(result.error());
  if (session.json) {
    session.console.Json(AnalysisJson(*result));
  } else {
    session.console.Out(AnalysisText(session.console, *result));
  }
  if (const auto failure = WriteFiles(session, options, *task, *result))
    return session.Refuse(*failure);
  return result->Negative() ? ExitCode::kNegative : ExitCode::kOk;
}

void AddWhat(CLI::App& command, Options& options) {
  command.add_flag("--zone", options.zone, "Work zone: content, extents, bodies, what bounds it");
  command.add_flag("--dexterity", options.dexterity, "Condition, weakest force, slowest velocity");
  command.add_flag("--singularities",
                   options.singularities,
                   "Where det A vanishes, and how far home is from there");
  command.add_flag(
      "--geometry", options.geometry, "Points, struts, distances and angles at home or --at");
  command.add_flag("--map", options.map, "Condition over the zone in --svg and --csv");
}

void AddWhere(CLI::App& command, Session& session, Options& options) {
  const auto list =
      [&command](
          const char* name, std::vector<std::string>& value, const char* type, const char* text) {
        command.add_option(name, value, text)->type_name(type)->allow_extra_args(false);
      };
  list("--over", options.over, "NAME,..", "Coordinates to vary, at most three; else X Y Z");
  list("--region", options.region, "NAME=LO:HI,..", "Limits of coordinates that vary; mm, deg");
  list("--at", options.at, "NAME=..,", "Coordinates that are held, and the pose of --geometry");
  list("--slice", options.slice, "NAME=..,", "Cut the zone here; may be repeated");
  session.Hint(command.add_option("--path", options.path, "CSV of tool poses or coordinates")
                   ->type_name("FILE"),
               ValueHint::Kind::kFile);
  command
      .add_option("--point",
                  options.point,
                  "Where a point goes: struts.joint1, or A:B:0.25 on the way from A to B")
      ->type_name("POINT");
}

void AddLimits(CLI::App& command, Options& options) {
  AddPoseLimits(command, options.limits);
  command.add_flag(
      "--no-ranges", options.limits.no_ranges, "Reach only, without what the layout limits");
  command.add_flag(
      "--any-side", options.any_side, "Beyond type 2 singularities too, not only on home's side");
  command
      .add_option(
          "--box", options.box, "Largest box of these proportions; does it fit at this size")
      ->type_name("AxBxC");
  command
      .add_option(
          "--cylinder", options.cylinder, "Likewise diameter and height, along the last axis")
      ->type_name("DxH");
  command
      .add_option("--tolerance", options.tolerance_percent, "Bound of the zone's content, % (0.5)")
      ->type_name("PERCENT")
      ->check(CLI::Range(0.001, 100.0));
  command.add_option("--length", options.length, "What 1 rad counts in conditions, mm; else best")
      ->type_name("MM")
      ->check(CLI::PositiveNumber);
  command.add_option("--tilt", options.tilt_deg, "Of the orientation space index, deg (15)")
      ->type_name("DEG")
      ->check(CLI::Range(0.0, 180.0));
  command.add_option("--threads", options.threads, "Else all cores")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
}

void AddFiles(CLI::App& command, Session& session, Options& options) {
  const auto file = [&](const char* name, std::string& value, const char* text) {
    session.Hint(command.add_option(name, value, text)->type_name("FILE"), ValueHint::Kind::kFile);
  };
  file("--csv", options.csv, "The zone's cells, the --map, or the way of --point");
  file("--ply", options.ply, "The zone's surface as triangles");
  file("--svg", options.svg, "The zone, its slices, singular places and bodies as a picture");
  command.add_flag("--force", options.force, "Replace files that exist");
}

}  // namespace

void AddAnalyze(CLI::App& root, Session& session) {
  CLI::App* command = session.Command(
      root, "analyze", "Work zone, dexterity, singularities and geometry numbers", kExamples);
  const auto options = std::make_shared<Options>();
  session.Hint(command->add_option("FILE", options->file, "Layout")->required(),
               ValueHint::Kind::kFile);
  AddWhat(*command, *options);
  AddWhere(*command, session, *options);
  AddLimits(*command, *options);
  AddFiles(*command, session, *options);
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
