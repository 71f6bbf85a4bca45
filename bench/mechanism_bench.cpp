// SPDX-License-Identifier: Apache-2.0
// What the plugin boundary and the templates over the scalar cost: the inverse kinematics of a
// linear delta, hand-written for doubles in this file, against the pyramid plugin asked for one
// pose, for a batch in packs, and for one pose with its Jacobian.
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

std::shared_ptr<const Mechanism> Pyramid() {
  const std::array<std::filesystem::path, 1> folders{std::filesystem::path(KOMPONO_BINARY_DIR) /
                                                     "lib/kompono/plugins"};
  static const auto registry = kompono::plugin::Registry::Discover(folders);
  auto mechanism = registry.CreateMechanism("pyramid");
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

BENCHMARK(HandWritten)->Name("drives/baseline");
BENCHMARK_CAPTURE(OnePose, one, Quantity::kDrives, false)->Name("drives/one_pose");
BENCHMARK_CAPTURE(OnePose, jacobian, Quantity::kDrives, true)
    ->Name("drives/one_pose_with_jacobian");
BENCHMARK(Batch)->Name("drives/batch_in_packs");

}  // namespace
