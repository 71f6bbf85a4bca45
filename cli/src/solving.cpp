// SPDX-License-Identifier: Apache-2.0
#include "solving.hpp"

#include "text.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kompono/analysis/pose_judge.hpp"

namespace kompono::cli {
namespace {

using kinematics::Machine;
using kinematics::SolveStatus;

/// A limit that is reached exactly is kept: readings carry rounding.
constexpr double kSlack = 1e-9;

void CheckLimit(std::string_view what,
                const std::string& name,
                bool angle,
                double value,
                const std::optional<double>& lower,
                const std::optional<double>& upper,
                std::vector<std::string>& out) {
  const auto complain = [&](std::string_view side, double limit) {
    out.push_back(fmt::format("{} {} at {} {} lies {} its limit {} {}",
                              what,
                              name,
                              Fixed(Outward(value, angle)),
                              UnitOf(angle),
                              side,
                              Brief(Outward(limit, angle)),
                              UnitOf(angle)));
  };
  if (lower && value < *lower - kSlack) complain("below", *lower);
  if (upper && value > *upper + kSlack) complain("above", *upper);
}

bool LimitsStruts(const layout::Block& block) {
  return !block.joints.empty() || block.strut_diameter || block.clearance;
}

/// Swings of passive joints and clearances between struts, where the layout limits them.
void CheckStruts(const Machine& machine,
                 const kinematics::Solution& solution,
                 std::vector<std::string>& out) {
  const auto& blocks = machine.layout().blocks;
  if (std::none_of(blocks.begin(), blocks.end(), LimitsStruts)) return;
  const auto judge = analysis::PoseJudge::Make(machine, machine.nominal(), {});
  if (!judge) {  // a joint on a body whose directions are not known
    for (const Diagnostic& problem : judge.error()) out.push_back(problem.message);
    return;
  }
  for (const auto& broken : analysis::BrokenStrutLimits(*judge, solution.coordinates)) {
    const bool swing = broken.constraint->kind == analysis::Constraint::Kind::kSwing;
    out.push_back(swing ? fmt::format("{} by {} deg lies above its limit {} deg",
                                      broken.constraint->name,
                                      Fixed(Outward(broken.value, true)),
                                      Brief(Outward(broken.limit, true)))
                        : fmt::format("{}: their centre lines are {} mm apart and must keep {} mm",
                                      broken.constraint->name,
                                      Fixed(broken.value),
                                      Brief(broken.limit)));
  }
}

std::vector<std::string> Limits(const Machine& machine, const kinematics::Solution& solution) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < machine.drives().size(); ++i) {
    const kinematics::Drive& drive = machine.drives()[i];
    CheckLimit("drive",
               drive.name,
               drive.rotary,
               solution.drives[static_cast<Eigen::Index>(i)],
               drive.lower,
               drive.upper,
               out);
  }
  for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
    const kinematics::Coordinate& coordinate = machine.coordinates()[i];
    // A plain axis is its own drive and was judged as such.
    if (machine.FindDrive(coordinate.name) >= 0) continue;
    CheckLimit("coordinate",
               coordinate.name,
               coordinate.rotary,
               solution.coordinates[static_cast<Eigen::Index>(i)],
               coordinate.lower,
               coordinate.upper,
               out);
  }
  CheckStruts(machine, solution, out);
  return out;
}

}  // namespace

ExitCode SolvedPose::Exit() const {
  switch (solution.status) {
    case SolveStatus::kOutOfReach:
    case SolveStatus::kOverdetermined:
      return ExitCode::kNegative;
    case SolveStatus::kNoConvergence:
    case SolveStatus::kSingular:
    case SolveStatus::kAmbiguous:
    case SolveStatus::kOtherAssemblyMode:
      return ExitCode::kNoSolution;
    case SolveStatus::kConverged:
      break;
  }
  if (Summary(singularities).type != 0) return ExitCode::kNoSolution;
  return limits.empty() ? ExitCode::kOk : ExitCode::kNegative;
}

std::string SolvedPose::Status() const {
  if (!solution.ok() || Exit() == ExitCode::kOk) return std::string(Name(solution.status));
  return Summary(singularities).type != 0 ? std::string(Name(SolveStatus::kSingular))
                                          : "outside limits";
}

std::string SolvedPose::Message() const {
  if (!solution.ok()) return solution.message;
  std::vector<std::string> sentences;
  if (const int type = Summary(singularities).type; type != 0)
    sentences.push_back(fmt::format("the pose is singular ({})", SingularityName(type)));
  sentences.insert(sentences.end(), limits.begin(), limits.end());
  return Joined(sentences, "; ");
}

SolvedPose Solve(const Machine& machine, const Question& question, bool details) {
  const Eigen::VectorXd theta = machine.nominal();
  SolvedPose out;
  out.solution = question.pose ? machine.Inverse(*question.pose, theta, question.start)
                               : machine.Forward(question.readings.value(), theta, question.start);
  const kinematics::Solution& solution = out.solution;
  out.pose = kinematics::NumbersFromPose(solution.X_WT, question.order);
  out.complete = solution.coordinates.allFinite() && solution.drives.allFinite();
  if (!out.complete) return out;
  if (solution.ok()) out.limits = Limits(machine, solution);
  out.singularities = machine.Singularities(solution.coordinates, theta);
  if (!details) return out;
  std::array<bool, 6> wanted{};
  for (std::size_t k = 0; question.pose && k < 6; ++k)
    wanted[k] = question.pose->component[k].has_value();
  out.jacobian = JacobianOf(machine, solution.coordinates, question.order, wanted);
  out.struts = Struts(machine.Skeleton(solution.coordinates, theta));
  return out;
}

}  // namespace kompono::cli
