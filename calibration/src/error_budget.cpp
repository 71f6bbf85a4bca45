// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/error_budget.hpp"

#include "pose_worker.hpp"
#include "selection.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>

#include "kompono/calibration/codes.hpp"
#include "kompono/calibration/simulation.hpp"

namespace kompono::calibration {
namespace {

/// N/mm of a kilogram that is accelerated by a millimetre per second squared.
constexpr double kNewtonPerKgMm = 1e-3;

class BudgetMaker {
 public:
  BudgetMaker(const kinematics::Machine& machine, const BudgetOptions& options)
      : machine_(machine), options_(options) {}

  Parsed<Budget> Run() {
    if (!ChooseErrors() || !DrawPoses()) return tl::unexpected(std::move(complaints_));
    if (options_.mass_kg > 0.0 && !ReadDrives()) return tl::unexpected(std::move(complaints_));
    PoseWorker worker(machine_,
                      poses_,
                      free_,
                      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(machine_.drives().size())));
    worker.SetGeometry(machine_.nominal());
    for (PoseRow& row : rows_) {
      if (worker.FindStart(machine_.nominal(), nullptr, &row) ==
          kinematics::SolveStatus::kConverged) {
        Collect(worker, &row);
      }
    }
    Budget budget = Summed();
    budget.monte_carlo_mm = MonteCarlo(worker);
    AddDynamics(&budget);
    return budget;
  }

 private:
  void Complain(std::string code, std::string message, std::string help) {
    complaints_.push_back({.code = std::move(code),
                           .file = machine_.layout().file.string(),
                           .message = std::move(message),
                           .help = std::move(help)});
  }

  bool ChooseErrors() {
    const std::vector<kinematics::Parameter>& parameters = machine_.parameters();
    Eigen::VectorXd sigma(static_cast<Eigen::Index>(parameters.size()));
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      sigma[static_cast<Eigen::Index>(i)] = parameters[i].tolerance;
    }
    for (const auto& [pattern, value] : options_.sigma) {
      bool any = false;
      for (std::size_t i = 0; i < parameters.size(); ++i) {
        if (!NamesParameter(machine_, pattern, parameters[i].name)) continue;
        sigma[static_cast<Eigen::Index>(i)] = value;
        any = true;
      }
      if (!any) complaints_.push_back(UnknownPattern(machine_, pattern, "sigma"));
    }
    if (options_.change) sigma = *options_.change;
    for (Eigen::Index i = 0; i < sigma.size(); ++i) {
      if (sigma[i] == 0.0) continue;
      free_.push_back(static_cast<int>(i));
      sigma_.push_back(sigma[i]);
    }
    if (free_.empty() && options_.mass_kg == 0.0 && complaints_.empty()) {
      Complain(codes::kNothingFree.code,
               "no number of the geometry has a tolerance, so that there is nothing to add up",
               "give deviations: --sigma 'open_base.x=0.3,tool.tube_offset=0.05'");
    }
    return complaints_.empty();
  }

  bool DrawPoses() {
    SimulateOptions draw;
    draw.count = options_.poses;
    draw.seed = options_.seed;
    draw.region = options_.region;
    Parsed<MeasurementSet> poses = Simulate(machine_, machine_, machine_.nominal(), draw);
    if (!poses) {
      complaints_ = std::move(poses.error());
      return false;
    }
    poses_ = std::move(*poses);
    for (const Measurement& m : poses_.measurements) {
      rows_.push_back({.measurement = &m, .sigma_mm = 1.0, .sigma_rad = 1.0});
    }
    return true;
  }

  bool ReadDrives() {
    compliance_.resize(static_cast<Eigen::Index>(machine_.drives().size()));
    double slowest = 0.0;
    for (std::size_t i = 0; i < machine_.drives().size(); ++i) {
      const kinematics::Drive& drive = machine_.drives()[i];
      // A drive without stiffness in the layout is taken as stiff: its share is not known.
      compliance_[static_cast<Eigen::Index>(i)] = drive.stiffness ? 1.0 / *drive.stiffness : 0.0;
      if (!drive.acceleration || !drive.stiffness) continue;
      slowest = slowest == 0.0 ? *drive.acceleration : std::min(slowest, *drive.acceleration);
    }
    acceleration_ = options_.acceleration.value_or(slowest);
    if (!compliance_.isZero(0.0) && acceleration_ > 0.0) return true;
    Complain(codes::kNoStiffness.code,
             "the dynamic error needs the stiffness and the acceleration of at least one drive",
             "give stiffness (N/um) and acceleration (mm/s2) in the layout's drives, or "
             "--acceleration");
    return false;
  }

  /// Tool by numbers and by readings at one pose.
  void Collect(PoseWorker& worker, PoseRow* row) {
    Eigen::Matrix<double, 6, Eigen::Dynamic> twists;
    if (!worker.ToolByParameters(row, &twists)) return;
    const auto n = static_cast<Eigen::Index>(free_.size());
    Eigen::MatrixXd at(3, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      at.col(i) = twists.col(i).head<3>() * sigma_[static_cast<std::size_t>(i)];
    }
    effects_.push_back(std::move(at));
    kept_.push_back(row);
    if (options_.mass_kg == 0.0) return;
    const Eigen::MatrixXd G = worker.tool_by_readings().topRows<3>();
    const Eigen::Matrix3d give = G * compliance_.asDiagonal() * G.transpose();
    const double compliance =
        options_.direction
            ? options_.direction->normalized().dot(give * options_.direction->normalized())
            : Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(give).eigenvalues()[2];
    dynamic_.push_back(compliance * options_.mass_kg * acceleration_ * kNewtonPerKgMm);
  }

