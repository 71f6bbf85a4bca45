// SPDX-License-Identifier: Apache-2.0
// Other programs' files: a printer.cfg of Klipper, points of a laser tracker.
#include "machines.hpp"
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/klipper_config.hpp"
#include "kompono/calibration/simulation.hpp"
#include "kompono/calibration/tracker.hpp"

namespace kompono::calibration {
namespace {

using ::testing::AllOf;
using testing::Good;
using ::testing::HasSubstr;
using testing::kMeasurements;
using testing::MachineFrom;
using testing::MachineOf;

/// 60 mm a turn, 200 full steps, 32 microsteps and a gear of 2:1.
constexpr double kStepMm = 60.0 / (200.0 * 32.0 * 2.0);

std::string Steps(const Eigen::VectorXd& travels) {
  return fmt::format(
      "{:.3f},{:.3f},{:.3f}", travels[0] / kStepMm, travels[1] / kStepMm, travels[2] / kStepMm);
}

/// A printer.cfg with the run of `set` as SAVE_CONFIG leaves it.
std::string ConfigOf(const KlipperGeometry& geometry, const MeasurementSet& set) {
  std::string text = fmt::format(
      "[printer]\n"
      "kinematics: delta   # three towers\n"
      "delta_radius: 1.0\n"
      "[stepper_a]\n"
      "microsteps: 32\nrotation_distance: 60\ngear_ratio: 80:20, 1:2\n"
      "position_endstop: {}\narm_length = {}\n"
      "[stepper_b]\ngear_ratio: 2:1\n[stepper_c]\ngear_ratio: 2:1\n"
      "#*# <---------------------- SAVE_CONFIG ---------------------->\n"
      "#*# [printer]\n#*# delta_radius = {}\n"
      "#*# [delta_calibrate]\n",
      geometry.endstop[0],
      geometry.arm[0],
      geometry.delta_radius);
  int heights = 0;
  int distances = 0;
  for (const Measurement& m : set.measurements) {
    if (m.kind == MeasurementKind::kHeight) {
      text += fmt::format("#*# height{} = {}\n#*# height{}_pos = {}\n",
                          heights,
                          m.value_mm,
                          heights,
                          Steps(m.readings));
      ++heights;
    } else {
      text += fmt::format(
          "#*# distance{0} = {1}\n#*# distance{0}_pos1 = {2}\n"
          "#*# distance{0}_pos2 = {3}\n",
          distances,
          m.value_mm,
          Steps(m.readings),
          Steps(m.second_readings));
      ++distances;
    }
  }
  return text;
}

TEST(KlipperConfig, GivesTheLayoutAndTheRunThatWerePutIntoIt) {
  const KlipperRun run = Good(ReadKlipperRun(kMeasurements / "klipper_delta/fzechert_01.json"));
  const kinematics::Machine machine = MachineFrom(KlipperLayout(run.nominal, run.name, ""));
  const MeasurementSet set =
      Good(ReadMeasurements(kMeasurements / "klipper_delta/fzechert_01.csv", machine));
  const KlipperConfig config = Good(ReadKlipperConfig(ConfigOf(run.nominal, set), "printer.cfg"));
  EXPECT_EQ(config.heights, run.heights);
  EXPECT_EQ(config.distances, run.distances);
  EXPECT_EQ(config.geometry.delta_radius, run.nominal.delta_radius);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(config.geometry.arm[i], run.nominal.arm[i]) << "tower a stands for the others";
    EXPECT_EQ(config.geometry.endstop[i], run.nominal.endstop[i]);
    EXPECT_EQ(config.geometry.angle_deg[i], run.nominal.angle_deg[i]) << "Klipper's usual angles";
  }
  const MeasurementSet read = Good(ParseMeasurements(config.run_csv, "run.csv", machine));
  ASSERT_EQ(read.measurements.size(), set.measurements.size());
  // Positions have a thousandth of a step.
  const double cost = Identify(machine, set).chi_squared;
  EXPECT_NEAR(Identify(machine, read).chi_squared, cost, 1e-3 * cost);
}

std::string SaidOfConfig(std::string_view text) {
  const Parsed<KlipperConfig> config = ReadKlipperConfig(text, "printer.cfg");
  return config ? std::string() : RenderAll(config.error(), {});
}

TEST(KlipperConfig, SaysAllThatIsMissingOrWrong) {
  EXPECT_THAT(
      SaidOfConfig("[printer]\nkinematics: corexy\n"),
      AllOf(HasSubstr("printer.cfg:2:1: error: a printer of kinematics 'corexy' is no delta"),
            HasSubstr("E0465")));
  EXPECT_THAT(SaidOfConfig(""), HasSubstr("no [printer]"));
  EXPECT_THAT(SaidOfConfig("[printer]\nkinematics: delta\ndelta_radius: wide\n"
                           "[stepper_a]\nposition_endstop: 400\n"
                           "[delta_calibrate]\nheight0: 1\nheight0_pos: 1,2\nheight1: 0.5\n"),
              AllOf(HasSubstr("'wide' is no number"),
                    HasSubstr("[stepper_a] has no 'arm_length'"),
                    HasSubstr("[stepper_a] has no 'rotation_distance'"),
                    HasSubstr("printer.cfg:8:1: error: '1,2' is not 3 numbers"),
                    HasSubstr("height1 has no 'height1_pos'")));
}

class Tracker : public ::testing::Test {
 protected:
  Tracker() {
    SimulateOptions options;
    options.count = 40;
    options.sigma_mm = 0.005;
    options.region = {{"struts.X", {-120, 120}},
                      {"struts.Y", {-100, 140}},
                      {"struts.Z", {800, 1000}},
                      {"struts.A", {-0.2, 0.2}},
                      {"struts.B", {-0.2, 0.2}},
                      {"struts.C", {-0.2, 0.2}}};
    set_ = Good(Simulate(machine_, machine_, ManufacturedGeometry(machine_, 4, 5.0), options));
    X_WL_.R = Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    X_WL_.p << 1500.0, -700.0, 300.0;
  }

