// SPDX-License-Identifier: Apache-2.0
// What each kind of instrument says of the tool's pose, with derivatives.
#include "residuals.hpp"
#include <fmt/format.h>

#include <cmath>
#include <cstddef>

namespace kompono::calibration {
namespace {

using Matrix36 = Eigen::Matrix<double, 3, 6>;

/// A direction and two more that complete it to a right-handed frame.
struct PlaneFrame {
  Eigen::Vector3d n, e1, e2;
};
PlaneFrame FrameOf(const Eigen::Vector3d& normal) {
  PlaneFrame frame;
  frame.n = normal.normalized();
  const Eigen::Vector3d other = std::abs(frame.n.x()) < 0.7
                                    ? Eigen::Vector3d(Eigen::Vector3d::UnitX())
                                    : Eigen::Vector3d(Eigen::Vector3d::UnitY());
  frame.e1 = (other - frame.n * frame.n.dot(other)).normalized();
  frame.e2 = frame.n.cross(frame.e1);
  return frame;
}

/// A target on the tool: where it is and how it moves with the tool and with its own numbers.
struct TargetPoint {
  Eigen::Vector3d p_WQ;
  Matrix36 by_twist;
  Eigen::Matrix3d by_offset;
};
/// Of a fixture's first number.
std::ptrdiff_t ValueIndex(int fixture) {
  return 3 * static_cast<std::ptrdiff_t>(fixture);
}

TargetPoint TargetOn(const Pose<double>& X_WT,
                     const Measurement& measurement,
                     const FixtureValues& fixtures) {
  Eigen::Vector3d p_TQ = Eigen::Vector3d::Zero();
  if (measurement.target >= 0) {
    p_TQ = Eigen::Map<const Eigen::Vector3d>(fixtures.value + ValueIndex(measurement.target));
  }
  TargetPoint point;
  const Eigen::Vector3d arm = X_WT.R * p_TQ;
  point.p_WQ = X_WT.p + arm;
  point.by_twist.leftCols<3>().setIdentity();
  point.by_twist.rightCols<3>() = -CrossMatrix(arm);
  point.by_offset = X_WT.R;
  return point;
}

struct Plane {
  Eigen::Vector3d n;
  Eigen::Matrix<double, 3, 2> by_tilt;
  double offset_mm = 0.0;
};
/// The plane that a height was measured from.
Plane PlaneOf(const Measurement& measurement, const FixtureValues& fixtures) {
  const double* value = fixtures.value + ValueIndex(measurement.fixture);
  const PlaneFrame frame =
      FrameOf((*fixtures.fixtures)[static_cast<std::size_t>(measurement.fixture)].normal);
  const Eigen::Vector3d leaning = frame.n + value[0] * frame.e1 + value[1] * frame.e2;
  const double length = leaning.norm();
  Plane plane;
  plane.n = leaning / length;
  const Eigen::Matrix3d across =
      (Eigen::Matrix3d::Identity() - plane.n * plane.n.transpose()) / length;
  plane.by_tilt.col(0) = across * frame.e1;
  plane.by_tilt.col(1) = across * frame.e2;
  plane.offset_mm = value[2];
  return plane;
}

/// Measured components of a point in a frame turned by R: error and the rows to keep.
Eigen::Vector3d InSheet(const Eigen::Vector3d& p_WQ, const double* sheet) {
  const Eigen::Vector3d from(p_WQ.x() - sheet[0], p_WQ.y() - sheet[1], p_WQ.z());
  return RotationZ(sheet[2]).transpose() * from;
}

/// Keeps the rows of measured components.
template <class Full, class Kept>
int KeepMeasured(const Measurement& measurement, const Full& full, Kept* kept) {
  int at = 0;
  for (int i = 0; i < 3; ++i) {
    if (measurement.position_mm[static_cast<std::size_t>(i)]) kept->row(at++) = full.row(i);
  }
  return at;
}

/// The second tool frame as seen from the first.
Pose<double> RelativePose(const Pose<double>& X_WT, const Pose<double>& X_WT_second) {
  return X_WT.Inverse() * X_WT_second;
}

void PointErrors(const Measurement& measurement, const Eigen::Vector3d& point, RowErrors* errors) {
  int at = 0;
  for (int i = 0; i < 3; ++i) {
    const std::optional<double>& measured = measurement.position_mm[static_cast<std::size_t>(i)];
    if (measured) errors->value[at++] = point[i] - *measured;
  }
  errors->lengths = at;
}

void MapsOfRelative(const Measurement& measurement,
                    const Pose<double>& X_WT,
                    const Pose<double>& X_WT_second,
                    RowMaps* maps) {
  const Pose<double> X_TT = RelativePose(X_WT, X_WT_second);
  Eigen::Matrix3d R_TW = X_WT.R;
  R_TW.transposeInPlace();
  const Eigen::Matrix3d turn =
      LeftJacobianInverse(RotationVector(X_TT.R * measurement.R_WT.transpose())) * R_TW;
  Matrix36 first;
  first.leftCols<3>() = -R_TW;
  first.rightCols<3>() = R_TW * CrossMatrix(X_WT_second.p - X_WT.p);
  Matrix36 second = Matrix36::Zero();
  second.leftCols<3>() = R_TW;
  maps->second.setZero(measurement.Numbers(), 6);
  const int lengths = KeepMeasured(measurement, first, &maps->first);
  KeepMeasured(measurement, second, &maps->second);
  maps->first.block<3, 3>(lengths, 3) = -turn;
  maps->second.block<3, 3>(lengths, 3) = turn;
}

void MapsOfPoint(const Measurement& measurement,
                 const Pose<double>& X_WT,
                 const TargetPoint& point,
                 RowMaps* maps) {
  const int lengths = KeepMeasured(measurement, point.by_twist, &maps->first);
  if (measurement.target >= 0) KeepMeasured(measurement, point.by_offset, &maps->target);
  if (measurement.kind == MeasurementKind::kPose) {
    maps->first.block<3, 3>(lengths, 3) =
        LeftJacobianInverse(RotationVector(X_WT.R * measurement.R_WT.transpose()));
  }
}

void MapsOfHole(const Measurement& measurement,
                const TargetPoint& point,
                const FixtureValues& fixtures,
                RowMaps* maps) {
  constexpr std::array<double, 3> kNoSheet{};
  const double* sheet =
      measurement.fixture < 0 ? kNoSheet.data() : fixtures.value + ValueIndex(measurement.fixture);
  const Eigen::Matrix3d R_SW = RotationZ(sheet[2]).transpose();
  KeepMeasured(measurement, Matrix36(R_SW * point.by_twist), &maps->first);
  if (measurement.target >= 0) {
    KeepMeasured(measurement, Eigen::Matrix3d(R_SW * point.by_offset), &maps->target);
  }
  if (measurement.fixture < 0) return;
  const Eigen::Vector3d p_SQ = InSheet(point.p_WQ, sheet);
  Eigen::Matrix3d by_sheet = Eigen::Matrix3d::Zero();
  by_sheet.leftCols<2>() = -R_SW.leftCols<2>();
  by_sheet.col(2) << p_SQ.y(), -p_SQ.x(), 0.0;
  KeepMeasured(measurement, by_sheet, &maps->fixture);
}

/// One number whose derivative by the point is `along`.
void MapsAlong(const Eigen::Vector3d& along, const TargetPoint& point, RowMaps* maps) {
  maps->first = along.transpose() * point.by_twist;
  if (maps->target.rows() > 0) maps->target = along.transpose() * point.by_offset;
}

void MapsOfDistance(const TargetPoint& first, const TargetPoint& second, RowMaps* maps) {
  const Eigen::Vector3d between = first.p_WQ - second.p_WQ;
  const double distance = between.norm();
  const Eigen::Vector3d along =
      distance > 0.0 ? Eigen::Vector3d(between / distance) : Eigen::Vector3d::Zero();
  MapsAlong(along, first, maps);
  maps->second = -along.transpose() * second.by_twist;
  if (maps->target.rows() > 0) maps->target -= along.transpose() * second.by_offset;
}

}  // namespace

RowErrors ErrorsOf(const Measurement& measurement,
                   const Pose<double>& X_WT,
                   const Pose<double>& X_WT_second,
                   const FixtureValues& fixtures) {
  RowErrors errors;
  errors.value.resize(measurement.Numbers());
  errors.lengths = static_cast<int>(errors.value.size());
  const TargetPoint point = TargetOn(X_WT, measurement, fixtures);
  const double* fixture =
      measurement.fixture < 0 ? nullptr : fixtures.value + ValueIndex(measurement.fixture);
  switch (measurement.kind) {
    case MeasurementKind::kHeight:
      errors.value[0] = point.p_WQ.z() - measurement.value_mm;
      break;
    case MeasurementKind::kDistance:
      errors.value[0] = (point.p_WQ - TargetOn(X_WT_second, measurement, fixtures).p_WQ).norm() -
                        measurement.value_mm;
      break;
    case MeasurementKind::kBallBar:
      errors.value[0] =
          (point.p_WQ - Eigen::Map<const Eigen::Vector3d>(fixture)).norm() - measurement.value_mm;
      break;
    case MeasurementKind::kPlane: {
      const Plane plane = PlaneOf(measurement, fixtures);
      errors.value[0] = plane.n.dot(point.p_WQ) - plane.offset_mm - measurement.value_mm;
      break;
    }
    case MeasurementKind::kHole:
      PointErrors(
          measurement, fixture == nullptr ? point.p_WQ : InSheet(point.p_WQ, fixture), &errors);
      break;
    case MeasurementKind::kPosition:
      PointErrors(measurement, point.p_WQ, &errors);
      break;
    case MeasurementKind::kPose:
      PointErrors(measurement, point.p_WQ, &errors);
      errors.value.tail<3>() = RotationVector(X_WT.R * measurement.R_WT.transpose());
      break;
    case MeasurementKind::kRelative: {
      const Pose<double> X_TT = RelativePose(X_WT, X_WT_second);
      PointErrors(measurement, X_TT.p, &errors);
      errors.value.tail<3>() = RotationVector(X_TT.R * measurement.R_WT.transpose());
      break;
    }
  }
  return errors;
}

RowMaps MapsOf(const Measurement& measurement,
               const Pose<double>& X_WT,
               const Pose<double>& X_WT_second,
               const FixtureValues& fixtures) {
  RowMaps maps;
  const int numbers = measurement.Numbers();
  maps.first.setZero(numbers, 6);
  if (measurement.target >= 0) maps.target.setZero(numbers, 3);
  if (measurement.fixture >= 0) maps.fixture.setZero(numbers, 3);
  const TargetPoint point = TargetOn(X_WT, measurement, fixtures);
  const double* fixture =
      measurement.fixture < 0 ? nullptr : fixtures.value + ValueIndex(measurement.fixture);
  switch (measurement.kind) {
    case MeasurementKind::kHeight:
      MapsAlong(Eigen::Vector3d::UnitZ(), point, &maps);
      break;
    case MeasurementKind::kDistance:
      MapsOfDistance(point, TargetOn(X_WT_second, measurement, fixtures), &maps);
      break;
    case MeasurementKind::kBallBar: {
      const Eigen::Vector3d from = point.p_WQ - Eigen::Map<const Eigen::Vector3d>(fixture);
      const Eigen::Vector3d along = from / std::max(from.norm(), 1e-300);
      MapsAlong(along, point, &maps);
      maps.fixture = -along.transpose();
      break;
    }
    case MeasurementKind::kPlane: {
      const Plane plane = PlaneOf(measurement, fixtures);
      MapsAlong(plane.n, point, &maps);
      maps.fixture.leftCols<2>() = point.p_WQ.transpose() * plane.by_tilt;
      maps.fixture(0, 2) = -1.0;
      break;
    }
    case MeasurementKind::kHole:
      MapsOfHole(measurement, point, fixtures, &maps);
      break;
    case MeasurementKind::kPosition:
    case MeasurementKind::kPose:
      MapsOfPoint(measurement, X_WT, point, &maps);
      break;
    case MeasurementKind::kRelative:
      MapsOfRelative(measurement, X_WT, X_WT_second, &maps);
      break;
  }
  return maps;
}

std::string_view Name(FixtureKind kind) {
  switch (kind) {
    case FixtureKind::kTarget:
      return "target";
    case FixtureKind::kCentre:
      return "centre";
    case FixtureKind::kPlane:
      return "plane";
    case FixtureKind::kSheet:
      break;
  }
  return "sheet";
}

std::vector<kinematics::Parameter> AllParameters(const kinematics::Machine& machine,
                                                 const MeasurementSet& set) {
  using Names = std::array<const char*, 3>;
  std::vector<kinematics::Parameter> all = machine.parameters();
  for (const Fixture& fixture : set.fixtures) {
    const Names names = fixture.kind == FixtureKind::kPlane   ? Names{"tilt_1", "tilt_2", "offset"}
                        : fixture.kind == FixtureKind::kSheet ? Names{"x", "y", "c"}
                                                              : Names{"x", "y", "z"};
    for (std::size_t i = 0; i < 3; ++i) {
      all.push_back({.name = fmt::format("{}.{}.{}", Name(fixture.kind), fixture.name, names[i]),
                     .nominal = fixture.value[i],
                     .tolerance = 0.0,
                     .angle = (fixture.kind == FixtureKind::kPlane && i < 2) ||
                              (fixture.kind == FixtureKind::kSheet && i == 2),
                     .identifiable = !fixture.known});
    }
  }
  return all;
}

Eigen::VectorXd AllNominal(const kinematics::Machine& machine, const MeasurementSet& set) {
  const Eigen::VectorXd own = machine.nominal();
  Eigen::VectorXd all(own.size() + 3 * static_cast<Eigen::Index>(set.fixtures.size()));
  all.head(own.size()) = own;
  Eigen::Index at = own.size();
  for (const Fixture& fixture : set.fixtures) {
    for (const double value : fixture.value) all[at++] = value;
  }
  return all;
}

}  // namespace kompono::calibration
