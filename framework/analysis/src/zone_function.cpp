// SPDX-License-Identifier: Apache-2.0
// Whole boxes against the constraints, by interval arithmetic on recorded formulas.
#include "box_share.hpp"
#include "formula_tape.hpp"
#include "mechanism_points.hpp"
#include "segments.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "kompono/analysis/work_zone.hpp"

namespace kompono::analysis {
namespace {

using Slot = FormulaTape::Slot;
using Kind = Constraint::Kind;

constexpr std::size_t kDirections = Slope::kDirections;

/// Where a mechanism's formulas stand on the tape.
struct MechanismSlots {
  std::vector<Slot> drives, reach, points, platform;
  std::vector<Slot> a;  ///< ∂g/∂x, row-major; empty if its sign is not asked for
  double sign = 1.0;    ///< of det A at home
  VectorXd column_scale;
};

}  // namespace

struct ZoneFunction::State {
  const PoseJudge* judge = nullptr;
  Region region;
  FormulaTape tape;
  std::vector<MechanismSlots> slots;
  std::vector<Constraint> constraints;
  /// Per constraint that limits a drive: the one that says whether the drive reaches at all, else
  /// -1.
  std::vector<int> reach_of;
};

/// Over the box, and at its middle.
struct ZoneFunction::Scratch::Values {
  FormulaTape::Values wide, middle;
  std::array<double, kDirections> half{};
  std::vector<char> reached;      ///< per constraint of kind reach: kept all over the box
  std::vector<char> all_reached;  ///< per mechanism
};

namespace {

/// One box as the constraints see it.
class BoxView {
 public:
  BoxView(const FormulaTape::Values& wide,
          const FormulaTape::Values& middle,
          const std::array<double, kDirections>& half)
      : wide_(wide), middle_(middle), half_(half) {}

  [[nodiscard]] const Slope& Wide(Slot slot) const { return wide_[static_cast<std::size_t>(slot)]; }
  [[nodiscard]] const Slope& Middle(Slot slot) const {
    return middle_[static_cast<std::size_t>(slot)];
  }
  [[nodiscard]] const std::array<double, kDirections>& half() const { return half_; }
  [[nodiscard]] bool IsPoint() const { return &wide_ == &middle_; }

  /// How far the point with these three slots can be from where it is in the middle of the box.
  [[nodiscard]] double Displacement(const Slot* point) const {
    double square = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Interval& all = Wide(point[i]).value;
      const Interval& here = Middle(point[i]).value;
      const double most = std::max(all.upper - here.lower, here.upper - all.lower);
      square += most * most;
    }
    return std::sqrt(square) * (1.0 + 1e-14);
  }
  [[nodiscard]] Eigen::Vector3d MiddleOf(const Slot* point) const {
    return {Middle(point[0]).value.Middle(),
            Middle(point[1]).value.Middle(),
            Middle(point[2]).value.Middle()};
  }

