// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPRESSION_SRC_NOTATION_HPP_
#define KOMPONO_EXPRESSION_SRC_NOTATION_HPP_

#include "graph.hpp"
#include "pool.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kompono/expression/printing.hpp"

namespace kompono::expression_internal {

/// How numbers, products and powers are spelled.
struct Notation {
  bool latex = false;
  int digits = 6;
  int decimals = -1;
  std::string times = "*";
  PowerStyle powers = PowerStyle::kCaret;
};

/// Digits as people want them: whole numbers whole, else `decimals` decimals or `digits`
/// significant digits.
[[nodiscard]] std::string FormatNumber(double value, const Notation& notation);

/// q1 becomes q_{1}, theta \theta, other names of several letters upright.
[[nodiscard]] std::string LatexName(const std::string& name);

/// The names of variables by number: `given`, else the formula's own, else x<number>.
class VariableNames {
 public:
  VariableNames(const std::vector<std::string>& given, const Names& own)
      : given_(given), own_(own) {}
  [[nodiscard]] std::string operator[](int number) const;

 private:
  const std::vector<std::string>& given_;
  const Names& own_;
};

/// Nodes that get a line of their own: the name by node, empty for what is written where it is
/// used.
using PartNames = std::vector<std::string>;

/// Writes node `root` of a graph in infix notation; a named part is written as its name, but for
/// the root itself. Variables and parts are named in the spelling of the notation.
[[nodiscard]] std::string WriteInfix(const Graph& graph,
                                     Index root,
                                     const Notation& notation,
                                     const VariableNames& variables,
                                     const PartNames& parts);

}  // namespace kompono::expression_internal

#endif  // KOMPONO_EXPRESSION_SRC_NOTATION_HPP_
