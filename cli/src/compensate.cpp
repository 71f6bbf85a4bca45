// SPDX-License-Identifier: Apache-2.0
// kompono compensate: what a control that keeps its nominal geometry has to be told instead.
#include "codes.hpp"
#include "csv.hpp"
#include "files.hpp"
#include "session.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <memory>
#include <optional>

#include "kompono/calibration/codes.hpp"
#include "kompono/calibration/residual_map.hpp"

namespace kompono::cli {
namespace {

using kinematics::Machine;

constexpr const char* kExamples =
    "  kompono compensate machine.toml calibrated.toml program.csv -o corrected.csv\n"
    "  kompono compensate machine.toml calibrated.toml --grid 5 -o table.csv\n"
    "  kompono compensate machine.toml calibrated.toml program.csv --residual-map map.toml";

struct Options {
  std::string file, calibrated, program, out, residual_map;
  int grid = 0;
  bool force = false;
};

constexpr std::string_view kLetters = "XYZABC";

struct Program {
  std::vector<int> components;  ///< of X Y Z A B C
  std::vector<std::vector<double>> rows;
};

/// Columns X_mm, ..., A_deg, ...; other columns are complained of.
Parsed<Program> ReadProgram(const std::string& file) {
  const Parsed<std::string> text = ReadWhole(file);
  if (!text) return tl::unexpected(text.error());
  Parsed<NumberTable> table = ReadNumberTable(*text, file);
  if (!table) return tl::unexpected(table.error());
  Program program;
  Diagnostics problems;
  for (std::size_t i = 0; i < table->headings.size(); ++i) {
    const std::string& heading = table->headings[i];
    const std::size_t letter =
        heading.empty() ? std::string_view::npos
                        : kLetters.find(static_cast<char>(std::toupper(heading.front())));
    const std::string unit = heading.size() > 1 ? heading.substr(1) : std::string();
    const bool fits = unit.empty() || unit == (letter < 3 ? "_mm" : "_deg");
    if (letter == std::string_view::npos || !fits) {
      problems.push_back({.code = std::string(codes::kBadTable.code),
                          .file = file,
                          .span = table->heading_places[i],
                          .message = fmt::format("'{}' is no component of a pose", heading),
                          .help = "columns are X_mm, Y_mm, Z_mm, A_deg, B_deg, C_deg"});
      continue;
    }
    program.components.push_back(static_cast<int>(letter));
  }
  if (!problems.empty()) return tl::unexpected(problems);
  program.rows = std::move(table->rows);
  return program;
}

/// Points of a grid over the ranges of X, Y and Z as far as the machine has them.
Parsed<Program> Grid(const Machine& machine, int count) {
  Program program;
  std::vector<std::array<double, 2>> ranges;
  for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
    const kinematics::Coordinate& coordinate = machine.coordinates()[i];
    const std::size_t letter = kLetters.find(coordinate.letter);
    if (letter > 2 || !coordinate.lower || !coordinate.upper) continue;
    program.components.push_back(static_cast<int>(letter));
    ranges.push_back({*coordinate.lower, *coordinate.upper});
  }
  if (ranges.empty()) {
    return tl::unexpected(Diagnostics{{.code = "E0441",
                                       .file = machine.layout().file.string(),
                                       .message = "a grid needs coordinates with ranges",
                                       .help = "give ranges in the layout, or a program"}});
  }
  std::vector<std::vector<double>> rows{{}};
  for (const auto& [lower, upper] : ranges) {
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& row : rows) {
      for (int i = 0; i < count; ++i) {
        longer.push_back(row);
        longer.back().push_back(lower + (upper - lower) * i / std::max(1, count - 1));
      }
    }
    rows = std::move(longer);
  }
  // The grid is one of coordinates; the program wants the pose there.
  for (std::vector<double>& row : rows) {
    kinematics::VectorXd z = machine.home();
    std::size_t at = 0;
    for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
      const kinematics::Coordinate& coordinate = machine.coordinates()[i];
      if (kLetters.find(coordinate.letter) > 2 || !coordinate.lower || !coordinate.upper) continue;
      z[static_cast<Eigen::Index>(i)] = row[at++];
    }
    const kinematics::PoseNumbers pose = kinematics::NumbersFromPose(
        machine.ToolPose(z, machine.nominal()), machine.layout().rotation_order);
    for (std::size_t k = 0; k < row.size(); ++k) {
      row[k] = pose.value[static_cast<std::size_t>(program.components[k])];
    }
  }
  program.rows = std::move(rows);
  return program;
}

