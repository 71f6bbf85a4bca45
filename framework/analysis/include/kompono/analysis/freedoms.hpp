// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_FREEDOMS_HPP_
#define KOMPONO_ANALYSIS_FREEDOMS_HPP_

#include <optional>
#include <string>
#include <vector>

#include "kompono/kinematics/machine.hpp"

/// Which of the six motions of a platform its struts can meet. Four struts hold four of the six;
/// there are fifteen choices, and most of them are singular (KDD's own choice for its four-strut
/// lathe among them).
namespace kompono::analysis {

struct FreedomChoice {
  std::string letters;     ///< "YZBC", along and about the axes of the machine's base
  double condition = 0.0;  ///< of the struts' lines in these coordinates; infinite if singular
};

struct BlockFreedoms {
  std::string block;
  std::string module;
  int struts = 0;                      ///< that end on the platform
  double length_mm = 0.0;              ///< what a radian counts
  std::vector<FreedomChoice> choices;  ///< best first; empty if not every drive has a strut of its
                                       ///< own that ends on the platform
};

/// Every choice of as many coordinates as there are struts, judged at the machine's coordinates z.
/// Rotations are about the platform's tool point. Without `length_mm` a radian counts the root mean
/// square distance of the struts' joints from there.
[[nodiscard]] std::vector<BlockFreedoms> Freedoms(const kinematics::Machine& machine,
                                                  const kinematics::VectorXd& z,
                                                  std::optional<double> length_mm = std::nullopt);

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_FREEDOMS_HPP_
