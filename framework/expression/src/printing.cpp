// SPDX-License-Identifier: Apache-2.0
#include "kompono/expression/printing.hpp"

#include "notation.hpp"
#include "pool.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "kompono/expression/polynomial.hpp"

namespace kompono {
namespace {

using expression_internal::Access;
using expression_internal::Graph;
using expression_internal::Index;
using expression_internal::LatexName;
using expression_internal::Local;
using expression_internal::Node;
using expression_internal::Notation;
using expression_internal::OperandCount;
using expression_internal::PartNames;
using expression_internal::Reachable;
using expression_internal::VariableNames;
using expression_internal::WriteInfix;

// Shorter parts are easier read again than looked up.
constexpr uint32_t kLeastPart = 2;

/// What the two kinds of infix text have in common.
struct Layout {
  Notation notation;
  const std::vector<std::string>& names;
  bool expand = false;
  bool shared = false;
  std::string part_name;
  double most_operations = 0.0;
};

/// How many operands of a node are written out: the square of a sum, written as power, contains the
/// sum once.
int WrittenOperands(const Node& node, const Notation& notation) {
  const bool has_powers = notation.latex || notation.powers != PowerStyle::kProduct;
  const bool is_square = node.operation == KOMPONO_MULTIPLY && node.operand[0] == node.operand[1];
  return has_powers && is_square ? 1 : OperandCount(node.operation);
}

std::vector<uint32_t> WrittenUses(const Graph& graph,
                                  std::span<const Index> roots,
                                  const Notation& notation) {
  const std::vector<bool> reached = Reachable(graph.nodes(), roots);
  std::vector<uint32_t> uses(graph.size(), 0);
  for (const Index root : roots) ++uses[static_cast<std::size_t>(root)];
  for (std::size_t i = 0; i < graph.size(); ++i) {
    const Node& node = graph.nodes()[i];
    if (!reached[i]) continue;
    for (int k = 0; k < WrittenOperands(node, notation); ++k) {
      ++uses[static_cast<std::size_t>(node.operand[k])];
    }
  }
  return uses;
}

double WrittenOperations(const Graph& graph,
                         std::span<const Index> roots,
                         const Notation& notation) {
  std::vector<double> written(graph.size(), 0.0);
  for (std::size_t i = 0; i < graph.size(); ++i) {
    const Node& node = graph.nodes()[i];
    const int count = WrittenOperands(node, notation);
    if (count > 0) written[i] = 1.0;
    for (int k = 0; k < count; ++k)
      written[i] += written[static_cast<std::size_t>(node.operand[k])];
  }
  double sum = 0.0;
  for (const Index root : roots) sum += written[static_cast<std::size_t>(root)];
  return sum;
}

std::vector<Index> NameParts(const Graph& graph,
                             std::span<const Index> roots,
                             const Layout& layout,
                             const VariableNames& variables,
                             PartNames* names) {
  std::set<std::string> taken;
  for (const Node& node : graph.nodes()) {
    if (node.operation == KOMPONO_VARIABLE) taken.insert(variables[node.operand[0]]);
  }
  const std::vector<uint32_t> uses = WrittenUses(graph, roots, layout.notation);
  names->assign(graph.size(), {});
  std::vector<Index> parts;
  int number = 0;
  for (std::size_t i = 0; i < graph.size(); ++i) {
    const auto place = static_cast<Index>(i);
    if (uses[i] < 2 || graph.facts(place).complexity < kLeastPart) continue;
    std::string name;
    do {
      name = fmt::format("{}{}", layout.part_name, ++number);
    } while (taken.contains(name));
    (*names)[i] = std::move(name);
    parts.push_back(place);
  }
  return parts;
}

struct Line {
  std::string name, text;  // the name may be empty
};

std::vector<Line> WriteLines(std::span<const NamedExpression> expressions, const Layout& layout) {
  std::vector<Expression> formulas;
  for (const NamedExpression& each : expressions) {
    const Expression& formula = each.expression;
    formulas.push_back(layout.expand && !formula.IsCondition()
                           ? ExpandUnderRoots(formula, formula.Variables())
                           : formula);
  }
  const Local local = Access::Gather(formulas);
  const VariableNames variables(layout.names, local.names);
  PartNames names;
  std::vector<Index> parts;
  const double written = WrittenOperations(local.graph, local.roots, layout.notation);
  if (layout.shared || written > layout.most_operations) {
    parts = NameParts(local.graph, local.roots, layout, variables, &names);
  }
  std::vector<Line> lines;
  lines.reserve(parts.size() + expressions.size());
  for (const Index part : parts) {
    lines.push_back({names[static_cast<std::size_t>(part)],
                     WriteInfix(local.graph, part, layout.notation, variables, names)});
  }
  for (std::size_t k = 0; k < expressions.size(); ++k) {
    const Index root = local.roots[k];
    const bool is_part = !names.empty() && !names[static_cast<std::size_t>(root)].empty();
    lines.push_back({expressions[k].name,
                     is_part ? names[static_cast<std::size_t>(root)]
                             : WriteInfix(local.graph, root, layout.notation, variables, names)});
    if (is_part && layout.notation.latex) lines.back().text = LatexName(lines.back().text);
  }
  return lines;
}

std::string JoinText(const std::vector<Line>& lines) {
  std::string text;
  for (const Line& line : lines) {
    if (!text.empty()) text += '\n';
    text += line.name.empty() ? line.text : fmt::format("{} = {}", line.name, line.text);
  }
  return text;
}

std::string JoinLatex(const std::vector<Line>& lines) {
  const auto written = [](const Line& line, std::string_view align) {
    return line.name.empty() ? fmt::format("{}{}", align, line.text)
                             : fmt::format("{} {}= {}", LatexName(line.name), align, line.text);
  };
  if (lines.size() == 1) return written(lines.front(), "");
  std::string text = "\\begin{aligned}\n";
  for (std::size_t k = 0; k < lines.size(); ++k) {
    text += written(lines[k], "&") + (k + 1 < lines.size() ? " \\\\\n" : "\n");
  }
  return text + "\\end{aligned}";
}

Layout LayoutOf(const TextOptions& options) {
  return {.notation = {.latex = false,
                       .digits = options.digits,
                       .decimals = options.decimals,
                       .times = options.times,
                       .powers = options.powers},
          .names = options.names,
          .expand = options.expand,
          .shared = options.shared,
          .part_name = options.part_name,
          .most_operations = options.most_operations};
}

Layout LayoutOf(const LatexOptions& options) {
  return {.notation = {.latex = true, .digits = options.digits, .decimals = options.decimals},
          .names = options.names,
          .expand = options.expand,
          .shared = options.shared,
          .part_name = options.part_name,
          .most_operations = options.most_operations};
}

}  // namespace

std::string ToText(const Expression& expression, const TextOptions& options) {
  const NamedExpression nameless{{}, expression};
  return ToText({&nameless, 1}, options);
}

std::string ToText(std::span<const NamedExpression> expressions, const TextOptions& options) {
  return JoinText(WriteLines(expressions, LayoutOf(options)));
}

std::string ToLatex(const Expression& expression, const LatexOptions& options) {
  const NamedExpression nameless{{}, expression};
  return ToLatex({&nameless, 1}, options);
}

std::string ToLatex(std::span<const NamedExpression> expressions, const LatexOptions& options) {
  return JoinLatex(WriteLines(expressions, LayoutOf(options)));
}

}  // namespace kompono
