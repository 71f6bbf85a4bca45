// SPDX-License-Identifier: Apache-2.0
#include "graph.hpp"
#include "pool.hpp"

#include <algorithm>

#include "kompono/diagnostics/expects.hpp"
#include "kompono/expression/expression.hpp"

namespace kompono {

using expression_internal::Access;
using expression_internal::Local;
using expression_internal::OperandCount;

ExpressionProgram::ExpressionProgram(std::span<const Expression> roots) {
  Local local = Access::Gather(roots);
  nodes_.assign(local.graph.nodes().begin(), local.graph.nodes().end());
  roots_ = std::move(local.roots);
  for (const KomponoExpressionNode& node : nodes_) {
    if (node.operation == KOMPONO_VARIABLE) {
      variable_count_ = std::max(variable_count_, static_cast<std::size_t>(node.operand[0]) + 1);
    }
  }
}

void ExpressionProgram::Evaluate(std::span<const double> variables,
                                 std::span<double> results) const {
  KOMPONO_EXPECTS(variables.size() >= VariableCount());
  KOMPONO_EXPECTS(results.size() == RootCount());
  std::vector<double> values(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const KomponoExpressionNode& node = nodes_[i];
    if (node.operation == KOMPONO_CONSTANT) {
      values[i] = node.value;
    } else if (node.operation == KOMPONO_VARIABLE) {
      values[i] = variables[static_cast<std::size_t>(node.operand[0])];
    } else {
      const int count = OperandCount(node.operation);
      const double a = values[static_cast<std::size_t>(node.operand[0])];
      const double b = count > 1 ? values[static_cast<std::size_t>(node.operand[1])] : 0.0;
      const double c = count > 2 ? values[static_cast<std::size_t>(node.operand[2])] : 0.0;
      values[i] = expression_internal::Compute(node.operation, a, b, c);
    }
  }
  for (std::size_t k = 0; k < roots_.size(); ++k) {
    results[k] = values[static_cast<std::size_t>(roots_[k])];
  }
}

std::vector<double> Evaluate(std::span<const Expression> roots, std::span<const double> variables) {
  std::vector<double> results(roots.size());
  ExpressionProgram(roots).Evaluate(variables, results);
  return results;
}

}  // namespace kompono
