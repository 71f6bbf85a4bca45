// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_SOLVING_HPP_
#define KOMPONO_CLI_SOLVING_HPP_

#include "console.hpp"
#include "exit_code.hpp"
#include "jacobian.hpp"
#include "machine_sheet.hpp"
#include <nlohmann/json_fwd.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kompono/kinematics/machine.hpp"

/// One pose solved and everything worth telling about it; `kompono solve` and its tables use it.
namespace kompono::cli {

/// What is asked: pose components or drive readings; mm, rad.
struct Question {
  std::optional<kinematics::PoseTarget> pose;  ///< inverse
  std::optional<Eigen::VectorXd> readings;     ///< forward
  layout::RotationOrder order = layout::RotationOrder::kXYZ;
  Eigen::VectorXd start;  ///< z
};

struct SolvedPose {
  kinematics::Solution solution;
  kinematics::PoseNumbers pose;
  std::vector<std::string> limits;  ///< each limit that is not kept, as a sentence
  bool complete = false;            ///< coordinates and drives are numbers; else the rest is empty
  std::vector<kinematics::Singularity> singularities;
  DriveJacobian jacobian;
  std::vector<Strut> struts;

  /// kSingular when a solution was found at a singular pose.
  [[nodiscard]] ExitCode Exit() const;
  /// "converged", "outside limits", "singular", or the solver's own word.
  [[nodiscard]] std::string Status() const;
  /// What happened, for people; empty when all is well.
  [[nodiscard]] std::string Message() const;
};

/// `details`: Jacobian and struts too.
[[nodiscard]] SolvedPose Solve(const kinematics::Machine& machine,
                               const Question& question,
                               bool details = true);

[[nodiscard]] nlohmann::ordered_json SolvedJson(const kinematics::Machine& machine,
                                                const SolvedPose& solved);
[[nodiscard]] std::string SolvedText(const Console& console,
                                     const kinematics::Machine& machine,
                                     const SolvedPose& solved,
                                     layout::RotationOrder order);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_SOLVING_HPP_
