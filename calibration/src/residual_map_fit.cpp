// SPDX-License-Identifier: Apache-2.0
// The residual map is found by penalised least squares: values at the nodes of a grid, multilinear
// between them, with second differences and, more weakly, the values themselves held small. How
// strongly, and how fine the grid is, cross-validation decides; whether the map is worth anything,
// a second one around it, which also identifies the geometry anew without the rows it judges.
#include "residuals.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include <Eigen/Cholesky>

#include "kompono/calibration/codes.hpp"
#include "kompono/calibration/residual_map.hpp"

namespace kompono::calibration {
namespace {

constexpr std::size_t kLeastRows = 20;
constexpr std::size_t kMostAxes = 3;
constexpr std::size_t kMostNodes = 150;
constexpr std::array kSteps{3, 5, 7};
constexpr std::array kSmoothings{1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0};
constexpr int kInnerFolds = 5;
constexpr double kShrink = 0.02;             ///< of values beside second differences
constexpr double kLeastSpread = 1.0;         ///< mm; a coordinate that moved less has no axis
constexpr double kLeastGain = 0.05;          ///< of the validated error
constexpr double kSurely = 2.5;              ///< standard deviations of the mean gain
constexpr std::size_t kMostRefitted = 2000;  ///< rows for which every fold has its own geometry
constexpr std::size_t kLeastHeldOut = 5;

/// What one row says of the tool point.
struct Sample {
  std::size_t row = 0;  ///< of the set
  Eigen::VectorXd coordinates;
  std::array<std::optional<double>, 3> error_mm;  ///< really less predicted
  double weight = 1.0;
};
using Samples = std::vector<Sample>;

double SquareOf(const Sample& sample, const Eigen::Vector3d& mapped) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!sample.error_mm[i]) continue;
    const double left = *sample.error_mm[i] - mapped[static_cast<Eigen::Index>(i)];
    sum += left * left;
  }
  return sum;
}

/// Of the set's rows those that measure the tool point itself, at geometry `theta`.
Samples SamplesAt(const kinematics::Machine& machine,
                  const MeasurementSet& set,
                  const std::vector<std::size_t>& rows,
                  const Eigen::VectorXd& theta,
                  double default_sigma_mm) {
  Samples samples;
  for (const std::size_t k : rows) {
    const Measurement& m = set.measurements[k];
    RowModel model(machine, m, 1.0, 1.0);
    const RowModel::Prediction prediction = model.FindStart(theta, nullptr);
    if (!prediction.ok()) continue;
    Sample sample{.row = k, .coordinates = prediction.first.coordinates};
    const Eigen::Vector3d& p = prediction.first.X_WT.p;
    for (std::size_t i = 0; i < 3; ++i) {
      if (m.position_mm[i])
        sample.error_mm[i] = *m.position_mm[i] - p[static_cast<Eigen::Index>(i)];
    }
    if (m.kind == MeasurementKind::kHeight) sample.error_mm[2] = m.value_mm - p.z();
    const double relative = default_sigma_mm / m.sigma_mm.value_or(default_sigma_mm);
    sample.weight = relative * relative;
    samples.push_back(std::move(sample));
  }
  return samples;
}

/// The axes along which the samples spread most, without values.
std::vector<MapAxis> AxesOf(const kinematics::Machine& machine, const Samples& samples) {
  std::vector<std::pair<double, std::size_t>> spreads;
  for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
    if (machine.coordinates()[i].rotary) continue;
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const Sample& sample : samples) {
      least = std::min(least, sample.coordinates[static_cast<Eigen::Index>(i)]);
      most = std::max(most, sample.coordinates[static_cast<Eigen::Index>(i)]);
    }
    if (most - least > kLeastSpread) spreads.emplace_back(most - least, i);
  }
  std::sort(spreads.rbegin(), spreads.rend());
  if (spreads.size() > kMostAxes) spreads.resize(kMostAxes);
  std::vector<std::size_t> chosen;
  chosen.reserve(spreads.size());
  for (const auto& [spread, index] : spreads) chosen.push_back(index);
  std::sort(chosen.begin(), chosen.end());
  std::vector<MapAxis> axes;
  axes.reserve(chosen.size());
  for (const std::size_t index : chosen) {
    axes.push_back({.coordinate = machine.coordinates()[index].name, .values = {}});
  }
  return axes;
}

