// SPDX-License-Identifier: Apache-2.0
// Between the samples of a path: pieces are halved until each is proven regular or too short to
// matter.
#include "formula_tape.hpp"
#include "mechanism_points.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "kompono/analysis/singularities.hpp"

namespace kompono::analysis {
namespace {

using Slot = FormulaTape::Slot;

constexpr double kShortest = 1e-10;  ///< of a piece between two samples
constexpr double kShortestWhenMany =
    1e-4;  ///< once many pieces stay undecided: along a singularity
constexpr std::size_t kMany = 4000;

/// One mechanism's formulas in its own coordinates.
class MechanismFormulas {
 public:
  explicit MechanismFormulas(const PoseJudge::Mechanism& mechanism)
      : n_(mechanism.coordinate.size()) {
    std::vector<Slot> variables;
    for (std::size_t i = 0; i < n_; ++i) variables.push_back(tape_.Varied(i));
    const std::size_t drives = static_cast<std::size_t>(mechanism.shape.drives);
    const auto add_numbers = [&] {
      for (const double p : mechanism.parameters) variables.push_back(tape_.Constant(p));
      for (const double m : mechanism.modes) variables.push_back(tape_.Constant(m));
    };
    const std::vector<Slot> x = variables;
    variables.resize(n_ + drives, tape_.Constant(0.0));
    add_numbers();
    const std::vector<Slot> q =
        tape_.Record(*mechanism.code, plugin::Quantity::kDrives, false, variables);
    reach_ = tape_.Record(*mechanism.code, plugin::Quantity::kReach, false, variables);
    if (q.empty() || reach_.empty()) return;
    variables = x;
    variables.insert(variables.end(), q.begin(), q.end());
    add_numbers();
    const std::vector<Slot> roots =
        tape_.Record(*mechanism.code, plugin::Quantity::kClosure, true, variables);
    const auto closures = static_cast<std::ptrdiff_t>(mechanism.shape.closures);
    if (std::ssize(roots) != closures * (1 + static_cast<std::ptrdiff_t>(n_))) return;
    a_.assign(roots.begin() + closures, roots.end());
    known_ = mechanism.shape.closures == mechanism.shape.coordinates;
    wide_ = tape_.MakeValues();
    middle_ = tape_.MakeValues();
  }

  [[nodiscard]] bool known() const { return known_; }

  struct Verdict {
    bool regular = false;  ///< reached all over and det A does not vanish
    bool out = false;      ///< nowhere reached
    int reach = -1;        ///< a drive whose reach may end here
    bool det = false;      ///< det A may vanish
  };

  /// The box between two points.
  [[nodiscard]] Verdict Judge(const VectorXd& a, const VectorXd& b) {
    std::vector<Interval> wide(n_);
    std::vector<Interval> middle(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      wide[i] = {std::min(a[k], b[k]), std::max(a[k], b[k])};
      middle[i] = Interval(wide[i].Middle());
    }
    tape_.Evaluate(wide, n_ <= Slope::kDirections, wide_);
    tape_.Evaluate(middle, false, middle_);
    Verdict out;
    for (std::size_t i = 0; i < reach_.size(); ++i) {
      const Interval reach = wide_[static_cast<std::size_t>(reach_[i])].value;
      out.out = out.out || reach.upper < 0.0;
      if (reach.lower <= 0.0) out.reach = static_cast<int>(i);
    }
    if (out.out) return out;
    out.det = !KeepsSign(wide, middle);
    out.regular = out.reach < 0 && !out.det;
    return out;
  }

 private:
  /// As in the zone: by slopes up to three coordinates, else by |A_c^-1 (A - A_c)| < 1.
  [[nodiscard]] bool KeepsSign(const std::vector<Interval>& wide,
                               const std::vector<Interval>& middle) const {
    const auto n = static_cast<Eigen::Index>(n_);
    MatrixXd centre(n, n);
    MatrixXd spread(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        const auto slot = static_cast<std::size_t>(a_[static_cast<std::size_t>(i * n + j)]);
        Interval all = wide_[slot].value;
        const double here = middle_[slot].value.Middle();
        if (n_ <= Slope::kDirections) {  // the mean-value form is much narrower
          Interval sum = middle_[slot].value;
          for (std::size_t k = 0; k < n_; ++k)
            sum = sum + wide_[slot].by[k] * (wide[k] - middle[k]);
          if (sum.IsFinite()) all = Meet(all, sum);
        }
        centre(i, j) = here;
        spread(i, j) = std::max(all.upper - here, here - all.lower);
      }
    }
    if (!centre.allFinite() || !spread.allFinite()) return false;
    for (Eigen::Index j = 0; j < n; ++j) {
      const double norm = centre.col(j).norm();
      if (!(norm > 0.0)) return false;
      centre.col(j) /= norm;
      spread.col(j) /= norm;
    }
    const MatrixXd inverse = Eigen::PartialPivLU<MatrixXd>(centre).inverse();
    return (inverse.cwiseAbs() * spread).rowwise().sum().maxCoeff() < 1.0 - 1e-9;
  }