 private:
  const FormulaTape::Values& wide_;
  const FormulaTape::Values& middle_;
  const std::array<double, kDirections>& half_;
};

/// What a constraint f >= 0 says of the box.
struct Outcome {
  bool kept = false, broken = false;
  ShareBounds share;
};

Outcome Decide(const Interval& f) {
  return {.kept = f.lower >= 0.0, .broken = f.upper < 0.0};
}

/// f over the box, f in the middle, and whether f is smooth all over the box, so that the
/// mean-value theorem holds.
Outcome Decide(const Slope& wide, const Interval& middle, const BoxView& box, bool smooth) {
  Outcome out = Decide(wide.value);
  if (out.kept || out.broken || !smooth || !middle.IsFinite()) return out;
  Interval spread = middle;
  std::array<double, 3> slope{};
  double slack = middle.Radius();
  for (std::size_t i = 0; i < kDirections; ++i) {
    if (box.half()[i] == 0.0) continue;
    if (!wide.by[i].IsFinite()) return out;
    spread = spread + wide.by[i] * Interval(-box.half()[i], box.half()[i]);
    slope[i] = wide.by[i].Middle() * 2.0 * box.half()[i];
    slack += wide.by[i].Radius() * box.half()[i] * (1.0 + 1e-12);
  }
  out = Decide(Meet(wide.value, spread));
  if (!out.kept && !out.broken) {
    const double value = middle.Middle();
    out.share = ShareAbovePlane(value, slope, slack + 1e-13 * std::abs(value));
  }
  return out;
}

Slope Dot(const std::array<Slope, 3>& a, const std::array<Slope, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// axis · strut - cos |strut|
template <class Get>
Slope SwingMargin(const PoseJudge::Joint& joint, const MechanismSlots& slots, const Get& get) {
  std::array<Slope, 3> strut;
  std::array<Slope, 3> axis;
  for (std::size_t i = 0; i < 3; ++i) {
    strut[i] = get(slots.points[3 * static_cast<std::size_t>(joint.other) + i]) -
               get(slots.points[3 * static_cast<std::size_t>(joint.at) + i]);
    axis[i] = Slope(joint.axis[static_cast<int>(i)]);
    if (!joint.on_platform) continue;
    axis[i] = Slope(0.0);
    for (std::size_t j = 0; j < 3; ++j)
      axis[i] = axis[i] + get(slots.platform[4 * i + j]) * Slope(joint.axis[static_cast<int>(j)]);
  }
  const Slope square = Square(strut[0]) + Square(strut[1]) + Square(strut[2]);
  return Dot(axis, strut) - Slope(joint.cosine) * Sqrt(square);
}

Outcome DecideClearance(const PoseJudge::StrutPair& pair,
                        const MechanismSlots& slots,
                        const BoxView& box) {
  const auto point = [&slots](int i) {
    return slots.points.data() + 3 * static_cast<std::size_t>(i);
  };
  const double moved_first =
      std::max(box.Displacement(point(pair.first[0])), box.Displacement(point(pair.first[1])));
  const double moved_second =
      std::max(box.Displacement(point(pair.second[0])), box.Displacement(point(pair.second[1])));
  const double here = SegmentDistance(box.MiddleOf(point(pair.first[0])),
                                      box.MiddleOf(point(pair.first[1])),
                                      box.MiddleOf(point(pair.second[0])),
                                      box.MiddleOf(point(pair.second[1])));
  const double moved = moved_first + moved_second + 1e-12 * here;
  if (!std::isfinite(moved) || !std::isfinite(here)) return {};
  return Decide(Interval(here - moved, here + moved) - Interval(pair.distance_mm));
}

Slope Determinant(const std::vector<Slot>& a, std::size_t n, const BoxView& box, bool middle) {
  const auto at = [&](std::size_t i, std::size_t j) {
    return middle ? box.Middle(a[n * i + j]) : box.Wide(a[n * i + j]);
  };
  if (n == 1) return at(0, 0);
  if (n == 2) return at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0);
  return at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) -
         at(0, 1) * (at(1, 0) * at(2, 2) - at(1, 2) * at(2, 0)) +
         at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0));
}

/// The sign of det A over the box: that of the middle if A cannot become singular on the way, which
/// it cannot if |A_c^-1 (A - A_c)| < 1.
Outcome DecideRegular(const MechanismSlots& slots, std::size_t n, const BoxView& box, bool smooth) {
  if (n <= 3) {
    const Slope sign(slots.sign);
    return Decide(sign * Determinant(slots.a, n, box, false),
                  (sign * Determinant(slots.a, n, box, true)).value,
                  box,
                  smooth);
  }
  const auto size = static_cast<Eigen::Index>(n);
  MatrixXd centre(size, size);
  MatrixXd spread(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      const Slot slot = slots.a[static_cast<std::size_t>(i * size + j)];
      const Interval& all = box.Wide(slot).value;
      const double here = box.Middle(slot).value.Middle();
      centre(i, j) = here * slots.column_scale[j];
      spread(i, j) = std::max(all.upper - here, here - all.lower) * slots.column_scale[j];
    }
  }
  if (!centre.allFinite() || !spread.allFinite()) return {};
  const Eigen::PartialPivLU<MatrixXd> lu(centre);
  const double norm = (lu.inverse().cwiseAbs() * spread).rowwise().sum().maxCoeff();
  if (!(norm < 1.0 - 1e-9)) return {};
  const bool kept = lu.determinant() * slots.sign > 0.0;
  return {.kept = kept, .broken = !kept};
}

Outcome DecideOne(const Constraint& constraint,
                  const PoseJudge::Mechanism& mechanism,
                  const MechanismSlots& slots,
                  const BoxView& box,
                  bool smooth) {
  const auto row = static_cast<std::size_t>(constraint.row);
  const auto drive = [&](double sign, double limit) {
    const Slot slot = slots.drives[row];
    const Slope factor(sign);
    return Decide(factor * (box.Wide(slot) - Slope(limit)),
                  Interval(sign) * (box.Middle(slot).value - Interval(limit)),
                  box,
                  smooth);
  };
  switch (constraint.kind) {
    case Kind::kReach:
      return Decide(
          box.Wide(slots.reach[row]), box.Middle(slots.reach[row]).value, box, !box.IsPoint());
    case Kind::kDriveLower:
      return drive(1.0, mechanism.lower[row]);
    case Kind::kDriveUpper:
      return drive(-1.0, mechanism.upper[row]);
    case Kind::kSwing: {
      const PoseJudge::Joint& joint = mechanism.joints[row];
      const auto wide = [&box](Slot slot) { return box.Wide(slot); };
      const auto middle = [&box](Slot slot) { return Slope(box.Middle(slot).value); };
      return Decide(
          SwingMargin(joint, slots, wide), SwingMargin(joint, slots, middle).value, box, smooth);
    }
    case Kind::kClearance:
      return DecideClearance(mechanism.pairs[row], slots, box);
    case Kind::kRegular:
      return DecideRegular(
          slots, static_cast<std::size_t>(mechanism.shape.coordinates), box, smooth);
  }
  return {};
}

