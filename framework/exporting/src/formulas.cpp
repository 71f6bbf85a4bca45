// SPDX-License-Identifier: Apache-2.0
#include "kompono/exporting/formulas.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <numeric>

#include "kompono/diagnostics/suggestion.hpp"
#include "kompono/expression/polynomial.hpp"
#include "kompono/expression/printing.hpp"

namespace kompono::exporting {
namespace {

struct Recorded {
  std::vector<KomponoExpressionNode> nodes;
  std::vector<std::int32_t> roots;
};

Recorded RecordDrives(const plugin::Mechanism& code) {
  Recorded recorded;
  const plugin::FormulaReceiver receiver{.context = &recorded,
                                         .take = [](void* context,
                                                    const KomponoExpressionNode* nodes,
                                                    std::size_t node_count,
                                                    const std::int32_t* roots,
                                                    std::size_t root_count) {
                                           auto& to = *static_cast<Recorded*>(context);
                                           to.nodes.assign(nodes, nodes + node_count);
                                           to.roots.assign(roots, roots + root_count);
                                         }};
  if (code.Record(plugin::Quantity::kDrives, false, receiver) != plugin::Status::kOk)
    recorded.roots.clear();
  return recorded;
}

/// Lower-case letters where they are unique, as KSM prints them; else "block_x".
std::vector<std::string> VariableNames(const kinematics::Machine& machine) {
  const auto short_name = [](const kinematics::Coordinate& coordinate) {
    const std::size_t dot = coordinate.name.rfind('.');
    std::string name = dot == std::string::npos ? coordinate.name : coordinate.name.substr(dot + 1);
    std::transform(
        name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    return name;
  };
  std::map<std::string, int> uses;
  for (const kinematics::Coordinate& coordinate : machine.coordinates())
    ++uses[short_name(coordinate)];
  std::vector<std::string> names;
  for (const kinematics::Coordinate& coordinate : machine.coordinates()) {
    std::string name = short_name(coordinate);
    if (uses[name] > 1) {
      const std::size_t dot = coordinate.name.rfind('.');
      name.insert(0, "_").insert(
          0, dot == std::string::npos ? std::string("axis") : coordinate.name.substr(0, dot));
    }
    names.push_back(name);
  }
  return names;
}

Expression Finish(const Expression& raw,
                  const FormulaOptions& options,
                  std::size_t variable_count) {
  Expression simple = raw.Simplify();
  if (!options.expand) return simple;
  std::vector<int> variables(variable_count);
  std::iota(variables.begin(), variables.end(), 0);
  return ExpandUnderRoots(simple, variables);
}

bool Wanted(const std::vector<std::string>& wanted, const std::string& drive) {
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), drive) != wanted.end();
}

TextOptions TextOptionsOf(const MachineFormulas& formulas, const FormulaOptions& options) {
  return {.names = formulas.variables, .digits = options.digits};
}

Diagnostics UnknownDrives(const kinematics::Machine& machine, const FormulaOptions& options) {
  std::vector<std::string> known;
  for (const kinematics::Drive& drive : machine.drives()) known.push_back(drive.name);
  Diagnostics complaints;
  for (const std::string& drive : options.drives) {
    if (machine.FindDrive(drive) >= 0) continue;
    complaints.push_back({.severity = Severity::kError,
                          .code = "E0711",
                          .file = machine.layout().file.string(),
                          .message = fmt::format("the machine has no drive '{}'", drive),
                          .help = DidYouMean(drive, known)});
  }
  return complaints;
}

}  // namespace

