// SPDX-License-Identifier: Apache-2.0
// What the plugin boundary and the templates over the scalar cost: the inverse kinematics of a
// linear delta, hand-written for doubles in this file, against the pyramid plugin asked for one
// pose, for a batch in packs, and for one pose with its Jacobian; and its forward kinematics in
// closed form.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/plugin/registry.hpp"

namespace {

using kompono::plugin::Mechanism;
using kompono::plugin::MechanismBatch;
using kompono::plugin::Quantity;

constexpr std::size_t kPoses = 1024;
constexpr std::size_t kLegs = 3;
constexpr double kRailRadius = 400.0;  // mm
constexpr double kJointRadius = 50.0;  // mm
constexpr double kStrut = 700.0;       // mm

/// θ of the module `pyramid`: start and end of each rail, joints, struts.
std::vector<double> LinearDelta() {
  std::vector<double> theta;
  const auto add_ring = [&theta](double radius, double height) {
    for (std::size_t i = 0; i < kLegs; ++i) {
      const double azimuth = 2.0 * std::numbers::pi / 3.0 * static_cast<double>(i);
      theta.insert(theta.end(), {radius * std::cos(azimuth), radius * std::sin(azimuth), height});
    }
  };
  add_ring(kRailRadius, 0.0);
  add_ring(kRailRadius, 1000.0);
  add_ring(kJointRadius, 0.0);
  theta.insert(theta.end(), kLegs, kStrut);
  return theta;
}

struct Poses {
  std::array<std::vector<double>, 3> x;
  Poses() {
    for (std::size_t k = 0; k < kPoses; ++k) {
      const double t = static_cast<double>(k) / kPoses;
      x[0].push_back(150.0 * std::sin(7.0 * t));
      x[1].push_back(150.0 * std::cos(11.0 * t));
      x[2].push_back(100.0 * t);
    }
  }
};

const kompono::plugin::Registry& Modules() {
  static const std::array<std::filesystem::path, 1> folders{
      std::filesystem::path(KOMPONO_BINARY_DIR) / "lib/kompono/plugins"};
  static const auto registry = kompono::plugin::Registry::Discover(folders);
  return registry;
}

std::shared_ptr<const Mechanism> Pyramid() {
  auto mechanism = Modules().CreateMechanism("pyramid");
  if (!mechanism) {
    std::fputs("the plugin `pyramid` is not built\n", stderr);
    std::exit(1);
  }
  return *mechanism;
}

const std::vector<double> kModes{1.0, 1.0, 1.0, -1.0};

/// As a control would write it for general rails: no templates, no packs, no library boundary.
std::array<double, kLegs> HandWrittenDrives(const double* theta, double x, double y, double z) {
  std::array<double, kLegs> q{};
  for (std::size_t i = 0; i < kLegs; ++i) {
    const double* start = theta + 3 * i;
    const double* end = theta + 9 + 3 * i;
    const double* joint = theta + 18 + 3 * i;
    const double strut = theta[27 + i];
    const double ux = end[0] - start[0];
    const double uy = end[1] - start[1];
    const double uz = end[2] - start[2];
    const double length = std::sqrt(ux * ux + uy * uy + uz * uz);
    const double wx = x + joint[0] - start[0];
    const double wy = y + joint[1] - start[1];
    const double wz = z + joint[2] - start[2];
    const double along = (ux * wx + uy * wy + uz * wz) / length;
    const double radicand = strut * strut - (wx * wx + wy * wy + wz * wz - along * along);
    q[i] = along + std::sqrt(radicand);
  }
  return q;
}

void HandWritten(benchmark::State& state) {
  std::vector<double> theta = LinearDelta();
  const Poses poses;
  for (auto _ : state) {
    benchmark::DoNotOptimize(theta.data());
    for (std::size_t k = 0; k < kPoses; ++k) {
      std::array<double, kLegs> q =
          HandWrittenDrives(theta.data(), poses.x[0][k], poses.x[1][k], poses.x[2][k]);
      benchmark::DoNotOptimize(q);
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPoses));
}

void OnePose(benchmark::State& state, Quantity quantity, bool with_jacobian) {
  const auto pyramid = Pyramid();
  const std::vector<double> theta = LinearDelta();
  const Poses poses;
  std::array<double, kLegs> values{};
  std::array<double, kLegs * 3> jacobian{};
  const std::span<double> by_x = with_jacobian ? std::span<double>(jacobian) : std::span<double>();
  for (auto _ : state) {
    for (std::size_t k = 0; k < kPoses; ++k) {
      const std::array<double, 3> x{poses.x[0][k], poses.x[1][k], poses.x[2][k]};
      pyramid->Evaluate(
          quantity,
          {.coordinates = x, .drives = {}, .parameters = theta, .modes = kModes},
          {.values = values, .by_coordinates = by_x, .by_drives = {}, .by_parameters = {}});
      benchmark::DoNotOptimize(values);
      benchmark::DoNotOptimize(jacobian);
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPoses));
}

void Batch(benchmark::State& state) {
  const auto pyramid = Pyramid();
  const std::vector<double> theta = LinearDelta();
  const Poses poses;
  std::array<std::vector<double>, kLegs> q;
  for (auto& one : q) one.resize(kPoses);
  const std::array<const double*, 3> in{poses.x[0].data(), poses.x[1].data(), poses.x[2].data()};
  const std::array<double*, 3> out{q[0].data(), q[1].data(), q[2].data()};
  const MechanismBatch batch{.count = kPoses,
                             .coordinates = in.data(),
                             .drives = nullptr,
                             .parameters = theta,
                             .modes = kModes,
                             .values = out.data()};
  for (auto _ : state) {
    pyramid->EvaluateBatch(Quantity::kDrives, batch);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPoses));
}

