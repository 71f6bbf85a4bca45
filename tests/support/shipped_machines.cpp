// SPDX-License-Identifier: Apache-2.0
#include "shipped_machines.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "kompono/layout/layout.hpp"

namespace kompono::tests {
namespace {

using kinematics::VectorXd;

/// How far poses are spread: a quarter of the machine's own size for lengths, 0.25 rad for angles.
VectorXd Spread(const kinematics::Machine& machine) {
  VectorXd readings;
  machine.DrivesOf(machine.home(), machine.nominal(), &readings);
  double size = 10.0;
  for (const auto& point : machine.Skeleton(machine.home(), machine.nominal()).points) {
    size = std::max(size, 0.25 * point.p_M.norm());
  }
  VectorXd spread(static_cast<Eigen::Index>(machine.coordinates().size()));
  for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
    spread[static_cast<Eigen::Index>(i)] = machine.coordinates()[i].rotary ? 0.25 : size;
  }
  return spread;
}

bool Reachable(const kinematics::Machine& machine, const VectorXd& z) {
  VectorXd readings;
  VectorXd reach;
  machine.DrivesOf(z, machine.nominal(), &readings, &reach);
  return readings.allFinite() && (reach.array() > 0.0).all();
}

kinematics::Machine Built(Parsed<layout::Layout> layout) {
  if (!layout) throw std::runtime_error(RenderAll(layout.error(), {}));
  Parsed<kinematics::Machine> machine =
      kinematics::Machine::Build(std::move(*layout), ShippedRegistry());
  if (!machine) throw std::runtime_error(RenderAll(machine.error(), {}));
  return std::move(*machine);
}

}  // namespace

const plugin::Registry& ShippedRegistry() {
  static const plugin::Registry registry = [] {
    const std::filesystem::path folder =
        std::filesystem::path(KOMPONO_BINARY_DIR) / "lib/kompono/plugins";
    return plugin::Registry::Discover({&folder, 1});
  }();
  return registry;
}

std::vector<std::string> ShippedMachineFiles() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(KOMPONO_SOURCE_DIR) / "layouts/machines")) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

kinematics::Machine LoadMachine(const std::string& name) {
  const std::filesystem::path file =
      std::filesystem::path(KOMPONO_SOURCE_DIR) / "layouts/machines" / (name + ".toml");
  return Built(layout::ReadLayout(file, ShippedRegistry()));
}

kinematics::Machine MachineFromText(const std::string& toml) {
  return Built(layout::ParseLayout(toml, "inline.toml", ShippedRegistry()));
}

unsigned Seed() {
  static const unsigned seed = [] {
    const char* given = std::getenv("KOMPONO_TEST_SEED");
    return given != nullptr ? static_cast<unsigned>(std::strtoul(given, nullptr, 10)) : 20240607U;
  }();
  return seed;
}

bool OnHomesBranch(const kinematics::Machine& machine, const VectorXd& z) {
  constexpr int kSamples = 24;
  const auto home = machine.Singularities(machine.home(), machine.nominal());
  for (int k = 1; k <= kSamples; ++k) {
    const double share = static_cast<double>(k) / kSamples;
    const auto here =
        machine.Singularities(machine.home() + share * (z - machine.home()), machine.nominal());
    for (std::size_t i = 0; i < home.size(); ++i) {
      if (home[i].det_a * here[i].det_a <= 0.0 || here[i].margin_a < 1e-3) return false;
    }
  }
  return true;
}

std::vector<NamedPose> PosesOf(const kinematics::Machine& machine,
                               int random_count,
                               std::mt19937* random) {
  const VectorXd home = machine.home();
  const VectorXd spread = Spread(machine);
  std::vector<NamedPose> poses{{"home", home}, {"near home", home + 1e-6 * spread}};
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto direction = [&] {
    VectorXd d(home.size());
    for (double& component : d) component = uniform(*random);
    return VectorXd(spread.cwiseProduct(d));
  };
  for (int found = 0, tried = 0; found < random_count && tried < 100 * random_count; ++tried) {
    const VectorXd z = home + direction();
    if (!Reachable(machine, z) || !OnHomesBranch(machine, z)) continue;
    poses.push_back({"random", z});
    ++found;
  }
  for (int found = 0; found < random_count; ++found) {
    const VectorXd d = direction();
    double inside = 0.0;
    double outside = 1.0;
    while (outside < 64.0 && Reachable(machine, home + outside * d)) outside *= 2.0;
    if (outside >= 64.0) continue;  // pods and plain axes have no end
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (inside + outside);
      (Reachable(machine, home + middle * d) ? inside : outside) = middle;
    }
    const VectorXd z = home + 0.999 * inside * d;
    if (Reachable(machine, z) && OnHomesBranch(machine, z)) poses.push_back({"near a limit", z});
  }
  return poses;
}

}  // namespace kompono::tests