Parsed<MachineFormulas> DriveFormulas(const kinematics::Machine& machine,
                                      const FormulaOptions& options) {
  Diagnostics complaints = UnknownDrives(machine, options);
  MachineFormulas out;
  out.variables = VariableNames(machine);
  for (const kinematics::Coordinate& coordinate : machine.coordinates())
    out.coordinates.push_back(coordinate.name);
  const kinematics::VectorXd theta = machine.nominal();
  std::vector<Expression> raw(machine.drives().size());
  const auto reading = [&theta, &machine](
                           const Expression& position, const std::string& name, int sign) {
    const double zero = theta[machine.FindParameter(name + ".zero")];
    const Expression from_zero = zero == 0.0 ? position : position - Expression(zero);
    return sign > 0 ? from_zero : -from_zero;
  };
  for (const layout::Axis& axis : machine.layout().axes) {
    const int drive = machine.FindDrive(axis.name);
    const int coordinate = machine.FindCoordinate(axis.name);
    if (drive < 0 || coordinate < 0) continue;
    raw[static_cast<std::size_t>(drive)] =
        reading(Expression::Variable(coordinate), axis.name, axis.drive.sign);
  }
  for (const kinematics::Machine::BlockView& view : machine.blocks()) {
    const plugin::MechanismShape shape = view.code->Shape();
    const Recorded recorded = RecordDrives(*view.code);
    const int variables = shape.coordinates + shape.drives + shape.parameters + shape.modes;
    Parsed<std::vector<Expression>> positions =
        ImportRecording(recorded.nodes, recorded.roots, variables, view.block->module);
    if (!positions) {
      complaints.insert(complaints.end(), positions.error().begin(), positions.error().end());
      continue;
    }
    std::map<int, Expression> values;
    for (int i = 0; i < shape.coordinates; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Expression letter = Expression::Variable(view.coordinates[k]);
      values[i] = view.block->letters[k].sign > 0 ? letter : -letter;
    }
    const int first = shape.coordinates + shape.drives;
    for (int i = 0; i < shape.parameters; ++i) values[first + i] = theta[view.first_parameter + i];
    for (int i = 0; i < shape.modes; ++i) {
      values[first + shape.parameters + i] = view.modes[static_cast<std::size_t>(i)];
    }
    const std::vector<Expression> with_numbers = Substitute(*positions, values);
    for (std::size_t i = 0; i < with_numbers.size(); ++i) {
      const std::string& name =
          machine.drives()[static_cast<std::size_t>(view.first_drive) + i].name;
      raw[static_cast<std::size_t>(view.first_drive) + i] =
          reading(with_numbers[i], name, view.block->drives[i].sign);
    }
  }
  if (!complaints.empty()) return tl::unexpected(std::move(complaints));
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const kinematics::Drive& drive = machine.drives()[i];
    if (!Wanted(options.drives, drive.name)) continue;
    out.drives.push_back({drive.name, drive.rotary, Finish(raw[i], options, out.variables.size())});
  }
  return out;
}

std::string FormulaText(const MachineFormulas& formulas, const FormulaOptions& options) {
  std::string text;
  for (const DriveFormula& drive : formulas.drives) {
    const std::vector<NamedExpression> one{{drive.drive, drive.expression}};
    text += ToText(one, TextOptionsOf(formulas, options)) + "\n";
  }
  return text;
}

std::string FormulaLatex(const MachineFormulas& formulas, const FormulaOptions& options) {
  std::string text = "\\begin{align*}\n";
  for (std::size_t i = 0; i < formulas.drives.size(); ++i) {
    const std::string& full = formulas.drives[i].drive;
    const std::size_t dot = full.rfind('.');
    const LatexOptions latex{.names = formulas.variables, .digits = options.digits};
    // A drive's own name is enough where one mechanism is exported.
    const std::string name = dot == std::string::npos ? full : full.substr(dot + 1);
    text += fmt::format("{}_{{{}}} &= {}{}\n",
                        name.substr(0, 1),
                        name.size() > 1 ? name.substr(1) : "",
                        ToLatex(formulas.drives[i].expression, latex),
                        i + 1 < formulas.drives.size() ? " \\\\" : "");
  }
  return text + "\\end{align*}\n";
}

std::string FormulaC(const MachineFormulas& formulas, const kinematics::Machine& machine) {
  std::vector<NamedExpression> named;
  for (std::size_t i = 0; i < formulas.drives.size(); ++i) {
    named.push_back({fmt::format("drives[{}]", i), formulas.drives[i].expression});
  }
  COptions options;
  options.function_name.clear();
  for (std::size_t i = 0; i < formulas.variables.size(); ++i) {
    options.names.push_back(fmt::format("coordinates[{}]", i));
  }
  const Parsed<std::string> body = ToC(named, options);
  std::string text = fmt::format(
      "/* {}: drive readings from virtual coordinates (mm and rad). */\n", machine.layout().name);
  text += "#include <math.h>\n\n";
  std::string name = "machine";
  if (const std::string stem = machine.layout().file.stem().string(); !stem.empty()) {
    name = stem;
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    if (std::isdigit(static_cast<unsigned char>(name[0])) != 0) name.insert(0, "m");
  }
  text += fmt::format("/* coordinates: {} */\n", fmt::join(formulas.coordinates, ", "));
  std::vector<std::string> drive_names;
  for (const DriveFormula& drive : formulas.drives) drive_names.push_back(drive.drive);
  text += fmt::format("/* drives: {} */\n", fmt::join(drive_names, ", "));
  text += "/* Returns 0, or -1 when a drive is out of reach (its value is then not a number). */\n";
  text += fmt::format("int {}_inverse(const double coordinates[], double drives[]) {{\n", name);
  text += body ? *body : std::string();
  text += fmt::format(
      "  for (int i = 0; i < {}; ++i) {{\n    if (!isfinite(drives[i])) return -1;\n  }}\n  return "
      "0;\n}}\n",
      formulas.drives.size());
  return text;
}

}  // namespace kompono::exporting