  [[nodiscard]] Budget Summed() const {
    Budget budget;
    const auto count = static_cast<double>(std::max<std::size_t>(1, effects_.size()));
    std::array<double, 3> square{};
    double whole = 0.0;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const kinematics::Parameter& parameter =
          machine_.parameters()[static_cast<std::size_t>(free_[i])];
      Contribution c{.name = parameter.name,
                     .part = PartOf(machine_, parameter.name),
                     .sigma = sigma_[i],
                     .angle = parameter.angle};
      double sum = 0.0;
      for (const Eigen::MatrixXd& effect : effects_) {
        sum += effect.col(k).squaredNorm();
        c.max_mm = std::max(c.max_mm, effect.col(k).norm());
      }
      c.rms_mm = std::sqrt(sum / count);
      if (c.rms_mm > 1e-9) budget.contributions.push_back(std::move(c));
    }
    std::sort(budget.contributions.begin(),
              budget.contributions.end(),
              [](const Contribution& a, const Contribution& b) { return a.rms_mm > b.rms_mm; });
    for (const Eigen::MatrixXd& effect : effects_) {
      // Independent deviations add as squares, the known errors of one machine as vectors.
      std::array<Eigen::Vector3d, 3> sum{
          Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
      for (std::size_t i = 0; i < free_.size(); ++i) {
        const auto part = static_cast<std::size_t>(
            PartOf(machine_, machine_.parameters()[static_cast<std::size_t>(free_[i])].name));
        const Eigen::Vector3d one = effect.col(static_cast<Eigen::Index>(i));
        if (options_.change) {
          sum[part] += one;
        } else {
          square[part] += one.squaredNorm() / count;
        }
      }
      if (!options_.change) continue;
      for (std::size_t part = 0; part < 3; ++part) square[part] += sum[part].squaredNorm() / count;
      whole += (sum[0] + sum[1] + sum[2]).squaredNorm() / count;
    }
    for (std::size_t part = 0; part < 3; ++part) budget.part_mm[part] = std::sqrt(square[part]);
    budget.geometry_mm = std::sqrt(options_.change ? whole : square[0] + square[1] + square[2]);
    return budget;
  }

  /// Machines with drawn (or the known) errors, each driven to the same readings.
  double MonteCarlo(PoseWorker& worker) {
    if (free_.empty()) return 0.0;
    std::mt19937_64 random(options_.seed);
    std::normal_distribution<double> normal;
    double sum = 0.0;
    int count = 0;
    const int samples = options_.change ? 1 : options_.samples;
    for (int s = 0; s < samples; ++s) {
      Eigen::VectorXd theta = machine_.nominal();
      for (std::size_t i = 0; i < free_.size(); ++i) {
        theta[free_[i]] += sigma_[i] * (options_.change ? 1.0 : normal(random));
      }
      worker.SetGeometry(theta);
      for (PoseRow* row : kept_) {
        if (!worker.Linearise(row, false, true)) continue;
        sum += worker.errors().value.squaredNorm();
        ++count;
      }
    }
    return count > 0 ? std::sqrt(sum / count) : 0.0;
  }

  void AddDynamics(Budget* budget) const {
    double sum = 0.0;
    for (const double one : dynamic_) {
      sum += one * one / static_cast<double>(dynamic_.size());
      budget->dynamic_most_mm = std::max(budget->dynamic_most_mm, one);
    }
    if (!dynamic_.empty()) {
      budget->dynamic_least_mm = *std::min_element(dynamic_.begin(), dynamic_.end());
    }
    budget->dynamic_mm = std::sqrt(sum);
    budget->mechanism_mm = std::hypot(budget->part_mm[1], budget->dynamic_mm);
    budget->total_mm = std::hypot(budget->part_mm[0], budget->mechanism_mm, budget->part_mm[2]);
  }

  const kinematics::Machine& machine_;
  const BudgetOptions& options_;
  Diagnostics complaints_;
  std::vector<int> free_;
  std::vector<double> sigma_;
  MeasurementSet poses_;
  std::vector<PoseRow> rows_;
  std::vector<PoseRow*> kept_;
  std::vector<Eigen::MatrixXd> effects_;  ///< per pose, 3 x free numbers, mm
  std::vector<double> dynamic_;           ///< per pose, mm
  Eigen::VectorXd compliance_;            ///< mm/N
  double acceleration_ = 0.0;
};

}  // namespace

std::string_view Name(ErrorPart part) {
  switch (part) {
    case ErrorPart::kBase:
      return "base and part";
    case ErrorPart::kMechanism:
      return "mechanism";
    case ErrorPart::kTool:
      break;
  }
  return "tool";
}

ErrorPart PartOf(const kinematics::Machine& machine, std::string_view parameter) {
  if (parameter.starts_with("open_base.") || parameter.starts_with("part")) {
    return ErrorPart::kBase;
  }
  for (const layout::End& end : machine.layout().ends) {
    if (parameter.starts_with(end.name + ".")) return ErrorPart::kTool;
  }
  return ErrorPart::kMechanism;
}

Parsed<Budget> ErrorBudget(const kinematics::Machine& machine, const BudgetOptions& options) {
  return BudgetMaker(machine, options).Run();
}

}  // namespace kompono::calibration
