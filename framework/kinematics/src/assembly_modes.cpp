// SPDX-License-Identifier: Apache-2.0
// All assembly modes for given drives: enumerated where a mechanism has closed forms, else searched
// for from many starts.
#include "machine_impl.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace kompono::kinematics {
namespace {

constexpr int kStarts = 512;    ///< in one round
constexpr int kIdleRounds = 4;  ///< as many rounds without a new mode end the search
constexpr int kMostRounds = 64;
constexpr double kSame = 1e-7;  ///< of the size: two solutions that are one

struct LocalMode {
  VectorXd x;
  std::vector<double> modes;
};

struct LocalModes {
  std::vector<LocalMode> found;
  bool complete = true;
  int starts = 0;
};

double SizeOf(const VectorXd& x) {
  return std::max(1e-300, x.cwiseAbs().maxCoeff());
}

/// Where a mechanism puts its platform: two coordinates that turn it alike are one solution.
VectorXd PlatformAt(const MechanismModel& mechanism, const VectorXd& x, const VectorXd& theta) {
  return Evaluate(mechanism, plugin::Quantity::kPlatform, x, VectorXd(), theta, {}).values;
}

/// Takes in what was not found before.
class Collection {
 public:
  Collection(const VectorXd& q, const VectorXd& x_home)
      : size_(std::max(SizeOf(q), SizeOf(x_home))) {}

  void Add(const MechanismModel& mechanism, const VectorXd& x, const VectorXd& theta) {
    const VectorXd platform = PlatformAt(mechanism, x, theta);  // rows of [R | p]
    const bool known = std::any_of(known_.begin(), known_.end(), [&](const Known& other) {
      if (other.modes != mechanism.modes) return false;
      double turned = 0.0;
      double moved = 0.0;
      for (Eigen::Index i = 0; i < platform.size(); ++i) {
        double& largest = i % 4 == 3 ? moved : turned;
        largest = std::max(largest, std::abs(platform[i] - other.platform[i]));
      }
      return moved < kSame * size_ && turned < kSame;
    });
    if (known) return;
    known_.push_back({platform, mechanism.modes});
    LocalMode mode{x, mechanism.modes};
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (IsRotaryLetter(mechanism.description->letters[static_cast<std::size_t>(i)])) {
        mode.x[i] = std::remainder(x[i], 2.0 * EIGEN_PI);
      }
    }
    found_.push_back(std::move(mode));
  }
  [[nodiscard]] std::size_t count() const { return found_.size(); }
  [[nodiscard]] std::vector<LocalMode> Take() { return std::move(found_); }

 private:
  struct Known {
    VectorXd platform;
    std::vector<double> modes;
  };
  double size_;
  std::vector<Known> known_;
  std::vector<LocalMode> found_;
};

/// Every combination of modes whose closed form closes the loops with the legs on their sides.
LocalModes FromClosedForm(const MechanismModel& mechanism,
                          const VectorXd& q,
                          const VectorXd& theta,
                          const VectorXd& x_home) {
  LocalModes out;
  MechanismModel model = mechanism;
  Collection collection(q, x_home);
  for (std::size_t signs = 0; signs < (std::size_t{1} << model.modes.size()); ++signs) {
    for (std::size_t i = 0; i < model.modes.size(); ++i) {
      model.modes[i] = ((signs >> i) & 1U) == 0 ? mechanism.modes[i] : -mechanism.modes[i];
    }
    const Evaluation at = Evaluate(model, plugin::Quantity::kCoordinates, x_home, q, theta, {});
    if (at.status == plugin::Status::kOk && ClosesOnItsModes(model, at.values, q, theta)) {
      collection.Add(model, at.values, theta);
    }
  }
  out.found = collection.Take();
  return out;
}