  std::size_t n_;
  FormulaTape tape_;
  std::vector<Slot> reach_, a_;
  FormulaTape::Values wide_, middle_;
  bool known_ = false;
};

double DetA(const PoseJudge::Mechanism& mechanism, const VectorXd& x) {
  const VectorXd q = ValuesAt(mechanism, plugin::Quantity::kDrives, x, VectorXd(), false).value;
  MatrixXd A = ValuesAt(mechanism, plugin::Quantity::kClosure, x, q, true).by_coordinates;
  for (Eigen::Index i = 0; i < A.rows(); ++i) A.row(i) /= std::max(A.row(i).norm(), 1e-300);
  return A.rows() == A.cols() ? A.determinant() : 0.0;
}

/// A stretch that could not be proven regular.
struct Stretch {
  double from = 0.0, to = 0.0;
  int reach = -1;
  bool det = false;
};

class PathSearch {
 public:
  PathSearch(const PoseJudge& judge, std::size_t mechanism, const std::vector<VectorXd>& samples)
      : mechanism_(judge.mechanisms()[mechanism]), formulas_(mechanism_), samples_(samples) {}

  [[nodiscard]] bool known() const { return formulas_.known(); }

  void Segment(std::size_t first) {
    undecided_ = 0;
    Halve(static_cast<double>(first), 0.0, 1.0);
  }

  void Finish(PathReport& report) const {
    for (const std::array<double, 2>& piece : out_) report.out_of_reach.push_back(piece);
    for (const Stretch& stretch : stretches_) {
      const double before = DetAt(stretch.from - Step());
      const double after = DetAt(stretch.to + Step());
      PathSingularity found{.type = 2,
                            .block = mechanism_.block,
                            .from = stretch.from,
                            .to = stretch.to,
                            .z = PoseAt(0.5 * (stretch.from + stretch.to))};
      const bool both = std::isfinite(before) && std::isfinite(after);
      found.crossed = both && before * after < 0.0;
      if (stretch.reach >= 0) {
        found.type = DetVanishes(stretch) ? 3 : 1;
        found.drive = mechanism_.block + "." +
                      mechanism_.description->drives[static_cast<std::size_t>(stretch.reach)].name;
      }
      report.singularities.push_back(found);
    }
  }

 private:
  static double Step() { return 1e-7; }

  [[nodiscard]] VectorXd PoseAt(double at) const {
    at = std::clamp(at, 0.0, static_cast<double>(samples_.size() - 1));
    const auto k = std::min(static_cast<std::size_t>(at), samples_.size() - 2);
    const double t = at - static_cast<double>(k);
    return samples_[k] + t * (samples_[k + 1] - samples_[k]);
  }
  [[nodiscard]] VectorXd LocalPose(double at) const { return LocalAt(mechanism_, PoseAt(at)); }
  [[nodiscard]] double DetAt(double at) const { return DetA(mechanism_, LocalPose(at)); }

  /// At the end of reach: whether det A goes to 0 with the root, seen from the reachable side.
  [[nodiscard]] bool DetVanishes(const Stretch& stretch) const {
    for (const double side : {-1.0, 1.0}) {
      const double edge = side < 0.0 ? stretch.from : stretch.to;
      const double near = std::abs(DetAt(edge + side * 1e-6));
      const double far = std::abs(DetAt(edge + side * 1e-4));
      if (std::isfinite(near) && std::isfinite(far)) return near < 0.3 * far;
    }
    return false;
  }

  void Halve(double base, double a, double b) {
    const MechanismFormulas::Verdict verdict =
        formulas_.Judge(LocalPose(base + a), LocalPose(base + b));
    if (verdict.regular) return;
    if (verdict.out) {
      Join(out_, base + a, base + b);
      return;
    }
    const double shortest = undecided_ > kMany ? kShortestWhenMany : kShortest;
    if (b - a <= shortest) {
      ++undecided_;
      AddStretch({.from = base + a, .to = base + b, .reach = verdict.reach, .det = verdict.det});
      return;
    }
    const double middle = 0.5 * (a + b);
    Halve(base, a, middle);
    Halve(base, middle, b);
  }

  static void Join(std::vector<std::array<double, 2>>& list, double from, double to) {
    if (!list.empty() && from - list.back()[1] < 1e-9) {
      list.back()[1] = to;
    } else {
      list.push_back({from, to});
    }
  }
  void AddStretch(const Stretch& next) {
    // Neighbours, or with what a touched singularity leaves proven between them, are one.
    if (!stretches_.empty() && next.from - stretches_.back().to < 1e-7) {
      Stretch& last = stretches_.back();
      last.to = next.to;
      last.reach = std::max(last.reach, next.reach);
      last.det = last.det || next.det;
    } else {
      stretches_.push_back(next);
    }
  }

  const PoseJudge::Mechanism& mechanism_;
  MechanismFormulas formulas_;
  const std::vector<VectorXd>& samples_;
  std::vector<Stretch> stretches_;
  std::vector<std::array<double, 2>> out_;
  std::size_t undecided_ = 0;
};

}  // namespace

Parsed<PathReport> SingularitiesOnPath(const PoseJudge& judge,
                                       const std::vector<VectorXd>& samples,
                                       const RunControl& control) {
  PathReport report;
  Diagnostics problems;
  for (std::size_t m = 0; m < judge.mechanisms().size() && samples.size() > 1; ++m) {
    PathSearch search(judge, m, samples);
    if (!search.known()) {
      problems.push_back(
          {.code = "E0722",
           .message = "the module of " + judge.mechanisms()[m].block + " records no formulas",
           .help = "its plugin must build from the SDK's AutodiffMechanism"});
      continue;
    }
    for (std::size_t k = 0; k + 1 < samples.size() && !report.stopped; ++k) {
      search.Segment(k);
      report.stopped = control.Stopped();
    }
    search.Finish(report);
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  std::stable_sort(report.singularities.begin(),
                   report.singularities.end(),
                   [](const auto& a, const auto& b) { return a.from < b.from; });
  return report;
}

}  // namespace kompono::analysis
