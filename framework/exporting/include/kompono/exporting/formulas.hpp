// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPORTING_FORMULAS_HPP_
#define KOMPONO_EXPORTING_FORMULAS_HPP_

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/expression/expression.hpp"
#include "kompono/kinematics/machine.hpp"

/// Control formulas: what each drive must read for given virtual coordinates, recorded from the
/// plugins' own code.
namespace kompono::exporting {

struct FormulaOptions {
  int digits = 6;      ///< significant digits in text and LaTeX; C always gets all
  bool expand = true;  ///< polynomials outside and under roots multiplied out and collected, as KSM
                       ///< prints them
  std::vector<std::string> drives;  ///< names of the drives wanted; empty: all
};

/// reading = expression of the variables `variables` (lower-case letters of the coordinates, mm and
/// rad).
struct DriveFormula {
  std::string drive;
  bool rotary = false;
  Expression expression;  ///< simplified; expanded if asked for
};

struct MachineFormulas {
  std::vector<std::string>
      variables;  ///< one per virtual coordinate, in their order: "x", "y", "a", or "drive_x"
  std::vector<std::string> coordinates;  ///< their full names
  std::vector<DriveFormula> drives;
};

[[nodiscard]] Parsed<MachineFormulas> DriveFormulas(const kinematics::Machine& machine,
                                                    const FormulaOptions& options);

/// "struts.q1 = 0.29618*x + … - 160.129", one line per drive.
[[nodiscard]] std::string FormulaText(const MachineFormulas& formulas,
                                      const FormulaOptions& options);
/// An align* block.
[[nodiscard]] std::string FormulaLatex(const MachineFormulas& formulas,
                                       const FormulaOptions& options);
/// A C99 file with `int NAME_inverse(const double coordinates[], double drives[])`; returns -1 when
/// out of reach.
[[nodiscard]] std::string FormulaC(const MachineFormulas& formulas,
                                   const kinematics::Machine& machine);
/// Per drive its text and, where the expression is polynomial + sign * sqrt(polynomial), the
/// coefficients by monomial.
[[nodiscard]] nlohmann::json FormulaJson(const MachineFormulas& formulas,
                                         const FormulaOptions& options);

}  // namespace kompono::exporting

#endif  // KOMPONO_EXPORTING_FORMULAS_HPP_