std::vector<Slot> VariablesOf(FormulaTape& tape,
                              const PoseJudge::Mechanism& mechanism,
                              const Region& region,
                              const std::vector<Slot>& drives) {
  std::vector<Slot> out;
  for (std::size_t i = 0; i < mechanism.coordinate.size(); ++i) {
    const int of = mechanism.coordinate[i];
    const auto found = std::find(region.varied.begin(), region.varied.end(), of);
    const Slot slot = found == region.varied.end()
                          ? tape.Constant(region.z[of])
                          : tape.Varied(static_cast<std::size_t>(found - region.varied.begin()));
    out.push_back(mechanism.sign[i] > 0.0 ? slot : tape.Negative(slot));
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(mechanism.shape.drives); ++i)
    out.push_back(drives.empty() ? tape.Constant(0.0) : drives[i]);
  for (const double parameter : mechanism.parameters) out.push_back(tape.Constant(parameter));
  for (const double mode : mechanism.modes) out.push_back(tape.Constant(mode));
  return out;
}

/// A at home, for its sign and the scale of its columns.
bool PrepareSign(const PoseJudge::Mechanism& mechanism,
                 const VectorXd& home,
                 MechanismSlots& slots) {
  const VectorXd x = LocalAt(mechanism, home);
  const VectorXd q = ValuesAt(mechanism, plugin::Quantity::kDrives, x, VectorXd(), false).value;
  const MatrixXd A = ValuesAt(mechanism, plugin::Quantity::kClosure, x, q, true).by_coordinates;
  if (A.rows() != A.cols() || !A.allFinite()) return false;
  const double det = A.determinant();
  slots.sign = det < 0.0 ? -1.0 : 1.0;
  slots.column_scale = A.colwise().norm().cwiseInverse();
  return det != 0.0;
}

}  // namespace

ZoneFunction::Scratch::Scratch(const ZoneFunction& function)
    : values_(std::make_unique<Values>(
          Values{.wide = function.state_->tape.MakeValues(),
                 .middle = function.state_->tape.MakeValues(),
                 .reached = std::vector<char>(function.state_->constraints.size(), 0),
                 .all_reached = std::vector<char>(function.state_->slots.size(), 0)})) {}
ZoneFunction::Scratch::Scratch(Scratch&&) noexcept = default;
ZoneFunction::Scratch& ZoneFunction::Scratch::operator=(Scratch&&) noexcept = default;
ZoneFunction::Scratch::~Scratch() = default;

ZoneFunction::ZoneFunction(std::shared_ptr<const State> state) : state_(std::move(state)) {}

const std::vector<Constraint>& ZoneFunction::constraints() const {
  return state_->constraints;
}
const Region& ZoneFunction::region() const {
  return state_->region;
}

std::vector<std::string> ZoneFunction::EndNames() const {
  std::vector<std::string> out;
  const Region& region = state_->region;
  for (std::size_t i = 0; i < region.dimension(); ++i) {
    const kinematics::Coordinate& of =
        state_->judge->machine().coordinates()[static_cast<std::size_t>(region.varied[i])];
    const bool lower = of.lower && *of.lower >= region.lower[i];
    const bool upper = of.upper && *of.upper <= region.upper[i];
    out.push_back(of.name + (lower ? " at its lower limit" : " at the edge of the search"));
    out.push_back(of.name + (upper ? " at its upper limit" : " at the edge of the search"));
  }
  return out;
}

