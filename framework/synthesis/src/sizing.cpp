// SPDX-License-Identifier: Apache-2.0
#include "kompono/synthesis/sizing.hpp"

#include "required_zone.hpp"
#include <nlopt.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kompono/analysis/dexterity.hpp"

namespace kompono::synthesis {
namespace {

using analysis::PoseJudge;
using Eigen::VectorXd;
using kinematics::Machine;

constexpr std::uint64_t kMostPoses = 500;
constexpr std::uint64_t kMostCorners = 64;
constexpr int kStarts = 24;
constexpr double kUnreachedSize = 1e6;
constexpr double kRounded_mm = 0.01;

/// What one choice of sizes is worth.
struct Trial {
  std::vector<double> values;
  double dexterity = -1.0;  ///< below 0: by how far a drive is out of reach, relative
  double size_mm = kUnreachedSize;
  double share = 0.0;
  [[nodiscard]] double Shortfall(double goal) const { return std::max(0.0, goal - dexterity); }
};

/// Less shortfall first, then smaller.
bool Better(const Trial& a, const Trial& b, double goal) {
  const double short_a = a.Shortfall(goal);
  const double short_b = b.Shortfall(goal);
  if (std::abs(short_a - short_b) > 1e-9) return short_a < short_b;
  return a.size_mm < b.size_mm;
}

double RadicalInverse(int index, int base) {
  double out = 0.0;
  double digit = 1.0 / base;
  for (; index > 0; index /= base, digit /= base) out += digit * (index % base);
  return out;
}

class Sizer {
 public:
  Sizer(const SizingTask& task, const EvaluationSettings& settings)
      : task_(task), settings_(settings) {
    const auto judge = PoseJudge::Make(*task.machine, task.machine->nominal(), {});
    lengths_.assign(judge->mechanisms().size(), 1.0);
    for (std::size_t m = 0; m < lengths_.size(); ++m) {
      const double length = analysis::CharacteristicLength(*judge, m);
      if (std::isfinite(length)) lengths_[m] = length;
    }
  }

  SizingResult Run() {
    std::vector<double> at;
    for (const FreeNumber& number : task_.free) at.push_back(number.start);
    best_ = Try(at);
    for (int i = 1; i <= kStarts; ++i) Take(Try(Halton(i)));
    Descend();
    const Trial rounded = Try(Rounded(best_.values));
    const bool kept =
        rounded.share >= best_.share && rounded.Shortfall(settings_.dexterity_goal) <=
                                            best_.Shortfall(settings_.dexterity_goal) + 1e-3;
    const Trial& last = kept ? rounded : best_;
    return {.values = last.values,
            .dexterity_worst = std::max(0.0, last.dexterity),
            .share = last.share,
            .size_mm = last.size_mm,
            .evaluations = evaluations_};
  }

 private:
  [[nodiscard]] std::vector<double> Halton(int index) const {
    constexpr std::array<int, 8> primes{2, 3, 5, 7, 11, 13, 17, 19};
    std::vector<double> out;
    for (std::size_t i = 0; i < task_.free.size(); ++i) {
      const FreeNumber& number = task_.free[i];
      const double along = RadicalInverse(index, primes[i % primes.size()]);
      out.push_back(number.lower + along * (number.upper - number.lower));
    }
    return out;
  }

  [[nodiscard]] std::vector<double> Rounded(std::vector<double> values) const {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double value = std::round(values[i] / kRounded_mm) * kRounded_mm;
      values[i] = std::clamp(value, task_.free[i].lower, task_.free[i].upper);
    }
    return values;
  }

  [[nodiscard]] VectorXd ThetaOf(const std::vector<double>& values) const {
    VectorXd theta = task_.machine->nominal();
    for (std::size_t i = 0; i < values.size(); ++i) {
      for (const int number : task_.free[i].numbers) theta[number] = values[i];
    }
    return theta;
  }

  /// The zone where these values put it.
  [[nodiscard]] analysis::Region RegionOf(const std::vector<double>& values) const {
    analysis::Region region = *task_.region;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const FreeNumber& free = task_.free[i];
      if (free.coordinate < 0) continue;
      const double shift = free.sign * (values[i] - free.start);
      region.z[free.coordinate] += shift;
      for (std::size_t k = 0; k < region.dimension(); ++k) {
        if (region.varied[k] != free.coordinate) continue;
        region.lower[k] += shift;
        region.upper[k] += shift;
      }
    }
    return region;
  }

