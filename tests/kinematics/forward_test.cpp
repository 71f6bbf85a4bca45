// SPDX-License-Identifier: Apache-2.0
// Forward kinematics from home over a whole work zone: the right pose or a refusal, never a wrong
// pose, in packs and one by one, whatever the size of the machine.
#include "shipped_machines.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <random>

namespace kompono {
namespace {

using kinematics::Machine;
using plugin::ForwardOutcome;

constexpr double kDegree = std::numbers::pi / 180.0;

/// How many poses: a million where it is asked for, fewer every day.
std::size_t Poses(std::size_t every_day) {
  const char* const given = std::getenv("KOMPONO_FORWARD_POSES");
  return given != nullptr ? std::strtoul(given, nullptr, 10) : every_day;
}

struct Box {
  std::vector<double> lower, upper, home;
};

/// The first mechanism of a shipped machine, made `size` times as large.
class Sized {
 public:
  Sized(const std::string& file, double size, const Box& box)
      : machine_(tests::LoadMachine(file)), view_(machine_.blocks().at(0)), box_(box) {
    const plugin::MechanismShape shape = view_.code->Shape();
    const kinematics::VectorXd theta = machine_.nominal();
    for (int i = 0; i < shape.parameters; ++i) {
      const int number = view_.first_parameter + i;
      const kinematics::Parameter& parameter =
          machine_.parameters()[static_cast<std::size_t>(number)];
      theta_.push_back(theta[number] * (parameter.angle ? 1.0 : size));
    }
    for (std::size_t i = 0; i < box_.lower.size(); ++i) {
      const double by = IsRotaryLetter(view_.description->letters[i]) ? kDegree : size;
      box_.lower[i] *= by;
      box_.upper[i] *= by;
      box_.home[i] *= by;
    }
  }

  struct Count {
    std::size_t right = 0, wrong = 0, refused = 0;
  };

  /// `batch` poses are asked for at once.
  [[nodiscard]] Count FromHome(std::size_t count, std::size_t batch, bool limits) const {
    const std::size_t n = box_.lower.size();
    const auto drives = static_cast<std::size_t>(view_.code->Shape().drives);
    std::mt19937 random(tests::Seed());
    std::vector<std::vector<double>> x(n, std::vector<double>(count));
    for (std::size_t i = 0; i < n; ++i) {
      std::uniform_real_distribution<double> within(box_.lower[i], box_.upper[i]);
      for (double& number : x[i]) number = within(random);
    }
    std::vector<std::vector<double>> q(drives, std::vector<double>(count));
    std::vector<std::vector<double>> found = x;
    std::vector<ForwardOutcome> outcomes(count);
    EXPECT_EQ(view_.code->EvaluateBatch(plugin::Quantity::kDrives,
                                        {.count = count,
                                         .coordinates = Columns(x, 0).data(),
                                         .parameters = theta_,
                                         .modes = view_.modes,
                                         .values = MutableColumns(q, 0).data()}),
              plugin::Status::kOk);
    for (std::size_t begin = 0; begin < count; begin += batch) {
      plugin::MechanismForward question{.count = std::min(batch, count - begin)};
      const auto drive_columns = Columns(q, begin);
      const auto found_columns = MutableColumns(found, begin);
      question.drives = drive_columns.data();
      question.start = box_.home;
      question.parameters = theta_;
      question.modes = view_.modes;
      if (limits) {
        question.lower = box_.lower;
        question.upper = box_.upper;
      }
      question.coordinates = found_columns.data();
      question.outcomes = outcomes.data() + begin;
      EXPECT_EQ(view_.code->Forward(question), plugin::Status::kOk);
    }
    return Judge(x, found, outcomes);
  }

 private:
  static std::vector<const double*> Columns(const std::vector<std::vector<double>>& table,
                                            std::size_t begin) {
    std::vector<const double*> out;
    for (const auto& column : table) out.push_back(column.data() + begin);
    return out;
  }
  static std::vector<double*> MutableColumns(std::vector<std::vector<double>>& table,
                                             std::size_t begin) {
    std::vector<double*> out;
    for (auto& column : table) out.push_back(column.data() + begin);
    return out;
  }

  [[nodiscard]] Count Judge(const std::vector<std::vector<double>>& x,
                            const std::vector<std::vector<double>>& found,
                            const std::vector<ForwardOutcome>& outcomes) const {
    Count out;
    for (std::size_t k = 0; k < outcomes.size(); ++k) {
      if (outcomes[k] != ForwardOutcome::kProven) {
        EXPECT_TRUE(std::isnan(found[0][k])) << "a refused pose is not a number";
        ++out.refused;
        continue;
      }
      double error = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        error = std::max(error, std::abs(found[i][k] - x[i][k]) / (box_.upper[i] - box_.lower[i]));
      }
      ++(error < 1e-7 ? out.right : out.wrong);
    }
    std::printf("%zu right, %zu wrong, %zu refused\n", out.right, out.wrong, out.refused);
    return out;
  }