struct Corrected {
  std::string csv;
  int rows = 0, failed = 0;
  int beyond_map = 0, first_beyond_map = 0;  ///< rows outside the map's grid, counted from 1
  double largest_mm = 0.0;
};

/// Coordinates at which the real machine stands at `target`, what its map says it is off included.
kinematics::Solution Reach(const Machine& real,
                           const calibration::ResidualMap* map,
                           const kinematics::PoseTarget& target) {
  constexpr int kPasses = 3;  // the map changes by micrometres per millimetre
  kinematics::Solution solution = real.Inverse(target);
  for (int pass = 0; map != nullptr && pass < kPasses && solution.ok(); ++pass) {
    const Eigen::Vector3d off = map->At(real, solution.coordinates);
    kinematics::PoseTarget aim = target;
    for (std::size_t i = 0; i < 3; ++i) {
      if (aim.component[i]) *aim.component[i] -= off[static_cast<Eigen::Index>(i)];
    }
    solution = real.Inverse(aim);
  }
  return solution;
}

/// For every pose: readings of the real machine, and the pose that makes the nominal control send
/// them.
Corrected Correct(const Machine& nominal,
                  const Machine& real,
                  const calibration::ResidualMap* map,
                  const Program& program) {
  Corrected out;
  std::string header;
  for (const int k : program.components) {
    header += fmt::format(
        "{}{}_{}", header.empty() ? "" : ",", kLetters[static_cast<std::size_t>(k)], UnitOf(k > 2));
  }
  for (const int k : program.components) {
    header += fmt::format(",corrected_{}_{}", kLetters[static_cast<std::size_t>(k)], UnitOf(k > 2));
  }
  for (const kinematics::Drive& drive : nominal.drives()) {
    header += fmt::format(",{}_{},correction_{}_{}",
                          drive.name,
                          UnitOf(drive.rotary),
                          drive.name,
                          UnitOf(drive.rotary));
  }
  out.csv = header + ",status\n";
  const layout::RotationOrder order = nominal.layout().rotation_order;
  for (const std::vector<double>& row : program.rows) {
    kinematics::PoseTarget target;
    target.order = order;
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const int k = program.components[i];
      // Grid poses are in radians already; programs in degrees are converted when read.
      target.component[static_cast<std::size_t>(k)] = row[i];
      line += (line.empty() ? "" : ",") + Exact(Outward(row[i], k > 2));
    }
    ++out.rows;
    const kinematics::Solution wanted = Reach(real, map, target);
    const kinematics::Solution told = nominal.Inverse(target);
    const kinematics::Solution there =
        nominal.Forward(wanted.drives, nominal.nominal(), told.coordinates);
    if (!wanted.ok() || !told.ok() || !there.ok()) {
      ++out.failed;
      const kinematics::Solution& bad = !wanted.ok() ? wanted : !told.ok() ? told : there;
      out.csv += line + std::string(row.size() + 2 * nominal.drives().size(), ',') + "," +
                 std::string(kinematics::Name(bad.status)) + "\n";
      continue;
    }
    const kinematics::PoseNumbers corrected = kinematics::NumbersFromPose(there.X_WT, order);
    for (const int k : program.components) {
      line += "," + Fixed(Outward(corrected.value[static_cast<std::size_t>(k)], k > 2));
    }
    for (Eigen::Index i = 0; i < wanted.drives.size(); ++i) {
      const bool rotary = nominal.drives()[static_cast<std::size_t>(i)].rotary;
      line += "," + Fixed(Outward(wanted.drives[i], rotary)) + "," +
              Fixed(Outward(wanted.drives[i] - told.drives[i], rotary));
    }
    if (map != nullptr && !map->Covers(real, wanted.coordinates) && out.beyond_map++ == 0) {
      out.first_beyond_map = out.rows;
    }
    out.largest_mm = std::max(out.largest_mm, (there.X_WT.p - told.X_WT.p).norm());
    out.csv += line + ",ok\n";
  }
  return out;
}