/// The grid over what the samples span, `steps` values of each axis.
ResidualMap GridOver(const kinematics::Machine& machine,
                     const Samples& samples,
                     std::vector<MapAxis> axes,
                     int steps) {
  ResidualMap map{.axes = std::move(axes), .error_mm = {}};
  std::size_t nodes = 1;
  for (MapAxis& axis : map.axes) {
    const int index = machine.FindCoordinate(axis.coordinate);
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const Sample& sample : samples) {
      least = std::min(least, sample.coordinates[index]);
      most = std::max(most, sample.coordinates[index]);
    }
    axis.values.clear();
    for (int i = 0; i < steps; ++i) axis.values.push_back(least + (most - least) * i / (steps - 1));
    nodes *= axis.values.size();
  }
  map.error_mm.assign(nodes, Eigen::Vector3d::Zero());
  return map;
}

/// Second differences along every axis, and the values themselves.
Eigen::MatrixXd PenaltyOf(const ResidualMap& map) {
  const auto nodes = static_cast<Eigen::Index>(map.error_mm.size());
  Eigen::MatrixXd penalty = kShrink * Eigen::MatrixXd::Identity(nodes, nodes);
  Eigen::Index stride = nodes;
  for (const MapAxis& axis : map.axes) {
    const auto count = static_cast<Eigen::Index>(axis.values.size());
    stride /= count;
    for (Eigen::Index node = 0; node < nodes; ++node) {
      const Eigen::Index at = (node / stride) % count;
      if (at == 0 || at + 1 == count) continue;
      Eigen::VectorXd row = Eigen::VectorXd::Zero(nodes);
      row[node - stride] = row[node + stride] = 1.0;
      row[node] = -2.0;
      penalty += row * row.transpose();
    }
  }
  return penalty;
}

/// Sums over rows for one component: what the nodes have to meet.
struct Normal {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
  double rows = 0.0;
  explicit Normal(Eigen::Index nodes)
      : A(Eigen::MatrixXd::Zero(nodes, nodes)), b(Eigen::VectorXd::Zero(nodes)) {}
  Normal& operator+=(const Normal& other) {
    A += other.A;
    b += other.b;
    rows += other.rows;
    return *this;
  }
};
using Normals = std::vector<Normal>;  ///< of x, y, z

/// Weights of the nodes for one sample: the map of unit errors would say these.
Eigen::VectorXd WeightsAt(const kinematics::Machine& machine,
                          const ResidualMap& grid,
                          const Eigen::VectorXd& coordinates) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(grid.error_mm.size()));
  // The interpolation is separable: one axis after the other.
  std::vector<double> all{1.0};
  for (const MapAxis& axis : grid.axes) {
    ResidualMap line{.axes = {axis}, .error_mm = {}};
    std::vector<double> longer;
    for (std::size_t i = 0; i < axis.values.size(); ++i) {
      line.error_mm.assign(axis.values.size(), Eigen::Vector3d::Zero());
      line.error_mm[i].setOnes();
      longer.push_back(line.At(machine, coordinates).x());
    }
    std::vector<double> product;
    for (const double before : all) {
      for (const double now : longer) product.push_back(before * now);
    }
    all = std::move(product);
  }
  for (std::size_t i = 0; i < all.size(); ++i) weights[static_cast<Eigen::Index>(i)] = all[i];
  return weights;
}

