// SPDX-License-Identifier: Apache-2.0
// The exported C, compiled by the C compiler and called, against the machine itself: for every
// shipped machine.
#include "shipped_machines.hpp"
#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "kompono/exporting/formulas.hpp"

namespace kompono::exporting {
namespace {

using Inverse = int (*)(const double*, double*);

class CFormulas : public testing::TestWithParam<std::string> {};

TEST_P(CFormulas, CompiledGiveTheMachinesOwnDrives) {
  const kinematics::Machine machine = tests::LoadMachine(GetParam());
  const Parsed<MachineFormulas> formulas = DriveFormulas(machine, {.expand = false});
  ASSERT_TRUE(formulas.has_value()) << RenderAll(formulas.error(), {});
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("kompono_c_{}_{}", GetParam(), getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "formula.c") << FormulaC(*formulas, machine);
  const std::string library = (folder / "formula.so").string();
  const std::string command =
      fmt::format("{} -std=c99 -Wall -Werror -O1 -shared -fPIC -o {} {} -lm",
                  KOMPONO_C_COMPILER,
                  library,
                  (folder / "formula.c").string());
  ASSERT_EQ(std::system(command.c_str()), 0) << FormulaC(*formulas, machine);
  void* handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  ASSERT_NE(handle, nullptr) << dlerror();
  const auto inverse = reinterpret_cast<Inverse>(dlsym(handle, (GetParam() + "_inverse").c_str()));
  ASSERT_NE(inverse, nullptr);
  std::mt19937 random(tests::Seed());
  for (const tests::NamedPose& pose : tests::PosesOf(machine, 10, &random)) {
    kinematics::VectorXd wanted;
    machine.DrivesOf(pose.z, machine.nominal(), &wanted);
    kinematics::VectorXd drives(wanted.size());
    ASSERT_EQ(inverse(pose.z.data(), drives.data()), 0) << pose.kind;
    const double size = std::max(1.0, machine.nominal().cwiseAbs().maxCoeff());
    EXPECT_LE((drives - wanted).cwiseAbs().maxCoeff(), 1e-12 * size)
        << pose.kind << ", seed " << tests::Seed();
  }
  dlclose(handle);
  std::filesystem::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Shipped,
                         CFormulas,
                         testing::ValuesIn(tests::ShippedMachineFiles()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace kompono::exporting