ExitCode Run(Session& session, const Options& options) {
  if (const auto exists = RefuseToOverwrite(options.out, options.force))
    return session.Refuse(*exists);
  ExitCode code = ExitCode::kOk;
  const std::optional<Machine> nominal = session.ReadMachine(options.file, code);
  if (!nominal) return code;
  const std::optional<Machine> real = session.ReadMachine(options.calibrated, code);
  if (!real) return code;
  if (nominal->drives().size() != real->drives().size()) {
    return session.Refuse(Diagnostic{.code = "E0443",
                                     .file = options.calibrated,
                                     .message = "the two layouts have different drives",
                                     .help = "give a layout and its calibrated version"});
  }
  if (options.program.empty() == (options.grid == 0)) {
    return session.Refuse(Diagnostic{.code = std::string(codes::kUsage.code),
                                     .message = "give either a program or --grid N"});
  }
  Parsed<Program> program =
      options.program.empty() ? Grid(*nominal, options.grid) : ReadProgram(options.program);
  if (!program) return session.Refuse(program.error());
  if (!options.program.empty()) {
    for (std::vector<double>& row : program->rows) {
      for (std::size_t i = 0; i < row.size(); ++i) {
        row[i] = Inward(row[i], program->components[i] > 2);
      }
    }
  }
  std::optional<calibration::ResidualMap> map;
  if (!options.residual_map.empty()) {
    const Parsed<std::string> text = ReadWhole(options.residual_map);
    if (!text) return session.Refuse(text.error());
    Parsed<calibration::ResidualMap> parsed =
        calibration::ParseResidualMap(*text, options.residual_map, *real);
    if (!parsed) return session.Refuse(parsed.error());
    map = std::move(*parsed);
  }
  const Corrected corrected = Correct(*nominal, *real, map ? &*map : nullptr, *program);
  if (corrected.beyond_map > 0) {
    session.console.Report(
        {{.severity = Severity::kWarning,
          .code = calibration::codes::kBeyondMap.code,
          .file = options.residual_map,
          .message = fmt::format("{} of {} lie outside the map, the first is row {}",
                                 corrected.beyond_map,
                                 Counted(static_cast<std::size_t>(corrected.rows), "pose"),
                                 corrected.first_beyond_map),
          .help = "there the map's border is used; measure where the program goes"}});
  }
  if (!options.out.empty()) {
    if (const auto failure = WriteFileAside(options.out, corrected.csv, options.force))
      return session.Refuse(*failure);
  }
  if (session.json) {
    nlohmann::ordered_json out{{"rows", corrected.rows},
                               {"beyond_map", corrected.beyond_map},
                               {"failed", corrected.failed},
                               {"largest_correction_mm", corrected.largest_mm}};
    if (options.out.empty()) {
      out["csv"] = corrected.csv;
    } else {
      out["file"] = options.out;
    }
    session.console.Json(std::move(out));
  } else {
    if (options.out.empty()) session.console.Out(corrected.csv);
    session.console.Say(fmt::format("{}, {} without a solution; largest correction {:.4f} mm",
                                    Counted(static_cast<std::size_t>(corrected.rows), "pose"),
                                    corrected.failed,
                                    corrected.largest_mm));
  }
  return corrected.failed > 0 ? ExitCode::kNoSolution : ExitCode::kOk;
}

}  // namespace

void AddCompensate(CLI::App& root, Session& session) {
  CLI::App* command = session.Command(
      root, "compensate", "Corrects poses and readings for an uncalibrated control", kExamples);
  const auto options = std::make_shared<Options>();
  const auto file = [&](const char* name, std::string& value, const char* text) {
    CLI::Option* option = command->add_option(name, value, text)->type_name("FILE");
    session.Hint(option, ValueHint::Kind::kFile);
    return option;
  };
  file("LAYOUT", options->file, "Geometry that the control believes in")->required();
  file("CALIBRATED", options->calibrated, "Geometry of the real machine")->required();
  file("PROGRAM", options->program, "CSV with X_mm, Y_mm, ... of the poses wanted");
  command->add_option("--grid", options->grid, "Instead a table: N values of each of X, Y and Z")
      ->type_name("N")
      ->check(CLI::Range(2, 200));
  file("--residual-map", options->residual_map, "What calibrate --residual-map wrote");
  file("-o,--out", options->out, "CSV file to write; else stdout");
  command->add_flag("--force", options->force, "Replace the file if it exists");
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