  Trial Try(const std::vector<double>& values) {
    ++evaluations_;
    Trial out{.values = values};
    const VectorXd theta = ThetaOf(values);
    const analysis::Region region = RegionOf(values);
    const auto judge = PoseJudge::Make(*task_.machine, theta, {});
    const ZoneMap map =
        MapZone(*judge, lengths_, region, PoseGrid::Of(region, settings_.sizing_steps, kMostPoses));
    out.share = map.Share();
    out.size_mm = SizeOf(*judge, PoseGrid::Of(region, 2, kMostCorners));
    out.dexterity = out.share >= 1.0 ? map.dexterity_worst : -(1.0 - out.share);
    return out;
  }

  /// Diagonal of the box around the mechanism's points, in its own base, in the corners of the
  /// zone. A function of the mechanism alone: equal tasks of different machines give equal sizes.
  [[nodiscard]] double SizeOf(const PoseJudge& judge, const PoseGrid& corners) const {
    const PoseJudge::Mechanism& of = judge.mechanisms()[task_.mechanism];
    std::vector<double> x(of.coordinate.size());
    std::vector<double> q(static_cast<std::size_t>(of.shape.drives));
    std::vector<double> points(3 * static_cast<std::size_t>(of.shape.points));
    Eigen::Vector3d lower = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Vector3d upper = -lower;
    for (std::uint64_t i = 0; i < corners.size(); ++i) {
      const VectorXd z = corners.At(i);
      for (std::size_t k = 0; k < x.size(); ++k) x[k] = of.sign[k] * z[of.coordinate[k]];
      plugin::MechanismState state{
          .coordinates = x, .drives = {}, .parameters = of.parameters, .modes = of.modes};
      (void)of.code->Evaluate(plugin::Quantity::kDrives, state, {.values = q});
      state.drives = q;
      (void)of.code->Evaluate(plugin::Quantity::kSkeleton, state, {.values = points});
      for (std::size_t k = 0; k + 2 < points.size(); k += 3) {
        const Eigen::Vector3d p(points[k], points[k + 1], points[k + 2]);
        if (!p.allFinite()) continue;
        lower = lower.cwiseMin(p);
        upper = upper.cwiseMax(p);
      }
    }
    const double size = (upper - lower).norm();
    return std::isfinite(size) ? size : kUnreachedSize;
  }

  void Take(const Trial& trial) {
    if (Better(trial, best_, settings_.dexterity_goal)) best_ = trial;
  }

  const Trial& At(const std::vector<double>& values) {
    if (values != last_.values) {
      last_ = Try(values);
      Take(last_);
    }
    return last_;
  }

  static double Size(const std::vector<double>& x, std::vector<double>& /*gradient*/, void* self) {
    return static_cast<Sizer*>(self)->At(x).size_mm / static_cast<Sizer*>(self)->scale_mm_;
  }
  static double Lack(const std::vector<double>& x, std::vector<double>& /*gradient*/, void* self) {
    auto* sizer = static_cast<Sizer*>(self);
    return sizer->settings_.dexterity_goal - sizer->At(x).dexterity;
  }

  void Descend() {
    scale_mm_ = std::max(1e-6, best_.size_mm);
    last_ = best_;
    nlopt::opt optimiser(nlopt::LN_COBYLA, static_cast<unsigned>(task_.free.size()));
    std::vector<double> lower;
    std::vector<double> upper;
    std::vector<double> step;
    for (const FreeNumber& number : task_.free) {
      lower.push_back(number.lower);
      upper.push_back(number.upper);
      step.push_back(0.1 * (number.upper - number.lower));
    }
    optimiser.set_lower_bounds(lower);
    optimiser.set_upper_bounds(upper);
    optimiser.set_initial_step(step);
    optimiser.set_min_objective(&Sizer::Size, this);
    optimiser.add_inequality_constraint(&Sizer::Lack, this, 1e-6);
    optimiser.set_xtol_rel(1e-4);
    optimiser.set_maxeval(static_cast<int>(settings_.sizing_rounds));
    std::vector<double> x = best_.values;
    double size = 0.0;
    try {
      (void)optimiser.optimize(x, size);
    } catch (const std::runtime_error&) {
      // Rounding stopped it; the best trial stands.
    }
  }

  const SizingTask& task_;
  const EvaluationSettings& settings_;
  std::vector<double> lengths_;
  Trial best_, last_;
  double scale_mm_ = 1.0;
  int evaluations_ = 0;
};

}  // namespace

SizingResult SizeMechanism(const SizingTask& task, const EvaluationSettings& settings) {
  return Sizer(task, settings).Run();
}

}  // namespace kompono::synthesis
