// SPDX-License-Identifier: Apache-2.0
#include "fixture_book.hpp"

#include "residuals.hpp"
#include <fmt/format.h>

#include <cmath>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "kompono/calibration/codes.hpp"

namespace kompono::calibration {
namespace {

constexpr double kSamePlace = 1e-9;  ///< mm

FixtureKind FixtureOf(MeasurementKind kind) {
  if (kind == MeasurementKind::kBallBar) return FixtureKind::kCentre;
  if (kind == MeasurementKind::kPlane) return FixtureKind::kPlane;
  return FixtureKind::kSheet;
}

bool Same(const Fixture& a, const Fixture& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(a.value[i] - b.value[i]) > kSamePlace) return false;
  }
  return a.normal.isApprox(b.normal, 1e-12);
}

/// Where the nominal machine's tool is in the rows of one fixture.
struct Seen {
  std::vector<Eigen::Vector3d> p_WT;
  std::vector<const Measurement*> rows;
};

Seen PointsOf(const kinematics::Machine& machine, const MeasurementSet& set, int fixture) {
  Seen seen;
  for (const Measurement& m : set.measurements) {
    if (m.fixture != fixture) continue;
    RowModel model(machine, m, 1.0, 1.0);
    const RowModel::Prediction prediction = model.FindStart(machine.nominal(), nullptr);
    if (!prediction.ok()) continue;
    Eigen::Vector3d p_TQ = Eigen::Vector3d::Zero();
    if (m.target >= 0) {
      const auto& offset = set.fixtures[static_cast<std::size_t>(m.target)].value;
      p_TQ << offset[0], offset[1], offset[2];
    }
    seen.p_WT.push_back(prediction.first.X_WT * p_TQ);
    seen.rows.push_back(&m);
  }
  return seen;
}

/// |p_k - c| = d_k, differences of squares: linear in c.
void GuessCentre(const Seen& seen, Fixture* centre) {
  const auto n = static_cast<Eigen::Index>(seen.rows.size());
  if (n < 4) return;
  Eigen::MatrixXd A(n, 4);
  Eigen::VectorXd b(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Vector3d& p = seen.p_WT[static_cast<std::size_t>(k)];
    const double d = seen.rows[static_cast<std::size_t>(k)]->value_mm;
    A.row(k) << 2.0 * p.transpose(), 1.0;
    b[k] = p.squaredNorm() - d * d;
  }
  const Eigen::VectorXd solution = A.completeOrthogonalDecomposition().solve(b);
  for (int i = 0; i < 3; ++i) centre->value[static_cast<std::size_t>(i)] = solution[i];
}

void GuessPlane(const Seen& seen, Fixture* plane) {
  if (seen.rows.size() < 3) return;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double value = 0.0;
  for (std::size_t k = 0; k < seen.rows.size(); ++k) {
    middle += seen.p_WT[k];
    value += seen.rows[k]->value_mm;
  }
  middle /= static_cast<double>(seen.rows.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : seen.p_WT) {
    spread += (p - middle) * (p - middle).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(spread, Eigen::ComputeFullU);
  Eigen::Vector3d normal = svd.matrixU().col(2);
  Eigen::Index largest = 0;
  normal.cwiseAbs().maxCoeff(&largest);
  if (normal[largest] < 0.0) normal = -normal;
  plane->normal = normal;
  plane->value = {0.0, 0.0, normal.dot(middle) - value / static_cast<double>(seen.rows.size())};
}

/// The turn and shift that bring the measured holes nearest to the jet.
void GuessSheet(const Seen& seen, Fixture* sheet) {
  Eigen::Vector2d mean_W = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_S = Eigen::Vector2d::Zero();
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> pairs;
  for (std::size_t k = 0; k < seen.rows.size(); ++k) {
    const Measurement& m = *seen.rows[k];
    if (!m.position_mm[0] || !m.position_mm[1]) continue;
    pairs.emplace_back(seen.p_WT[k].head<2>(),
                       Eigen::Vector2d(*m.position_mm[0], *m.position_mm[1]));
    mean_W += pairs.back().first;
    mean_S += pairs.back().second;
  }
  if (pairs.size() < 2) return;
  mean_W /= static_cast<double>(pairs.size());
  mean_S /= static_cast<double>(pairs.size());
  double sine = 0.0;
  double cosine = 0.0;
  for (const auto& [in_W, in_S] : pairs) {
    const Eigen::Vector2d w = in_W - mean_W;
    const Eigen::Vector2d s = in_S - mean_S;
    cosine += s.dot(w);
    sine += s.x() * w.y() - s.y() * w.x();
  }
  const double turn = std::atan2(sine, cosine);
  const Eigen::Vector2d origin(
      mean_W.x() - std::cos(turn) * mean_S.x() + std::sin(turn) * mean_S.y(),
      mean_W.y() - std::sin(turn) * mean_S.x() - std::cos(turn) * mean_S.y());
  sheet->value = {origin.x(), origin.y(), turn};
}

}  // namespace