  Machine machine_;
  Machine::BlockView view_;
  Box box_;
  std::vector<double> theta_;
};

const Box kHexapodBox{{-6, -6, 16, -35, -35, -35}, {6, 6, 26, 35, 35, 35}, {0, 0, 20, 0, 0, 0}};

TEST(ForwardNeverLies, OnAHexapodOfAnySizeTiltedTo35Degrees) {
  for (const double size : {1.0, 25.4, 0.0254}) {  // of LinuxCNC's genhexkins, as if inch or metre
    const Sized hexapod("linuxcnc_genhexkins", size, kHexapodBox);
    const Sized::Count count = hexapod.FromHome(Poses(100'000), 100'000, true);
    EXPECT_EQ(count.wrong, 0U) << "seed " << tests::Seed();
    // 0.05 % of the poses lie beyond a singularity from home, and as many have such a pose as twin.
    EXPECT_LE(count.refused, Poses(100'000) * 15 / 10'000) << "seed " << tests::Seed();
  }
}

TEST(ForwardNeverLies, OnASixStrutLatheInItsRanges) {
  const Box box{{-60, -80, -300, -15, -15, -15}, {60, 60, 300, 15, 15, 15}, {0, 0, 0, 0, 0, 0}};
  for (const double size : {1.0, 0.001}) {
    const Sized::Count count =
        Sized("kdd_six_strut_lathe", size, box).FromHome(Poses(50'000), 50'000, true);
    EXPECT_EQ(count.wrong, 0U) << "seed " << tests::Seed();
    EXPECT_LE(count.refused, Poses(50'000) / 1000) << "seed " << tests::Seed();
  }
}

TEST(ForwardNeverLies, OnThePentapodOfLinuxCncsSimulation) {
  const Box box{{-120, -120, -120, -15, -20}, {120, 120, 120, 15, 20}, {0, 0, 0, 0, 0}};
  const Sized::Count count =
      Sized("linuxcnc_pentakins_simconfig", 1.0, box).FromHome(Poses(50'000), 50'000, true);
  EXPECT_EQ(count.wrong, 0U) << "seed " << tests::Seed();
  EXPECT_LE(count.refused, Poses(50'000) / 1000) << "seed " << tests::Seed();
}

TEST(ForwardNeverLies, OneByOneAsInPacks) {
  const Sized hexapod("linuxcnc_genhexkins", 1.0, kHexapodBox);
  const Sized::Count single = hexapod.FromHome(20'000, 1, true);
  EXPECT_EQ(single.wrong, 0U) << "seed " << tests::Seed();
  EXPECT_LE(single.refused, 45U) << "seed " << tests::Seed();
}

TEST(ForwardNeverLies, WithoutLimitsThePoseOnTheStartsSideIsTheAnswer) {
  Box box = kHexapodBox;  // tilts at which det A keeps its sign
  for (std::size_t i = 3; i < 6; ++i) {
    box.lower[i] = -15.0;
    box.upper[i] = 15.0;
  }
  const Sized::Count count = Sized("linuxcnc_genhexkins", 1.0, box).FromHome(50'000, 50'000, false);
  EXPECT_EQ(count.right, 50'000U) << "seed " << tests::Seed();
}

TEST(ForwardNeverLies, DrivesThatFitNoPoseAreRefusedWithTheReason) {
  const Machine machine = tests::LoadMachine("linuxcnc_genhexkins");
  kinematics::VectorXd readings;
  machine.DrivesOf(machine.home(), machine.nominal(), &readings);
  readings[0] *= 3.0;
  const kinematics::Solution solved = machine.Forward(readings);
  EXPECT_EQ(solved.status, kinematics::SolveStatus::kSingular);
  EXPECT_THAT(solved.message, testing::StartsWith("struts: followed from the start"));
  EXPECT_FALSE(solved.coordinates.allFinite());
}

TEST(ForwardNeverLies, ALegThatGoesOverToItsOtherSideAndComesBackIsAnotherBranch) {
  const Machine machine = tests::LoadMachine("hexaglide_mill");
  kinematics::VectorXd z(6);
  z << 1781.26, 187.314, 753.627, -1.17857, 1.28669, 1.57145;
  kinematics::VectorXd readings;
  machine.DrivesOf(z, machine.nominal(), &readings);
  ASSERT_TRUE(readings.allFinite());
  const kinematics::Solution solved = machine.Forward(readings);
  EXPECT_EQ(solved.status, kinematics::SolveStatus::kOtherAssemblyMode) << solved.coordinates;
  EXPECT_FALSE(solved.coordinates.allFinite());
  const kinematics::VectorXd near = z + 1e-3 * (machine.home() - z);
  EXPECT_TRUE(machine.Forward(readings, machine.nominal(), near).ok());
}

}  // namespace
}  // namespace kompono