  [[nodiscard]] std::string Name(std::size_t i) const {
    return fmt::format("P{}", set_.measurements[i].row);
  }
  /// In the tracker's frame, metres, the last row first.
  [[nodiscard]] std::string Points() const {
    std::string text = "# tracker\nName X Y Z\n";
    for (std::size_t i = set_.measurements.size(); i-- > 0;) {
      const auto& p = set_.measurements[i].position_mm;
      const Eigen::Vector3d p_L = X_WL_.Inverse() * Eigen::Vector3d(*p[0], *p[1], *p[2]);
      text += fmt::format(
          "{} {:.9f}\t{:.9f} {:.9f}\n", Name(i), 1e-3 * p_L[0], 1e-3 * p_L[1], 1e-3 * p_L[2]);
    }
    return text;
  }
  [[nodiscard]] std::string Readings() const {
    std::string text = "name,q1,q2,q3,q4,q5,q6\n";
    for (std::size_t i = 0; i < set_.measurements.size(); ++i) {
      text += Name(i);
      for (const double reading : set_.measurements[i].readings)
        text += fmt::format(",{}", reading);
      text += "\n";
    }
    return text;
  }
  [[nodiscard]] Parsed<TrackerMeasurements> Join(const std::string& points, bool align) const {
    const Parsed<std::vector<TrackerPoint>> read = ReadTrackerPoints(points, "points.txt", 1000.0);
    if (!read) return tl::unexpected(read.error());
    return JoinTracker(*read,
                       "points.txt",
                       Readings(),
                       "readings.csv",
                       machine_,
                       {.sigma_mm = 0.005, .align = align});
  }

  kinematics::Machine machine_ = MachineOf("machines/hexapod_reference.toml");
  MeasurementSet set_;
  Pose<double> X_WL_;
};

/// One file, as instruments of several countries write it.
TEST(TrackerPoints, AreTheSameWithEverySeparator) {
  for (const char* text : {"1.5 2.25 -3.5\n4 5 6\n",
                           "1.5, 2.25, -3.5\r\n4, 5, 6\r\n",
                           "1.5,2.25,-3.5\n4,5,6\n",
                           "1,5 2,25 -3,5\n4 5 6\n",
                           "1,5;2,25;-3,5;\n4;5;6;\n",
                           "1,5\t2,25\t-3,5\n4\t5\t6\n",
                           "P1 1,5 2,25 -3,5\nP2 4,0 5,0 6,0\n",
                           "P1,1.5,2.25,-3.5\nP2,4,5,6\n"}) {
    SCOPED_TRACE(text);
    const auto points = ReadTrackerPoints(text, "points.txt", 1.0);
    ASSERT_TRUE(points);
    ASSERT_EQ(points->size(), 2U);
    EXPECT_EQ((*points)[0].p_mm, Eigen::Vector3d(1.5, 2.25, -3.5));
    EXPECT_EQ((*points)[1].p_mm, Eigen::Vector3d(4.0, 5.0, 6.0));
  }
}

TEST_F(Tracker, PointsAreJoinedByNameAndAlignedWithTheMachine) {
  const TrackerMeasurements joined = Good(Join(Points(), true));
  ASSERT_EQ(joined.set.measurements.size(), set_.measurements.size());
  ASSERT_TRUE(joined.X_WL);
  // The frame is known as well as the machine is: to some of its errors of 0.25 mm.
  EXPECT_LT(joined.fit_rms_mm, 2.0);
  EXPECT_LT((joined.X_WL->p - X_WL_.p).norm(), 5.0);
  EXPECT_TRUE(joined.X_WL->R.isApprox(X_WL_.R, 5e-3));
  const Measurement& first = joined.set.measurements.front();
  EXPECT_EQ(first.readings, set_.measurements.back().readings) << "by name, not by line";
  EXPECT_EQ(first.sigma_mm, 0.005);
}

TEST_F(Tracker, OneWrongPointDoesNotTurnTheFrame) {
  const TrackerMeasurements good = Good(Join(Points(), true));
  std::string points = Points();
  const std::size_t at = points.find("P7 ");
  points.replace(at, points.find('\n', at) - at, "P7 0.1 0.2 9.0");
  const TrackerMeasurements joined = Good(Join(points, true));
  EXPECT_NEAR(joined.fit_rms_mm, good.fit_rms_mm, 0.1 * good.fit_rms_mm);
}

TEST_F(Tracker, PointsInTheTrackersFrameAreWarnedOfUnlessAligned) {
  EXPECT_TRUE(Good(Join(Points(), true)).warnings.empty());
  X_WL_ = Pose<double>{};
  EXPECT_TRUE(Good(Join(Points(), false)).warnings.empty()) << "these are in the datum";
  X_WL_.p = Eigen::Vector3d(30.0, -20.0, 0.0);
  const Diagnostics warnings = Good(Join(Points(), false)).warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings.front().code, "W0474");
}