/// Starts all over the limits, or, without limits, all around home: translations by the size of the
/// machine, turns by a quarter.
MatrixXd Starts(const Machine::Impl& impl,
                const MechanismModel& mechanism,
                const VectorXd& q,
                const VectorXd& x_home,
                std::mt19937& random) {
  const LocalLimits limits = LimitsOf(impl, mechanism);
  const double size = std::max(SizeOf(q), SizeOf(x_home));
  MatrixXd starts(x_home.size(), kStarts);
  for (Eigen::Index i = 0; i < starts.rows(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double around = IsRotaryLetter(mechanism.description->letters[k]) ? EIGEN_PI / 2 : size;
    const bool limited =
        !limits.lower.empty() && std::isfinite(limits.lower[k]) && std::isfinite(limits.upper[k]);
    // Assembly modes do not keep to the limits: look as far again on either side.
    const double middle = limited ? (limits.lower[k] + limits.upper[k]) / 2.0 : x_home[i];
    const double half = limited ? limits.upper[k] - limits.lower[k] : around;
    std::uniform_real_distribution<double> within(middle - half, middle + half);
    for (Eigen::Index column = 0; column < starts.cols(); ++column) {
      starts(i, column) = column == 0 ? x_home[i] : within(random);
    }
  }
  return starts;
}

LocalModes FromManyStarts(const Machine::Impl& impl,
                          const MechanismModel& mechanism,
                          const VectorXd& q,
                          const VectorXd& theta,
                          const VectorXd& x_home) {
  LocalModes out{.complete = false};
  Collection collection(q, x_home);
  MechanismModel model = mechanism;
  for (std::size_t signs = 0; signs < (std::size_t{1} << model.modes.size()); ++signs) {
    for (std::size_t i = 0; i < model.modes.size(); ++i) {
      model.modes[i] = ((signs >> i) & 1U) == 0 ? mechanism.modes[i] : -mechanism.modes[i];
    }
    std::mt19937 random(1);  // the same answer every time
    for (int idle = 0, round = 0; idle < kIdleRounds && round < kMostRounds; ++round) {
      const std::size_t before = collection.count();
      const Followed followed = FollowFrom(model, q, theta, Starts(impl, model, q, x_home, random));
      if (followed.status != plugin::Status::kOk) return out;
      out.starts += kStarts;
      for (Eigen::Index k = 0; k < followed.x.cols(); ++k) {
        const VectorXd x = followed.x.col(k);
        if (ClosesOnItsModes(model, x, q, theta)) collection.Add(model, x, theta);
      }
      idle = collection.count() == before ? idle + 1 : 0;
    }
  }
  out.found = collection.Take();
  return out;
}

double DetA(const MechanismModel& mechanism,
            const VectorXd& x,
            const VectorXd& q,
            const VectorXd& theta) {
  const Evaluation at =
      Evaluate(mechanism, plugin::Quantity::kClosure, x, q, theta, {.by_coordinates = true});
  if (at.by_coordinates.rows() != at.by_coordinates.cols()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return ScaleJacobians(mechanism, at.by_coordinates, MatrixXd()).A.determinant();
}

}  // namespace

AssemblyModes Machine::AllForward(const VectorXd& readings, const VectorXd& theta) const {
  AssemblyModes out{.complete = true};
  AssemblyMode first;
  first.coordinates = home();
  SetAxes(*impl_, readings, theta, first.coordinates);
  out.found.push_back(first);
  for (const MechanismModel& mechanism : impl_->mechanisms) {
    if (mechanism.first_drive < 0) continue;
    const VectorXd q = DriveCoordinates(*impl_, mechanism, readings, theta);
    const VectorXd x_home = LocalCoordinates(*impl_, mechanism, home());
    const bool closed =
        Evaluate(mechanism, plugin::Quantity::kCoordinates, x_home, q, theta, {}).status ==
        plugin::Status::kOk;
    const LocalModes local = closed ? FromClosedForm(mechanism, q, theta, x_home)
                                    : FromManyStarts(*impl_, mechanism, q, theta, x_home);
    out.complete = out.complete && local.complete;
    out.starts += local.starts;
    std::vector<AssemblyMode> combined;
    for (const AssemblyMode& so_far : out.found) {
      for (const LocalMode& mode : local.found) {
        if (combined.size() == AssemblyModes::kMost) break;
        AssemblyMode next = so_far;
        const layout::Block& block = BlockOf(*impl_, mechanism);
        for (std::size_t i = 0; i < mechanism.coordinate.size(); ++i) {
          next.coordinates[mechanism.coordinate[i]] =
              block.letters[i].sign * mode.x[static_cast<Eigen::Index>(i)];
        }
        next.modes.push_back(mode.modes);
        next.det_a.push_back(DetA(mechanism, mode.x, q, theta));
        combined.push_back(std::move(next));
      }
    }
    out.found = std::move(combined);
  }
  const Solution laid_out = Forward(readings, theta, home());
  for (AssemblyMode& mode : out.found) {
    mode.X_WT = ToolPose(mode.coordinates, theta);
    std::size_t chain = 0;
    bool same = laid_out.ok() && (mode.coordinates - laid_out.coordinates).norm() <=
                                     kSame * std::max(1.0, laid_out.coordinates.norm());
    for (const MechanismModel& mechanism : impl_->mechanisms) {
      if (mechanism.first_drive < 0) continue;
      same = same && mode.modes[chain++] == mechanism.modes;
    }
    mode.as_laid_out = same;
  }
  std::stable_partition(out.found.begin(), out.found.end(), [](const AssemblyMode& mode) {
    return mode.as_laid_out;
  });
  return out;
}

}  // namespace kompono::kinematics