/// A grid with the weights of all samples, ready to be solved for any part of them.
class MapFit {
 public:
  MapFit(const kinematics::Machine& machine, const Samples& samples, ResidualMap grid)
      : samples_(samples), grid_(std::move(grid)), penalty_(PenaltyOf(grid_)) {
    for (const Sample& sample : samples) {
      weights_.push_back(WeightsAt(machine, grid_, sample.coordinates));
    }
  }

  [[nodiscard]] Normals SumsOf(const std::vector<std::size_t>& members) const {
    Normals sums(3, Normal(penalty_.rows()));
    for (const std::size_t k : members) {
      const Sample& sample = samples_[k];
      for (std::size_t i = 0; i < 3; ++i) {
        if (!sample.error_mm[i]) continue;
        sums[i].A += sample.weight * weights_[k] * weights_[k].transpose();
        sums[i].b += sample.weight * *sample.error_mm[i] * weights_[k];
        sums[i].rows += sample.weight;
      }
    }
    return sums;
  }

  [[nodiscard]] Eigen::MatrixX3d Solve(const Normals& sums, double smoothing) const {
    const Eigen::Index nodes = penalty_.rows();
    Eigen::MatrixX3d errors = Eigen::MatrixX3d::Zero(nodes, 3);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Normal& sum = sums[static_cast<std::size_t>(i)];
      if (sum.rows <= 0.0) continue;
      const double scale = static_cast<double>(nodes) / sum.rows;
      errors.col(i) = (scale * sum.A + smoothing * penalty_).ldlt().solve(scale * sum.b);
    }
    return errors;
  }

  /// What the map with these node values says of the k-th sample.
  [[nodiscard]] Eigen::Vector3d Say(const Eigen::MatrixX3d& errors, std::size_t k) const {
    return errors.transpose() * weights_[k];
  }

  [[nodiscard]] ResidualMap Finished(const Eigen::MatrixX3d& errors) const {
    ResidualMap map = grid_;
    for (std::size_t i = 0; i < map.error_mm.size(); ++i) {
      map.error_mm[i] = errors.row(static_cast<Eigen::Index>(i)).transpose();
    }
    return map;
  }

 private:
  const Samples& samples_;
  ResidualMap grid_;
  Eigen::MatrixXd penalty_;
  std::vector<Eigen::VectorXd> weights_;
};

/// 0 .. count-1 in a random order, cut into folds.
std::vector<std::vector<std::size_t>> FoldsOf(std::size_t count, int folds, std::uint64_t seed) {
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = i;
  std::mt19937_64 random(seed);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    std::swap(order[i], order[i + random() % (count - i)]);
  }
  std::vector<std::vector<std::size_t>> out(static_cast<std::size_t>(folds));
  for (std::size_t i = 0; i < count; ++i) out[i % out.size()].push_back(order[i]);
  return out;
}

struct Smoothed {
  ResidualMap map;
  int steps = 0;  ///< 0: no map is better than any
  double smoothing = 0.0;
};