TEST_F(Tracker, AFrameThatCanBeFreedIsFoundExactly) {
  MeasurementSet aligned = Good(Join(Points(), true)).set;
  IdentifyOptions options;
  options.groups = {ParameterGroup::kFrames, ParameterGroup::kGeometry, ParameterGroup::kOffsets};
  options.lock = {"tool.mount"};
  for (std::size_t i = 0; i < aligned.measurements.size(); i += 4) {
    aligned.measurements[i].held_out = true;
  }
  const CalibrationReport report = Identify(machine_, aligned, options);
  ASSERT_TRUE(report.ok());
  for (const ErrorStatistics& s : report.statistics) {
    if (s.held_out) {
      EXPECT_LT(s.rms_after, 0.03) << "noise of 5 µm in each component";
    }
  }
}

TEST_F(Tracker, WhatDoesNotMatchIsRefused) {
  const auto said = [](const auto& parsed) {
    return parsed ? std::string() : RenderAll(parsed.error(), {});
  };
  EXPECT_THAT(said(Join(Points() + "P99 1 2 3\n", true)),
              AllOf(HasSubstr("E0467"), HasSubstr("no readings are called 'P99'")));
  EXPECT_THAT(said(Join("1 2 3\n4 5 6\n", true)), HasSubstr("2 points, but 40 rows"));
  EXPECT_THAT(said(Join("P1 1 2 3\nP2 oops\nP3 4 5\n", true)),
              AllOf(HasSubstr("points.txt:2:1"), HasSubstr("points.txt:3:1"), HasSubstr("E0466")));
  EXPECT_THAT(said(Join("# nothing\n", true)), HasSubstr("E0402"));
}

TEST(TrackerPoints, MayHaveDecimalCommasAndNumbersForNames) {
  const std::vector<TrackerPoint> points =
      Good(ReadTrackerPoints("Pkt;X;Y;Z\n1;10,5;-2;3e1\n2;1;2;3\n", "points.txt"));
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].name, "1");
  EXPECT_EQ(points[0].p_mm, Eigen::Vector3d(10.5, -2.0, 30.0));
  EXPECT_EQ(points[1].line, 3);
}

TEST(Groups, NameNumbersByTheirKind) {
  EXPECT_EQ(GroupOf("struts.q1.zero"), ParameterGroup::kOffsets);
  EXPECT_EQ(GroupOf("struts.mount.a"), ParameterGroup::kFrames);
  EXPECT_EQ(GroupOf("open_base.x"), ParameterGroup::kFrames);
  EXPECT_EQ(GroupOf("Z.position.x"), ParameterGroup::kFrames);
  EXPECT_EQ(GroupOf("struts.base[1].x"), ParameterGroup::kGeometry);
}

TEST_F(Tracker, GroupsFreeWhatTheyName) {
  const auto free = [&](std::vector<ParameterGroup> groups) {
    IdentifyOptions options;
    options.groups = std::move(groups);
    return Identify(machine_, set_, options).parameters;
  };
  EXPECT_EQ(free({ParameterGroup::kOffsets}).size(), 6U);
  EXPECT_EQ(free({ParameterGroup::kGeometry}).size(), 36U);
  for (const IdentifiedParameter& p : free({ParameterGroup::kFrames})) {
    EXPECT_THAT(p.name, HasSubstr(".mount.")) << "all that may stand elsewhere";
  }
  EXPECT_EQ(free({ParameterGroup::kAll}).size(), 42U + free({ParameterGroup::kFrames}).size());
}

TEST_F(Tracker, PriorsOfTolerancesHoldWhatHasThem) {
  IdentifyOptions options;
  options.prior_tolerances = 1e-6;
  for (const IdentifiedParameter& p : Identify(machine_, set_, options).parameters) {
    if (p.tolerance > 0.0) {
      EXPECT_NEAR(p.change(), 0.0, 1e-3 * p.tolerance) << p.name;
    } else {
      EXPECT_GT(std::abs(p.change()), 0.0) << p.name;
    }
  }
}

}  // namespace
}  // namespace kompono::calibration
