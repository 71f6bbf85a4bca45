// SPDX-License-Identifier: Apache-2.0
#include "solve_table.hpp"

#include "assignments.hpp"
#include "csv.hpp"
#include "files.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::cli {
namespace {

using kinematics::Machine;
using nlohmann::ordered_json;

constexpr std::size_t kProgressRows = 512;

/// What each column of the file means.
struct Columns {
  std::vector<std::size_t> target;  ///< pose component or drive
};

std::string WithoutUnit(std::string_view heading) {
  for (const std::string_view unit : {"_mm", "_deg"}) {
    if (heading.ends_with(unit)) heading.remove_suffix(unit.size());
  }
  return std::string(heading);
}

Diagnostic Problem(const std::string& file,
                   const SourceSpan& span,
                   std::string message,
                   std::string help) {
  return {.code = std::string(codes::kBadTable.code),
          .file = file,
          .span = span,
          .message = std::move(message),
          .help = std::move(help)};
}

Parsed<Columns> UnderstandHeadings(const NumberTable& table,
                                   const std::string& file,
                                   const NameTable& names,
                                   bool all_needed) {
  Columns out;
  Diagnostics problems;
  std::vector<bool> taken(names.names().size(), false);
  for (std::size_t i = 0; i < table.headings.size(); ++i) {
    const std::string word = WithoutUnit(table.headings[i]);
    const std::vector<std::size_t> matches = names.Matches(word);
    if (matches.size() != 1) {
      problems.push_back(Problem(
          file,
          table.heading_places[i],
          fmt::format(
              "column '{}' {}", table.headings[i], matches.empty() ? "is unknown" : "is ambiguous"),
          "known are: " + Joined(names.names())));
      continue;
    }
    if (taken[matches.front()]) {
      problems.push_back(Problem(file,
                                 table.heading_places[i],
                                 fmt::format("column '{}' stands twice", table.headings[i]),
                                 ""));
    }
    taken[matches.front()] = true;
    out.target.push_back(matches.front());
  }
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    if (!taken[i]) missing.push_back(names.names()[i]);
  }
  if (all_needed && !missing.empty() && problems.empty()) {
    problems.push_back(Problem(file,
                               table.heading_places.front(),
                               fmt::format("no column for {}", Joined(missing)),
                               "the tool pose needs the readings of all drives"));
  }
  if (!problems.empty()) return tl::unexpected(problems);
  return out;
}

NameTable NamesFor(const Machine& machine, TableKind kind) {
  std::vector<std::string> names;
  if (kind == TableKind::kPoses) {
    for (const char letter : kPoseLetters) names.emplace_back(1, letter);
    return {"pose component", names};
  }
  for (const kinematics::Drive& drive : machine.drives()) names.push_back(drive.name);
  return {"drive", names};
}

void Fill(const Machine& machine,
          const Columns& columns,
          const std::vector<double>& row,
          TableKind kind,
          Question& question) {
  if (kind == TableKind::kPoses) {
    kinematics::PoseTarget target{.order = question.order};
    for (std::size_t i = 0; i < row.size(); ++i)
      target.component[columns.target[i]] = Inward(row[i], IsAngle(columns.target[i]));
    question.pose = target;
    return;
  }
  Eigen::VectorXd readings(static_cast<Eigen::Index>(machine.drives().size()));
  for (std::size_t i = 0; i < row.size(); ++i) {
    readings[static_cast<Eigen::Index>(columns.target[i])] =
        Inward(row[i], machine.drives()[columns.target[i]].rotary);
  }
  question.readings = readings;
}

std::string HeadingLine(const Machine& machine) {
  std::string line = "row,x_mm,y_mm,z_mm,a_deg,b_deg,c_deg";
  for (const kinematics::Drive& drive : machine.drives())
    line += fmt::format(",{}_{}", drive.name, UnitOf(drive.rotary));
  return line + ",singularity_type,singularity_margin,status,message\n";
}

std::string NumberField(double value) {
  return std::isfinite(value) ? Exact(value) : "";
}

std::string RowLine(const Machine& machine, std::size_t number, const SolvedPose& solved) {
  std::string line = std::to_string(number);
  for (std::size_t k = 0; k < 6; ++k)
    line += "," + NumberField(Outward(solved.pose.value[k], IsAngle(k)));
  for (std::size_t i = 0; i < machine.drives().size(); ++i) {
    line += "," + NumberField(Outward(solved.solution.drives[static_cast<Eigen::Index>(i)],
                                      machine.drives()[i].rotary));
  }
  const SingularitySummary summary = Summary(solved.singularities);
  line += solved.complete ? fmt::format(",{},{}", summary.type, Exact(summary.margin)) : ",,";
  return line + fmt::format(",{},{}\n", CsvField(solved.Status()), CsvField(solved.Message()));
}

ordered_json RowJson(const Machine& machine, std::size_t number, const SolvedPose& solved) {
  ordered_json out = SolvedJson(machine, solved);
  for (const char* key : {"jacobian", "jacobian_rows", "jacobian_columns", "struts"})
    out.erase(key);
  ordered_json row{{"row", number}};
  row.update(out);
  return row;
}

ExitCode Worse(ExitCode a, ExitCode b) {
  return static_cast<int>(a) > static_cast<int>(b) ? a : b;
}

}  // namespace

ExitCode SolveTable(Session& session,
                    const Machine& machine,
                    Question question,
                    const std::string& file,
                    TableKind kind) {
  const Parsed<std::string> text = ReadWhole(file);
  if (!text) return session.Refuse(text.error());
  const Parsed<NumberTable> table = ReadNumberTable(*text, file);
  if (!table) return session.Refuse(table.error());
  const Parsed<Columns> columns =
      UnderstandHeadings(*table, file, NamesFor(machine, kind), kind == TableKind::kDrives);
  if (!columns) return session.Refuse(columns.error());

  Console& console = session.console;
  ordered_json rows = ordered_json::array();
  if (!session.json) console.Out(HeadingLine(machine));
  ExitCode code = ExitCode::kOk;
  std::size_t failed = 0;
  for (std::size_t i = 0; i < table->rows.size(); ++i) {
    if (i % kProgressRows == kProgressRows - 1)
      console.Progress(fmt::format("row {} of {}", i + 1, table->rows.size()));
    Fill(machine, *columns, table->rows[i], kind, question);
    const SolvedPose solved = Solve(machine, question, false);
    code = Worse(code, solved.Exit());
    if (solved.Exit() != ExitCode::kOk) ++failed;
    if (session.json) {
      rows.push_back(RowJson(machine, i + 1, solved));
    } else {
      console.Out(RowLine(machine, i + 1, solved));
    }
  }
  if (session.json) {
    console.Json({{"rows", std::move(rows)}, {"failed", failed}});
  } else if (failed > 0) {
    console.Say(fmt::format(
        "{} of {} without a good solution", failed, Counted(table->rows.size(), "row")));
  }
  return code;
}

}  // namespace kompono::cli