/// Grid and smoothing with the least error of samples that a map has not seen; a map of zeros if
/// none is better than that.
Smoothed BestMap(const kinematics::Machine& machine, const Samples& samples, std::uint64_t seed) {
  const std::vector<MapAxis> axes = AxesOf(machine, samples);
  Smoothed best{.map = GridOver(machine, samples, axes, 2)};
  double least = 0.0;
  for (const Sample& sample : samples) {
    least += sample.weight * SquareOf(sample, Eigen::Vector3d::Zero());
  }
  const auto folds = FoldsOf(samples.size(), kInnerFolds, seed);
  for (const int steps : kSteps) {
    if (axes.empty()) break;
    ResidualMap grid = GridOver(machine, samples, axes, steps);
    if (grid.error_mm.size() > kMostNodes) continue;
    const MapFit fit(machine, samples, std::move(grid));
    std::vector<Normals> sums;
    sums.reserve(folds.size());
    for (const auto& fold : folds) sums.push_back(fit.SumsOf(fold));
    for (const double smoothing : kSmoothings) {
      double error = 0.0;
      for (std::size_t f = 0; f < folds.size(); ++f) {
        Normals others = sums[(f + 1) % folds.size()];
        for (std::size_t other = 2; other < folds.size(); ++other) {
          for (std::size_t i = 0; i < 3; ++i) others[i] += sums[(f + other) % folds.size()][i];
        }
        const Eigen::MatrixX3d errors = fit.Solve(others, smoothing);
        for (const std::size_t k : folds[f]) {
          error += samples[k].weight * SquareOf(samples[k], fit.Say(errors, k));
        }
      }
      if (error >= least) continue;
      least = error;
      Normals all = sums[0];
      for (std::size_t f = 1; f < folds.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) all[i] += sums[f][i];
      }
      best = {
          .map = fit.Finished(fit.Solve(all, smoothing)), .steps = steps, .smoothing = smoothing};
    }
  }
  return best;
}

/// Squares of the errors of rows without and with a map.
struct Squares {
  std::vector<double> without, with;

  void Add(const kinematics::Machine& machine, const ResidualMap& map, const Samples& samples) {
    for (const Sample& sample : samples) {
      without.push_back(SquareOf(sample, Eigen::Vector3d::Zero()));
      with.push_back(SquareOf(sample, map.At(machine, sample.coordinates)));
    }
  }
  [[nodiscard]] MapGain Gain() const {
    MapGain gain{.rows = static_cast<int>(without.size())};
    if (without.empty()) return gain;
    for (std::size_t i = 0; i < without.size(); ++i) {
      gain.without_mm += without[i];
      gain.with_mm += with[i];
    }
    gain.without_mm = std::sqrt(gain.without_mm / gain.rows);
    gain.with_mm = std::sqrt(gain.with_mm / gain.rows);
    return gain;
  }
  /// The mean gain of a row in its own standard deviations.
  [[nodiscard]] double Certainty() const {
    const auto count = static_cast<double>(without.size());
    double mean = 0.0;
    for (std::size_t i = 0; i < without.size(); ++i) mean += (without[i] - with[i]) / count;
    double variance = 0.0;
    for (std::size_t i = 0; i < without.size(); ++i) {
      const double off = without[i] - with[i] - mean;
      variance += off * off / (count - 1.0);
    }
    return variance > 0.0 ? mean / std::sqrt(variance / count) : 0.0;
  }
};

class Mapping {
 public:
  Mapping(const kinematics::Machine& machine,
          const MeasurementSet& set,
          const CalibrationReport& report,
          const IdentifyOptions& identify,
          const MapOptions& options)
      : machine_(machine), set_(set), report_(report), identify_(identify), options_(options) {
    for (std::size_t k = 0; k < set.measurements.size(); ++k) {
      const Measurement& m = set.measurements[k];
      const bool point = m.kind == MeasurementKind::kPosition || m.kind == MeasurementKind::kPose ||
                         m.kind == MeasurementKind::kHeight;
      if (!point || m.target >= 0 || k >= report.rows.size() || report.rows[k].rejected) continue;
      (report.rows[k].held_out ? held_out_ : fitted_).push_back(k);
    }
  }

  Parsed<MappedResiduals> Run() {
    if (fitted_.size() < kLeastRows) {
      return tl::unexpected(Diagnostics{
          {.code = codes::kMapRows.code,
           .file = set_.file,
           .message = fmt::format("a residual map needs {} rows or more that measure the tool "
                                  "point in the datum; there are {}",
                                  kLeastRows,
                                  fitted_.size()),
           .help = "measure positions, poses or heights of the tool point without a target"}});
    }
    const Samples samples = At(fitted_, report_.theta_after);
    Smoothed best = BestMap(machine_, samples, options_.seed);
    Squares in_sample;
    in_sample.Add(machine_, best.map, samples);
    const Squares validated = Validate();
    MappedResiduals out{.map = std::move(best.map), .judged = {}};
    out.judged.nodes = best.steps;
    out.judged.smoothing = best.smoothing;
    out.judged.fitted = in_sample.Gain();
    out.judged.validated = validated.Gain();
    if (held_out_.size() >= kLeastHeldOut) {
      Squares judged;
      judged.Add(machine_, out.map, At(held_out_, report_.theta_after));
      out.judged.held_out = judged.Gain();
    }
    Decide(validated, &out.judged);
    return out;
  }