Parsed<ZoneFunction> ZoneFunction::Make(const PoseJudge& judge,
                                        const Region& region,
                                        bool regular) {
  if (region.dimension() == 0 || region.dimension() > kDirections) {
    return tl::unexpected(Diagnostics{
        {.code = "E0723",
         .message = fmt::format("{} coordinates are varied", region.dimension()),
         .help = "a zone has one, two or three; hold the others where the zone is wanted"}});
  }
  auto state = std::make_shared<State>();
  state->judge = &judge;
  state->region = region;
  state->constraints = judge.constraints();
  Diagnostics problems;
  for (std::size_t m = 0; m < judge.mechanisms().size(); ++m) {
    const PoseJudge::Mechanism& mechanism = judge.mechanisms()[m];
    MechanismSlots slots;
    FormulaTape& tape = state->tape;
    const std::vector<Slot> x = VariablesOf(tape, mechanism, region, {});
    slots.drives = tape.Record(*mechanism.code, plugin::Quantity::kDrives, false, x);
    slots.reach = tape.Record(*mechanism.code, plugin::Quantity::kReach, false, x);
    if (slots.drives.empty() || slots.reach.empty()) {
      problems.push_back({.code = "E0722",
                          .message = "the module of " + mechanism.block + " records no formulas",
                          .help = "its plugin must build from the SDK's AutodiffMechanism"});
      continue;
    }
    const std::vector<Slot> all = VariablesOf(tape, mechanism, region, slots.drives);
    if (!mechanism.joints.empty() || !mechanism.pairs.empty()) {
      slots.points = tape.Record(*mechanism.code, plugin::Quantity::kSkeleton, false, all);
      slots.platform = tape.Record(*mechanism.code, plugin::Quantity::kPlatform, false, all);
    }
    if (regular && PrepareSign(mechanism, judge.machine().home(), slots)) {
      const std::vector<Slot> roots =
          tape.Record(*mechanism.code, plugin::Quantity::kClosure, true, all);
      const auto closures = static_cast<std::ptrdiff_t>(mechanism.shape.closures);
      slots.a.assign(roots.begin() + std::min<std::ptrdiff_t>(closures, std::ssize(roots)),
                     roots.end());
    }
    if (!slots.a.empty()) {
      state->constraints.push_back({.kind = Kind::kRegular,
                                    .name = mechanism.block + " singular (type 2)",
                                    .mechanism = static_cast<int>(m)});
    }
    state->slots.push_back(std::move(slots));
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  int last_reach = -1;
  for (std::size_t c = 0; c < state->constraints.size(); ++c) {
    const Kind kind = state->constraints[c].kind;
    if (kind == Kind::kReach) last_reach = static_cast<int>(c);
    const bool of_drive = kind == Kind::kDriveLower || kind == Kind::kDriveUpper;
    state->reach_of.push_back(of_drive ? last_reach : -1);
  }
  return ZoneFunction(std::move(state));
}

ZoneFunction::Judged ZoneFunction::Judge(std::span<const double> lower,
                                         std::span<const double> upper,
                                         Scratch& scratch) const {
  Scratch::Values& values = *scratch.values_;
  std::array<Interval, kDirections> wide;
  std::array<Interval, kDirections> middle;
  values.half.fill(0.0);
  bool point = true;
  for (std::size_t i = 0; i < lower.size(); ++i) {
    wide[i] = {lower[i], upper[i]};
    middle[i] = Interval(wide[i].Middle());
    values.half[i] = std::max(upper[i] - middle[i].lower, middle[i].lower - lower[i]);
    point = point && lower[i] == upper[i];
  }
  state_->tape.Evaluate(wide, !point, values.wide);
  if (!point) state_->tape.Evaluate(middle, false, values.middle);
  const BoxView box(values.wide, point ? values.wide : values.middle, values.half);
  std::size_t undecided = 0;
  double left_out = 0.0;
  double most = 1.0;
  int cause = -1;
  bool singular = false;
  std::fill(values.all_reached.begin(), values.all_reached.end(), 1);
  for (std::size_t c = 0; c < state_->constraints.size(); ++c) {
    const Constraint& constraint = state_->constraints[c];
    const auto m = static_cast<std::size_t>(constraint.mechanism);
    const int reach = state_->reach_of[c];
    const bool smooth = !point && (reach >= 0 ? values.reached[static_cast<std::size_t>(reach)] != 0
                                              : values.all_reached[m] != 0);
    const Outcome outcome =
        DecideOne(constraint, state_->judge->mechanisms()[m], state_->slots[m], box, smooth);
    if (constraint.kind == Kind::kReach) {
      values.reached[c] = outcome.kept ? 1 : 0;
      if (!outcome.kept) values.all_reached[m] = 0;
    }
    if (outcome.broken) {
      return {
          .verdict = Verdict::kOutside, .least = 0.0, .most = 0.0, .cause = static_cast<int>(c)};
    }
    if (outcome.kept) continue;
    ++undecided;
    singular = singular || constraint.kind == Kind::kRegular;
    left_out += 1.0 - outcome.share.least;
    if (outcome.share.most < most || cause < 0) {
      most = std::min(most, outcome.share.most);
      cause = static_cast<int>(c);
    }
  }
  if (undecided == 0) return {.verdict = Verdict::kInside, .least = 1.0, .most = 1.0};
  return {.verdict = Verdict::kBoundary,
          .least = std::max(0.0, 1.0 - left_out),
          .most = most,
          .cause = cause,
          .singular = singular};
}

bool ZoneFunction::Inside(std::span<const double> at, Scratch& scratch) const {
  return Judge(at, at, scratch).verdict == Verdict::kInside;
}

}  // namespace kompono::analysis
