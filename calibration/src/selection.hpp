// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_SRC_SELECTION_HPP_
#define KOMPONO_CALIBRATION_SRC_SELECTION_HPP_

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "kompono/calibration/identification.hpp"

namespace kompono::calibration {

/// The unknowns: u_i = (θ_i - nominal_i) / scale_i, so that one unit of each is about as likely.
struct Selection {
  std::vector<kinematics::Parameter> parameters;  ///< of θ: the machine's and the fixtures'
  std::vector<int> free;                          ///< indices into θ, ascending
  Eigen::VectorXd scale;                          ///< mm or rad per unit of u
  Eigen::VectorXd nominal;                        ///< of the whole θ
  std::vector<std::optional<double>> prior;       ///< standard deviation; mm, rad
  std::vector<std::optional<std::array<double, 2>>> bounds;  ///< mm, rad

  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(free.size()); }
  [[nodiscard]] Eigen::VectorXd Theta(const double* u) const;
  [[nodiscard]] Eigen::VectorXd Unknowns(const Eigen::VectorXd& theta) const;
};

/// Which numbers may change, from the options, the layout and the format of the measurements.
[[nodiscard]] Parsed<Selection> SelectUnknowns(const kinematics::Machine& machine,
                                               const MeasurementSet& set,
                                               const IdentifyOptions& options);

/// A pattern may use every form of a name that layouts accept.
[[nodiscard]] bool NamesParameter(const kinematics::Machine& machine,
                                  std::string_view pattern,
                                  const std::string& name);

/// E0431, with what was perhaps meant.
[[nodiscard]] Diagnostic UnknownPattern(const kinematics::Machine& machine,
                                        std::string_view pattern,
                                        std::string_view where);

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_SRC_SELECTION_HPP_