 private:
  [[nodiscard]] Samples At(const std::vector<std::size_t>& rows,
                           const Eigen::VectorXd& theta) const {
    return SamplesAt(machine_, set_, rows, theta, identify_.default_sigma_mm);
  }

  /// Each row judged by what was found without it: geometry, map and smoothing.
  [[nodiscard]] Squares Validate() const {
    Squares squares;
    const auto folds = FoldsOf(fitted_.size(), options_.folds, options_.seed + 1);
    for (const auto& fold : folds) {
      std::vector<bool> out(fitted_.size(), false);
      for (const std::size_t i : fold) out[i] = true;
      std::vector<std::size_t> seen;
      std::vector<std::size_t> unseen;
      for (std::size_t i = 0; i < fitted_.size(); ++i)
        (out[i] ? unseen : seen).push_back(fitted_[i]);
      const Eigen::VectorXd theta = Without(unseen);
      const Smoothed map = BestMap(machine_, At(seen, theta), options_.seed + 2);
      squares.Add(machine_, map.map, At(unseen, theta));
    }
    return squares;
  }

  /// The geometry identified without some rows and without those that were rejected.
  [[nodiscard]] Eigen::VectorXd Without(const std::vector<std::size_t>& rows) const {
    if (fitted_.size() > kMostRefitted) return report_.theta_after;
    MeasurementSet part = set_;
    for (std::size_t k = 0; k < part.measurements.size(); ++k) {
      part.measurements[k].held_out = report_.rows[k].held_out || report_.rows[k].rejected;
    }
    for (const std::size_t k : rows) part.measurements[k].held_out = true;
    IdentifyOptions options = identify_;
    options.held_out_fraction = 0.0;
    options.outliers = Outliers::kKeep;
    const CalibrationReport report = Identify(machine_, part, options);
    return report.ok() ? report.theta_after : report_.theta_after;
  }

  static void Decide(const Squares& validated, MapJudgement* judged) {
    const MapGain& gain = judged->validated;
    const bool better = gain.with_mm < (1.0 - kLeastGain) * gain.without_mm;
    const bool surely = validated.Certainty() > kSurely;
    const bool harms = judged->held_out && judged->held_out->with_mm > judged->held_out->without_mm;
    judged->kept = judged->nodes > 0 && better && surely && !harms;
    if (judged->kept) {
      judged->verdict = "kept, for it tells the errors of rows that it has not seen";
    } else if (judged->nodes == 0) {
      judged->verdict = "refused: the errors left are no smooth function of the coordinates";
    } else if (harms && better && surely) {
      judged->verdict = "refused: it makes the rows that are held out worse";
    } else {
      judged->verdict = "refused: it does not help on rows that it has not seen";
    }
  }

  const kinematics::Machine& machine_;
  const MeasurementSet& set_;
  const CalibrationReport& report_;
  const IdentifyOptions& identify_;
  const MapOptions& options_;
  std::vector<std::size_t> fitted_, held_out_;
};

}  // namespace

Parsed<MappedResiduals> MapResiduals(const kinematics::Machine& machine,
                                     const MeasurementSet& set,
                                     const CalibrationReport& report,
                                     const IdentifyOptions& identify,
                                     const MapOptions& options) {
  return Mapping(machine, set, report, identify, options).Run();
}

}  // namespace kompono::calibration