/// Forward: as a control would write it for this machine, rails upright and all struts alike; what
/// depends on the geometry alone is known beforehand.
std::array<double, 3> HandWrittenPlace(const std::array<std::array<double, 2>, kLegs>& centre,
                                       double strut,
                                       const std::array<double, kLegs>& q) {
  const double ax = centre[1][0] - centre[0][0];
  const double ay = centre[1][1] - centre[0][1];
  const double az = q[1] - q[0];
  const double bx = centre[2][0] - centre[0][0];
  const double by = centre[2][1] - centre[0][1];
  const double bz = q[2] - q[0];
  const double nx = ay * bz - az * by;
  const double ny = az * bx - ax * bz;
  const double nz = ax * by - ay * bx;
  const double area2 = nx * nx + ny * ny + nz * nz;
  const double ka = 0.5 * (ax * ax + ay * ay + az * az);
  const double kb = 0.5 * (bx * bx + by * by + bz * bz);
  const double cx = ka * bx - kb * ax;
  const double cy = ka * by - kb * ay;
  const double cz = ka * bz - kb * az;
  const double fx = (cy * nz - cz * ny) / area2;
  const double fy = (cz * nx - cx * nz) / area2;
  const double fz = (cx * ny - cy * nx) / area2;
  const double height = -std::sqrt((strut * strut - (fx * fx + fy * fy + fz * fz)) / area2);
  return {
      centre[0][0] + fx + nx * height, centre[0][1] + fy + ny * height, q[0] + fz + nz * height};
}

/// Drive positions of the poses above.
std::array<std::vector<double>, kLegs> DrivePositions(const std::vector<double>& theta) {
  const Poses poses;
  std::array<std::vector<double>, kLegs> out;
  for (std::size_t k = 0; k < kPoses; ++k) {
    const auto q = HandWrittenDrives(theta.data(), poses.x[0][k], poses.x[1][k], poses.x[2][k]);
    for (std::size_t i = 0; i < kLegs; ++i) out[i].push_back(q[i]);
  }
  return out;
}

void HandWrittenForward(benchmark::State& state) {
  const std::vector<double> theta = LinearDelta();
  const auto drives = DrivePositions(theta);
  std::array<std::array<double, 2>, kLegs> centre{};
  for (std::size_t i = 0; i < kLegs; ++i)
    centre[i] = {theta[3 * i] - theta[18 + 3 * i], theta[3 * i + 1] - theta[19 + 3 * i]};
  for (auto _ : state) {
    benchmark::DoNotOptimize(centre.data());
    for (std::size_t k = 0; k < kPoses; ++k) {
      std::array<double, 3> x =
          HandWrittenPlace(centre, kStrut, {drives[0][k], drives[1][k], drives[2][k]});
      benchmark::DoNotOptimize(x);
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPoses));
}

/// Any rails, through the plugin's boundary: geometry prepared at every call.
void Forward(benchmark::State& state) {
  const auto pyramid = Pyramid();
  const std::vector<double> theta = LinearDelta();
  const auto drives = DrivePositions(theta);
  std::array<double, 3> x{};
  for (auto _ : state) {
    for (std::size_t k = 0; k < kPoses; ++k) {
      const std::array<double, kLegs> q{drives[0][k], drives[1][k], drives[2][k]};
      pyramid->Evaluate(Quantity::kCoordinates,
                        {.coordinates = {}, .drives = q, .parameters = theta, .modes = kModes},
                        {.values = x});
      benchmark::DoNotOptimize(x);
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPoses));
}

/// The same with the geometry bound.
void BoundForward(benchmark::State& state) {
  const std::vector<double> theta = LinearDelta();
  const auto pyramid = Modules().CreateBound("pyramid", theta, kModes);
  if (!pyramid) return state.SkipWithError(pyramid.error().message.c_str());
  const auto drives = DrivePositions(theta);
  const Poses poses;
  std::array<double, 3> x{};
  for (auto _ : state) {
    for (std::size_t k = 0; k < kPoses; ++k) {
      const std::array<double, kLegs> q{drives[0][k], drives[1][k], drives[2][k]};
      (*pyramid)->Coordinates(q, x);
      benchmark::DoNotOptimize(x);
    }
  }
  if (std::abs(x[2] - poses.x[2].back()) > 1e-9) state.SkipWithError("not the pose that went in");
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPoses));
}

BENCHMARK(HandWrittenForward)->Name("forward/baseline");
BENCHMARK(Forward)->Name("forward/one_pose");
BENCHMARK(BoundForward)->Name("forward/bound");
BENCHMARK(HandWritten)->Name("drives/baseline");
BENCHMARK_CAPTURE(OnePose, one, Quantity::kDrives, false)->Name("drives/one_pose");
BENCHMARK_CAPTURE(OnePose, jacobian, Quantity::kDrives, true)
    ->Name("drives/one_pose_with_jacobian");
BENCHMARK(Batch)->Name("drives/batch_in_packs");

}  // namespace
