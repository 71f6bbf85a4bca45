// SPDX-License-Identifier: Apache-2.0
// A hexapod of the size of LinuxCNC's genhexkins: drives of poses and poses of drives, hand-written
// for doubles in this file (the baselines), against the plugin, one by one and in packs.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Dense>

#include "kompono/plugin/registry.hpp"

namespace {

using kompono::plugin::ForwardOutcome;
using kompono::plugin::Mechanism;
using kompono::plugin::Quantity;

constexpr std::size_t kPoses = 4096;
constexpr std::size_t kLegs = 6;
using Six = std::array<double, 6>;
using Columns = std::array<std::vector<double>, 6>;

/// Base joints, then platform joints, mm.
const std::vector<double> kJoints{-22.95, 13.25,  0, 22.95,  13.25,  0, 22.95,   13.25,  0,
                                  0,      -26.5,  0, 0,      -26.5,  0, -22.95,  13.25,  0,
                                  -1,     11.5,   0, 1,      11.5,   0, 10.459,  -4.884, 0,
                                  9.459,  -6.616, 0, -9.459, -6.616, 0, -10.459, -4.884, 0};

Eigen::Vector3d Point(std::size_t number) {
  return {kJoints[3 * number], kJoints[3 * number + 1], kJoints[3 * number + 2]};
}

/// Legs and, if asked for, the derivatives of their squared lengths, as a control would write it.
Six HandWrittenLegs(const Six& x, Eigen::Matrix<double, 6, 6>* A) {
  const double ca = std::cos(x[3]), sa = std::sin(x[3]);
  const double cb = std::cos(x[4]), sb = std::sin(x[4]);
  const double cc = std::cos(x[5]), sc = std::sin(x[5]);
  Eigen::Matrix3d R;
  R << cb * cc, -cb * sc, sb, ca * sc + sa * sb * cc, ca * cc - sa * sb * sc, -sa * cb,
      sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, ca * cb;
  Six legs{};
  for (std::size_t i = 0; i < kLegs; ++i) {
    const Eigen::Vector3d r = R * Point(kLegs + i);
    const Eigen::Vector3d leg = Eigen::Vector3d(x[0], x[1], x[2]) + r - Point(i);
    legs[i] = leg.norm();
    if (A == nullptr) continue;
    const Eigen::Vector3d moment = r.cross(leg);
    A->row(static_cast<Eigen::Index>(i)) << 2.0 * leg.transpose(), 2.0 * moment[0],
        2.0 * (ca * moment[1] + sa * moment[2]), 2.0 * R.col(2).dot(moment);
  }
  return legs;
}

/// Newton's method to the last digits, without asking where it leads.
Six HandWrittenPose(const Six& drives, Six x) {
  for (int step = 0; step < 20; ++step) {
    Eigen::Matrix<double, 6, 6> A;
    const Six legs = HandWrittenLegs(x, &A);
    Eigen::Matrix<double, 6, 1> g;
    for (Eigen::Index i = 0; i < 6; ++i) {
      const auto k = static_cast<std::size_t>(i);
      g[i] = legs[k] * legs[k] - drives[k] * drives[k];
    }
    const Eigen::Matrix<double, 6, 1> correction = A.partialPivLu().solve(g);
    for (Eigen::Index i = 0; i < 6; ++i) x[static_cast<std::size_t>(i)] -= correction[i];
    if (correction.norm() < 1e-12) break;
  }
  return x;
}

std::shared_ptr<const Mechanism> Hexapod() {
  const std::array<std::filesystem::path, 1> folders{std::filesystem::path(KOMPONO_BINARY_DIR) /
                                                     "lib/kompono/plugins"};
  static const auto registry = kompono::plugin::Registry::Discover(folders);
  auto mechanism = registry.CreateMechanism("hexapod");
  if (!mechanism) {
    std::fputs("the plugin `hexapod` is not built\n", stderr);
    std::exit(1);
  }
  return *mechanism;
}

struct Cases {
  Columns x, q, near;  ///< poses, their drives, poses a tenth of a millimetre or so beside them

