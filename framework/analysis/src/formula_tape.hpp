// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_FORMULA_TAPE_HPP_
#define KOMPONO_ANALYSIS_FORMULA_TAPE_HPP_

#include "interval.hpp"

#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "kompono/plugin/interfaces.hpp"

namespace kompono::analysis {

/// Formulas that plugins recorded, to be evaluated over boxes: parts that no varied coordinate
/// reaches are computed once, equal parts of all recordings once per box.
class FormulaTape {
 public:
  using Slot = std::int32_t;

  /// The varied coordinate `direction`; slopes are known by the first three only.
  [[nodiscard]] Slot Varied(std::size_t direction);
  [[nodiscard]] Slot Constant(double value);
  [[nodiscard]] Slot Negative(Slot a);

  /// Records `quantity` of `mechanism` with its variables (x, q, θ, modes) bound to slots; the
  /// slots of the roots, none if the module cannot record it or sends what is no formula.
  [[nodiscard]] std::vector<Slot> Record(const plugin::Mechanism& mechanism,
                                         plugin::Quantity quantity,
                                         bool with_derivatives,
                                         std::span<const Slot> variables);

  /// One thread's values, slot by slot.
  using Values = std::vector<Slope>;
  [[nodiscard]] Values MakeValues() const;
  /// `at` gives the box, direction by direction. Without `slopes` the derivatives are left as they
  /// were.
  void Evaluate(std::span<const Interval> at, bool slopes, Values& values) const;

  [[nodiscard]] std::size_t size() const { return instructions_.size(); }

 private:
  struct Instruction {
    std::int32_t operation = 0;
    std::array<Slot, 3> operand{-1, -1, -1};
    bool active = false;  ///< depends on a varied coordinate
    auto operator<=>(const Instruction&) const = default;
  };
  [[nodiscard]] Slot Add(const Instruction& instruction, double constant = 0.0);
  [[nodiscard]] bool Import(std::span<const KomponoExpressionNode> nodes,
                            std::span<const std::int32_t> roots,
                            std::span<const Slot> variables,
                            std::vector<Slot>& out);
  static void Apply(const Instruction& instruction, bool slopes, Values& values, Slot to);

  std::vector<Instruction> instructions_;
  std::vector<Slope> constants_;  ///< per slot; what is not active has its value here
  std::vector<Slot> active_;      ///< in order
  std::vector<Slot> varied_;      ///< per direction, -1: not made
  std::map<std::tuple<std::int32_t, Slot, Slot, Slot>, Slot> known_;
  std::map<double, Slot> known_constants_;
};

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_FORMULA_TAPE_HPP_