std::optional<Fixture> FixtureBook::Numbers(const RowCells& cells, FixtureKind kind) const {
  const Role role = kind == FixtureKind::kTarget   ? Role::kTarget
                    : kind == FixtureKind::kCentre ? Role::kCentre
                                                   : Role::kPlaneNormal;
  if (kind == FixtureKind::kSheet) return std::nullopt;
  Fixture fixture{.kind = kind};
  std::array<double, 3> number{};
  bool any = false;
  for (int i = 0; i < 3; ++i) {
    const int column = columns_.Find(role, i);
    if (cells.Empty(column)) continue;
    any = true;
    number[static_cast<std::size_t>(i)] =
        cells.value[static_cast<std::size_t>(column)].value_or(0.0);
  }
  if (!any) return std::nullopt;
  if (kind != FixtureKind::kPlane) {
    fixture.value = number;
    return fixture;
  }
  const Eigen::Vector3d normal(number[0], number[1], number[2]);
  if (normal.norm() < 1e-9) return std::nullopt;
  fixture.normal = normal.normalized();
  const int offset = columns_.Find(Role::kPlaneOffset);
  if (!cells.Empty(offset)) {
    fixture.value[2] = cells.value[static_cast<std::size_t>(offset)].value_or(0.0);
  }
  return fixture;
}

int FixtureBook::Find(const RowCells& cells, FixtureKind kind) {
  const int column = columns_.Find(Role::kFixtureName, static_cast<int>(kind));
  std::optional<Fixture> numbers = Numbers(cells, kind);
  std::string name;
  if (!cells.Empty(column)) {
    name = std::string(cells.row->cells[static_cast<std::size_t>(column)].text);
  }
  if (name.empty() && !numbers) return -1;
  if (name.empty()) {  // numbers without a name: the same numbers are the same fixture
    for (std::size_t i = 0; i < fixtures_.size(); ++i) {
      if (fixtures_[i].kind == kind && Same(fixtures_[i], *numbers)) return static_cast<int>(i);
    }
    name = fmt::format("{}", fixtures_.size() + 1);
  }
  const auto [found, is_new] =
      index_.emplace(std::pair(kind, name), static_cast<int>(fixtures_.size()));
  if (is_new) {
    Fixture fixture = numbers.value_or(Fixture{.kind = kind});
    fixture.name = name;
    fixture.known = numbers.has_value();
    fixtures_.push_back(std::move(fixture));
    return found->second;
  }
  Fixture& known = fixtures_[static_cast<std::size_t>(found->second)];
  if (!numbers) return found->second;
  if (!known.known) {
    numbers->name = name;
    known = std::move(*numbers);
  } else if (!Same(known, *numbers)) {
    complaints_.Add(
        Severity::kError,
        codes::kTwoPlaces.code,
        cells.row->begin,
        cells.row->end,
        fmt::format("{} '{}' has other numbers here than in an earlier row", Name(kind), name),
        "give the numbers once, or use another name");
    return -2;
  }
  return found->second;
}

bool FixtureBook::Read(const RowCells& cells, Measurement* measurement) {
  measurement->target = Find(cells, FixtureKind::kTarget);
  bool good = measurement->target != -2;
  const MeasurementKind kind = measurement->kind;
  if (kind != MeasurementKind::kBallBar && kind != MeasurementKind::kPlane &&
      kind != MeasurementKind::kHole) {
    return good;
  }
  measurement->fixture = Find(cells, FixtureOf(kind));
  if (measurement->fixture == -1 && kind != MeasurementKind::kHole) {
    complaints_.Add(Severity::kError,
                    codes::kNoFixture.code,
                    cells.row->begin,
                    cells.row->end,
                    fmt::format("a {} row needs a {}", Name(kind), Name(FixtureOf(kind))),
                    fmt::format("fill the column '{}' with a name, or give its numbers",
                                Name(FixtureOf(kind))));
    return false;
  }
  return good && measurement->fixture != -2;
}

void GuessUnknownFixtures(const kinematics::Machine& machine, MeasurementSet* set) {
  for (std::size_t i = 0; i < set->fixtures.size(); ++i) {
    Fixture* fixture = &set->fixtures[i];
    if (fixture->known || fixture->kind == FixtureKind::kTarget) continue;
    const Seen seen = PointsOf(machine, *set, static_cast<int>(i));
    if (fixture->kind == FixtureKind::kCentre) GuessCentre(seen, fixture);
    if (fixture->kind == FixtureKind::kPlane) GuessPlane(seen, fixture);
    if (fixture->kind == FixtureKind::kSheet) GuessSheet(seen, fixture);
  }
}

}  // namespace kompono::calibration