  Cases() {
    std::mt19937 random(7);
    const auto uniform = [&random](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (std::size_t i = 0; i < 6; ++i) {
      x[i].resize(kPoses);
      q[i].resize(kPoses);
      near[i].resize(kPoses);
    }
    for (std::size_t k = 0; k < kPoses; ++k) {
      const Six pose{uniform(-6, 6),
                     uniform(-6, 6),
                     uniform(16, 26),
                     uniform(-0.26, 0.26),
                     uniform(-0.26, 0.26),
                     uniform(-0.26, 0.26)};
      const Six drives = HandWrittenLegs(pose, nullptr);
      for (std::size_t i = 0; i < 6; ++i) {
        x[i][k] = pose[i];
        q[i][k] = drives[i];
        near[i][k] = pose[i] + (i < 3 ? 2e-3 : 1e-4) * uniform(-1, 1);
      }
    }
  }
  [[nodiscard]] static Six At(const Columns& columns, std::size_t k) {
    Six out{};
    for (std::size_t i = 0; i < 6; ++i) out[i] = columns[i][k];
    return out;
  }
};

const Cases& Examples() {
  static const Cases cases;
  return cases;
}

std::array<const double*, 6> Pointers(const Columns& columns, std::size_t k = 0) {
  std::array<const double*, 6> out{};
  for (std::size_t i = 0; i < 6; ++i) out[i] = columns[i].data() + k;
  return out;
}
std::array<double*, 6> Pointers(Columns& columns, std::size_t k = 0) {
  std::array<double*, 6> out{};
  for (std::size_t i = 0; i < 6; ++i) out[i] = columns[i].data() + k;
  return out;
}

void Count(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPoses));
}

void InverseByHand(benchmark::State& state) {
  const Cases& cases = Examples();
  for (auto _ : state) {
    for (std::size_t k = 0; k < kPoses; ++k) {
      benchmark::DoNotOptimize(HandWrittenLegs(Cases::At(cases.x, k), nullptr));
    }
  }
  Count(state);
}

void InverseInPacks(benchmark::State& state) {
  const auto hexapod = Hexapod();
  const Cases& cases = Examples();
  Columns q = cases.q;
  const auto in = Pointers(cases.x);
  const auto out = Pointers(q);
  for (auto _ : state) {
    (void)hexapod->EvaluateBatch(Quantity::kDrives,
                                 {.count = kPoses,
                                  .coordinates = in.data(),
                                  .parameters = kJoints,
                                  .modes = {},
                                  .values = out.data()});
    benchmark::ClobberMemory();
  }
  Count(state);
}

void ForwardByHand(benchmark::State& state) {
  const Cases& cases = Examples();
  for (auto _ : state) {
    for (std::size_t k = 0; k < kPoses; ++k) {
      benchmark::DoNotOptimize(HandWrittenPose(Cases::At(cases.q, k), Cases::At(cases.near, k)));
    }
  }
  Count(state);
}

/// `batch` poses at once, from `starts` or, without them, all from home.
void Forward(benchmark::State& state, std::size_t batch, bool warm) {
  const auto hexapod = Hexapod();
  const Cases& cases = Examples();
  const Six home{0, 0, 20, 0, 0, 0};
  Columns found = cases.x;
  std::vector<ForwardOutcome> outcomes(kPoses);
  for (auto _ : state) {
    for (std::size_t k = 0; k < kPoses; k += batch) {
      const auto drives = Pointers(cases.q, k);
      const auto starts = Pointers(cases.near, k);
      const auto out = Pointers(found, k);
      (void)hexapod->Forward({.count = batch,
                              .drives = drives.data(),
                              .starts = warm ? starts.data() : nullptr,
                              .start = home,
                              .parameters = kJoints,
                              .coordinates = out.data(),
                              .outcomes = outcomes.data() + k});
    }
    benchmark::ClobberMemory();
  }
  Count(state);
}

BENCHMARK(InverseByHand)->Name("hexapod_inverse/baseline");
BENCHMARK(InverseInPacks)->Name("hexapod_inverse/packs");
BENCHMARK(ForwardByHand)->Name("hexapod_forward/baseline");
BENCHMARK_CAPTURE(Forward, single, std::size_t{1}, true)->Name("hexapod_forward/single_warm");
BENCHMARK_CAPTURE(Forward, packs, kPoses, true)->Name("hexapod_forward/packs_warm");
BENCHMARK_CAPTURE(Forward, cold, std::size_t{1}, false)->Name("hexapod_forward/single_from_home");
BENCHMARK_CAPTURE(Forward, cold_packs, kPoses, false)->Name("hexapod_forward/packs_from_home");

}  // namespace
