// SPDX-License-Identifier: Apache-2.0
// Synthetic errors in, calibration out; what cannot be determined is named; doubtful data are said
// to be doubtful.
#include "machines.hpp"
#include <nlohmann/json.hpp>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/report.hpp"
#include "kompono/calibration/simulation.hpp"

namespace kompono::calibration {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::Field;
using testing::Good;
using ::testing::HasSubstr;
using testing::MachineFrom;
using testing::MachineOf;

/// A gantry whose table turns: every error in it has a place that can be checked by hand.
const kinematics::Machine& Gantry() {
  static const kinematics::Machine machine = MachineFrom(R"(kompono = 1
name = "gantry"
formula = "part C O X Y Z tool"
[axis.X]
range = [-300, 300]
[axis.Y]
range = [-200, 200]
[axis.Z]
range = [0, 250]
[axis.C]
range = [-90, 90]
[tool]
module = "tool"
parameters = { length = 80 }
)");
  return machine;
}

const kinematics::Machine& Delta() {
  static const kinematics::Machine machine = MachineOf("machines/flsun_v400.toml");
  return machine;
}

/// Inside a printer's build volume.
void PrinterRegion(SimulateOptions* options) {
  options->region = {{"delta.X", {-90, 90}}, {"delta.Y", {-90, 90}}, {"delta.Z", {5, 150}}};
}

MeasurementSet Measured(const kinematics::Machine& machine,
                        const Eigen::VectorXd& theta_true,
                        const SimulateOptions& options) {
  return Good(Simulate(machine, machine, theta_true, options));
}

double ErrorInSigmas(const CalibrationReport& report, const Eigen::VectorXd& theta_true) {
  double worst = 0.0;
  for (std::size_t i = 0; i < report.free.size(); ++i) {
    const IdentifiedParameter& p = report.parameters[i];
    EXPECT_TRUE(p.sigma) << p.name;
    if (p.sigma) worst = std::max(worst, std::abs(p.after - theta_true[report.free[i]]) / *p.sigma);
  }
  return worst;
}

struct Case {
  std::string name;
  MeasurementKind kind;
  double sigma_mm;
  std::vector<std::string> lock;  ///< what this kind cannot see
  int expected_rank;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

class DeltaRecovery : public ::testing::TestWithParam<Case> {};

TEST_P(DeltaRecovery, FindsTheTruthWithinItsOwnDeviations) {
  for (std::uint64_t seed = 11; seed < 16; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Eigen::VectorXd truth = Good(ChangedGeometry(Delta(),
                                                 {{"delta.radius", 0.4},
                                                  {"delta.azimuth[1]", 0.002},
                                                  {"delta.azimuth[2]", -0.001},
                                                  {"delta.strut[1]", 0.5},
                                                  {"delta.strut[3]", -0.3},
                                                  {"delta.q2.zero", 0.7}}));
    for (const std::string& name : GetParam().lock) {
      const int index = Delta().FindParameter(name);
      ASSERT_GE(index, 0) << name;
      truth[index] = Delta().nominal()[index];
    }
    SimulateOptions options;
    options.count = 80;
    options.seed = seed;
    options.kind = GetParam().kind;
    options.sigma_mm = GetParam().sigma_mm;
    PrinterRegion(&options);
    const MeasurementSet set = Measured(Delta(), truth, options);
    IdentifyOptions identify;
    identify.lock = GetParam().lock;
    const CalibrationReport report = Identify(Delta(), set, identify);
    ASSERT_EQ(report.status, IdentifyStatus::kConverged) << RenderText(report);
    EXPECT_EQ(report.rank, GetParam().expected_rank);
    EXPECT_LT(ErrorInSigmas(report, truth), 4.5) << RenderText(report);
    EXPECT_NEAR(report.sigma0, 1.0, 0.35);
    EXPECT_FALSE(report.sigma_assumed);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds,
    DeltaRecovery,
    ::testing::Values(Case{"Positions", MeasurementKind::kPosition, 0.01, {}, 9},
                      Case{"Heights",
                           MeasurementKind::kHeight,
                           0.01,
                           {"delta.strut[1]", "delta.strut[2]", "delta.strut[3]"},
                           6},
                      Case{"Distances", MeasurementKind::kDistance, 0.01, {"delta.q1.zero"}, 8}),
    [](const auto& c) { return c.param.name; });

TEST(Identify, ReachesTheTruthItselfFromDataWithoutNoise) {
  const Eigen::VectorXd truth =
      Good(ChangedGeometry(Delta(), {{"delta.radius", 0.4}, {"delta.strut[2]", 0.2}}));
  SimulateOptions options;
  PrinterRegion(&options);
  const CalibrationReport report = Identify(Delta(), Measured(Delta(), truth, options));
  ASSERT_EQ(report.status, IdentifyStatus::kConverged) << RenderText(report);
  EXPECT_LT((report.theta_after - truth).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Identify, NamesAMountAndADatumThatShiftTheSame) {
  const kinematics::Machine machine = MachineFrom(R"(kompono = 1
name = "delta with a datum"
formula = "part O (XYZ):delta tool"
[block.delta]
module = "linear_delta"
parameters = { radius = 160, strut = [345, 345, 345] }
home = { X = 0, Y = 0, Z = -250 }
[part]
module = "workpiece"
)");
  SimulateOptions options;
  options.sigma_mm = 0.01;
  options.region = {{"delta.X", {-90, 90}}, {"delta.Y", {-90, 90}}, {"delta.Z", {-300, -200}}};
  const MeasurementSet set =
      Measured(machine, Good(ChangedGeometry(machine, {{"delta.mount.x", 0.3}})), options);
  IdentifyOptions identify;
  identify.free = {"delta.radius", "delta.mount.x", "part.datum.x"};
  const CalibrationReport report = Identify(machine, set, identify);
  ASSERT_EQ(report.status, IdentifyStatus::kRankDeficient) << RenderText(report);
  EXPECT_EQ(report.rank, 2);
  ASSERT_EQ(report.unidentifiable.size(), 1U);
  EXPECT_EQ(report.unidentifiable[0].words,
            "delta.mount.x and part.datum.x can only be told apart up to their difference");
  EXPECT_EQ(report.unidentifiable[0].remedy,
            "lock one of them; no measurement of this tool can tell them apart");
  EXPECT_THAT(report.diagnostics, Contains(Field(&Diagnostic::code, "W0453")));
  for (const IdentifiedParameter& p : report.parameters) {
    EXPECT_EQ(p.determined, p.name == "delta.radius");
    EXPECT_EQ(p.sigma.has_value(), p.name == "delta.radius");
  }
  EXPECT_THAT(RenderText(report), HasSubstr("not determined by these measurements\n"));
}

TEST(Identify, TellsWhichMeasurementWouldHelp) {
  SimulateOptions options;
  options.kind = MeasurementKind::kHeight;
  options.sigma_mm = 0.01;
  options.region["C"] = {0.0, 0.0};
  const MeasurementSet set = Measured(Gantry(), Gantry().nominal(), options);
  IdentifyOptions identify;
  identify.free = {"tool.length", "X.zero"};
  CalibrationReport report = Identify(Gantry(), set, identify);
  ASSERT_EQ(report.status, IdentifyStatus::kRankDeficient) << RenderText(report);
  ASSERT_EQ(report.unidentifiable.size(), 1U);
  EXPECT_EQ(report.unidentifiable[0].words, "X.zero has no effect on these measurements");
  EXPECT_EQ(report.unidentifiable[0].remedy, "lock it, or measure the tool point's x as well");

  options.kind = MeasurementKind::kPosition;
  identify.free = {"X.zero", "C.position.x"};
  report = Identify(Gantry(), Measured(Gantry(), Gantry().nominal(), options), identify);
  ASSERT_EQ(report.unidentifiable.size(), 1U) << RenderText(report);
  EXPECT_EQ(report.unidentifiable[0].remedy, "lock it, or measure at other positions of C too");
}

TEST(Identify, LeavesWhatItCannotSeeNearItsNominalValue) {
  SimulateOptions options;
  options.sigma_mm = 0.005;
  options.region["C"] = {0.0, 0.0};
  const Eigen::VectorXd truth = Good(ChangedGeometry(Gantry(), {{"X.zero", 0.3}}));
  IdentifyOptions identify;
  identify.free = {"X.zero", "tool.mount.x", "tool.offset[1]"};
  const CalibrationReport report = Identify(Gantry(), Measured(Gantry(), truth, options), identify);
  ASSERT_EQ(report.status, IdentifyStatus::kRankDeficient);
  double sum = 0.0;
  for (const IdentifiedParameter& p : report.parameters) {
    EXPECT_LT(std::abs(p.change()), 0.31) << p.name << " wandered";
    sum += p.change();
  }
  EXPECT_NEAR(sum, 0.3, 0.01) << "the visible sum is right";
}

TEST(Identify, JudgesByRowsThatItDidNotSee) {
  SimulateOptions options;
  options.count = 60;
  options.sigma_mm = 0.01;
  PrinterRegion(&options);
  const Eigen::VectorXd truth = Good(ChangedGeometry(Delta(), {{"delta.radius", 0.5}}));
  const MeasurementSet set = Measured(Delta(), truth, options);
  IdentifyOptions identify;
  identify.held_out_fraction = 0.25;
  const CalibrationReport report = Identify(Delta(), set, identify);
  EXPECT_EQ(report.rows_fitted, 45);
  EXPECT_EQ(report.rows_held_out, 15);
  ASSERT_EQ(report.statistics.size(), 2U);
  EXPECT_TRUE(report.statistics[1].held_out);
  EXPECT_LT(report.statistics[1].rms_after, 0.05);
  EXPECT_GT(report.statistics[1].rms_before, 0.1);

  MeasurementSet spoiled = set;
  for (std::size_t i = 0; i < spoiled.measurements.size(); ++i) {
    if (report.rows[i].held_out) *spoiled.measurements[i].position_mm[0] += 100.0;
  }
  EXPECT_EQ(Identify(Delta(), spoiled, identify).theta_after, report.theta_after)
      << "held-out rows do not touch the fit";
  identify.seed = 2;
  EXPECT_NE(Identify(Delta(), set, identify).theta_after, report.theta_after);
}

TEST(Identify, KeepsToBoundsAndPriors) {
  SimulateOptions options;
  options.sigma_mm = 0.01;
  PrinterRegion(&options);
  const Eigen::VectorXd truth = Good(ChangedGeometry(Delta(), {{"delta.radius", 0.5}}));
  const MeasurementSet set = Measured(Delta(), truth, options);
  const double nominal = Delta().nominal()[Delta().FindParameter("delta.radius")];
  IdentifyOptions bounded;
  bounded.bounds["delta.radius"] = {nominal - 0.2, nominal + 0.2};
  const CalibrationReport at_bound = Identify(Delta(), set, bounded);
  ASSERT_TRUE(at_bound.ok()) << RenderText(at_bound);
  EXPECT_NEAR(at_bound.parameters[0].after, nominal + 0.2, 1e-9);
  EXPECT_TRUE(at_bound.parameters[0].at_bound);
  EXPECT_FALSE(at_bound.parameters[0].sigma);
  EXPECT_THAT(at_bound.diagnostics, Contains(Field(&Diagnostic::code, "W0457")));

  IdentifyOptions held;
  held.prior_sigma["delta.radius"] = 1e-7;
  const CalibrationReport prior = Identify(Delta(), set, held);
  ASSERT_TRUE(prior.ok()) << RenderText(prior);
  EXPECT_NEAR(prior.parameters[0].after, nominal, 1e-6);
  EXPECT_NEAR(*prior.parameters[0].sigma, 1e-7, 1e-8);
}

TEST(Identify, APriorDeterminesWhatMeasurementsDoNot) {
  SimulateOptions options;
  options.kind = MeasurementKind::kHeight;
  options.sigma_mm = 0.01;
  const MeasurementSet set = Measured(Gantry(), Gantry().nominal(), options);
  IdentifyOptions identify;
  identify.free = {"tool.length", "X.zero"};
  identify.prior_sigma["X.zero"] = 0.2;
  const CalibrationReport report = Identify(Gantry(), set, identify);
  EXPECT_EQ(report.status, IdentifyStatus::kConverged) << RenderText(report);
  EXPECT_EQ(report.dof, 60 + 1 - 2);
}

TEST(Identify, NamesRowsAtWhichTheMachineHasNoPose) {
  MeasurementSet set =
      Good(ParseMeasurements("q1,q2,q3,x_mm,y_mm,z_mm\n"
                             "400,400,400,0,0,21\n"
                             "400,400,-4000,0,0,21\n"
                             "390,400,410,5,0,21\n"
                             "9000,400,410,5,0,21\n",
                             "holes.csv",
                             Delta()));
  const CalibrationReport report = Identify(Delta(), set);
  EXPECT_EQ(report.status, IdentifyStatus::kForwardFailed);
  EXPECT_EQ(
      RenderAll(report.diagnostics, {}),
      R"(holes.csv:3:1: error: row 2: the machine has no pose at these readings (out of reach) [E0451]
 3 | 400,400,-4000,0,0,21
   | ^~~~~~~~~~~~~~~~~~~~
  help: check the readings, their units and the layout's drive zeros
holes.csv:5:1: error: row 4: the machine has no pose at these readings (out of reach) [E0451]
 5 | 9000,400,410,5,0,21
   | ^~~~~~~~~~~~~~~~~~~
  help: check the readings, their units and the layout's drive zeros
2 errors
)");
}

TEST(Identify, RefusesFewerNumbersThanUnknowns) {
  SimulateOptions options;
  options.count = 2;
  PrinterRegion(&options);
  const MeasurementSet set = Measured(Delta(), Delta().nominal(), options);
  const CalibrationReport report = Identify(Delta(), set);
  EXPECT_EQ(report.status, IdentifyStatus::kTooFewMeasurements);
  EXPECT_FALSE(report.ok());
  EXPECT_THAT(
      report.diagnostics,
      Contains(Field(&Diagnostic::message, "6 measured numbers cannot determine 9 parameters")));
}

/// Hardly enough for a delta.
MeasurementSet ThreePoints() {
  SimulateOptions options;
  options.count = 3;
  options.seed = 5;
  options.sigma_mm = 0.1;
  PrinterRegion(&options);
  return Measured(Delta(), Delta().nominal(), options);
}

TEST(Identify, SaysThatAnExactFitSaysNothing) {
  IdentifyOptions follow;
  follow.weak_tolerances = 0.0;  // what three points hardly see is followed all the same
  const CalibrationReport report = Identify(Delta(), ThreePoints(), follow);
  EXPECT_EQ(report.dof, 0) << RenderText(report);
  EXPECT_THAT(report.diagnostics, Contains(Field(&Diagnostic::code, "W0452")));
}

TEST(Identify, WhatIsSeenTooWeaklyIsHeldAndNamed) {
  const CalibrationReport report = Identify(Delta(), ThreePoints());
  EXPECT_TRUE(report.ok());
  ASSERT_FALSE(report.unidentifiable.empty());
  EXPECT_TRUE(report.unidentifiable.back().weak);
  EXPECT_THAT(report.unidentifiable.back().words, HasSubstr("seen so weakly"));
  EXPECT_EQ(report.rank + static_cast<int>(report.unidentifiable.size()),
            static_cast<int>(report.free.size()));
}

TEST(Identify, SaysThatDataContradictAndWhichRowStandsOut) {
  SimulateOptions options;
  options.sigma_mm = 0.01;
  PrinterRegion(&options);
  MeasurementSet set = Measured(Delta(), Delta().nominal(), options);
  *set.measurements[16].position_mm[1] += 0.5;
  IdentifyOptions keep;
  keep.outliers = Outliers::kKeep;
  const CalibrationReport report = Identify(Delta(), set, keep);
  ASSERT_TRUE(report.ok());
  EXPECT_GT(report.sigma0, 3.0);
  EXPECT_THAT(report.diagnostics, Contains(Field(&Diagnostic::code, "W0454")));
  EXPECT_THAT(report.diagnostics,
              Contains(AllOf(Field(&Diagnostic::code, "W0455"),
                             Field(&Diagnostic::message, HasSubstr("row 17 is off by")))));
  const CalibrationReport robust = Identify(Delta(), set);
  EXPECT_EQ(robust.rejected, std::vector<int>{17}) << RenderText(robust);
  EXPECT_NEAR(robust.sigma0, 1.0, 0.25);
  EXPECT_THAT(robust.diagnostics,
              Contains(AllOf(Field(&Diagnostic::code, "W0460"),
                             Field(&Diagnostic::message, HasSubstr("row 17 was left out")))));
  const CalibrationReport clean = Identify(Delta(), Measured(Delta(), Delta().nominal(), options));
  EXPECT_THAT(clean.diagnostics, ::testing::IsEmpty()) << RenderAll(clean.diagnostics, {});
}

TEST(Identify, NamesTheLockedNumberThatExplainsWhatIsLeft) {
  const kinematics::Machine& machine = Gantry();
  SimulateOptions options{.count = 80, .sigma_mm = 0.005};
  IdentifyOptions fit{.free = {"C.position.*"}};
  const MeasurementSet longer =
      Measured(machine, Good(ChangedGeometry(machine, {{"X.rotation.c", 1e-3}})), options);
  const CalibrationReport report = Identify(machine, longer, fit);
  ASSERT_TRUE(report.ok());
  ASSERT_EQ(report.suspects.names.size(), 1U) << RenderAll(report.diagnostics, {});
  EXPECT_EQ(report.suspects.names.front(), "X.rotation.c");
  EXPECT_GT(report.suspects.share, 0.95);
  fit.free.push_back("X.rotation.c");
  EXPECT_TRUE(Identify(machine, longer, fit).suspects.names.empty());
}

TEST(Identify, SuspectsNoLockedNumberOfNoise) {
  const kinematics::Machine& machine = Gantry();
  SimulateOptions options{.count = 80, .sigma_mm = 0.05};
  MeasurementSet noisy = Measured(machine, machine.nominal(), options);
  for (Measurement& m : noisy.measurements) m.sigma_mm = 0.005;
  const CalibrationReport report = Identify(machine, noisy, {.free = {"C.position.*"}});
  EXPECT_TRUE(report.suspects.names.empty());
  EXPECT_LT(report.suspects.share_of_all, 0.25);
  EXPECT_THAT(RenderAll(report.diagnostics, {}), HasSubstr("no locked number of the machine"));
}

TEST(Identify, WarnsOfAnArmThatASlipMadeAbsurd) {
  SimulateOptions options;
  options.sigma_mm = 0.01;
  PrinterRegion(&options);
  const Eigen::VectorXd truth = Good(ChangedGeometry(Delta(), {{"delta.strut[2]", 10.0}}));
  const CalibrationReport report = Identify(Delta(), Measured(Delta(), truth, options));
  ASSERT_TRUE(report.ok()) << RenderText(report);
  EXPECT_THAT(report.diagnostics,
              Contains(Field(&Diagnostic::message, HasSubstr("delta.strut[2] changed by +"))));
}

TEST(Identify, ScalesDeviationsByTheResidualsWhenNoneWereGiven) {
  SimulateOptions options;
  options.sigma_mm = 0.05;
  PrinterRegion(&options);
  MeasurementSet set = Measured(Delta(), Delta().nominal(), options);
  const CalibrationReport given = Identify(Delta(), set);
  for (Measurement& m : set.measurements) m.sigma_mm.reset();
  const CalibrationReport assumed = Identify(Delta(), set);
  EXPECT_TRUE(assumed.sigma_assumed);
  EXPECT_NEAR(assumed.sigma0, 5.0 * given.sigma0, 1e-6);
  EXPECT_NEAR(*assumed.parameters[0].sigma, *given.parameters[0].sigma * given.sigma0, 1e-6);
}

TEST(Identify, ReportsWrongPatternsAllAtOnce) {
  IdentifyOptions options;
  options.free = {"delta.radus", "delta.strut"};
  options.lock = {"nothing.*"};
  options.bounds["delta.strut"] = {2.0, 1.0};
  options.prior_sigma["delta.strut"] = -1.0;
  const CalibrationReport report = Identify(Delta(), {}, options);
  EXPECT_EQ(report.status, IdentifyStatus::kBadInput);
  const std::string text = RenderAll(report.diagnostics, {});
  EXPECT_THAT(text,
              HasSubstr("no parameter is called 'delta.radus' (free) [E0431]\n"
                        "  help: did you mean 'delta.radius'?"));
  EXPECT_THAT(text, HasSubstr("no parameter is called 'nothing.*' (lock)"));
  EXPECT_THAT(text, HasSubstr("the bounds of delta.strut[1] leave no room between 2 and 1"));
  EXPECT_THAT(text, HasSubstr("the prior deviation of delta.strut[3] must be greater than 0"));
}

TEST(Identify, FreesWhatTheLayoutLocksOnlyWhenToldTo) {
  SimulateOptions options;
  options.sigma_mm = 0.01;
  PrinterRegion(&options);
  const MeasurementSet set = Measured(Delta(), Delta().nominal(), options);
  const auto free_names = [&set](const IdentifyOptions& identify) {
    std::vector<std::string> names;
    for (const IdentifiedParameter& p : Identify(Delta(), set, identify).parameters) {
      names.push_back(p.name);
    }
    return names;
  };
  EXPECT_THAT(free_names({}), ::testing::Not(Contains("delta.azimuth[3]")));
  EXPECT_THAT(free_names({.free = {"delta.azimuth"}}),
              ::testing::ElementsAre("delta.azimuth[1]", "delta.azimuth[2]", "delta.azimuth[3]"));
  EXPECT_THAT(free_names({.free = {"delta.azimuth"}, .lock = {"*[1]"}}),
              ::testing::ElementsAre("delta.azimuth[2]", "delta.azimuth[3]"));
}

TEST(Identify, StronglyCorrelatedParametersAreListed) {
  SimulateOptions options;
  options.kind = MeasurementKind::kHeight;
  options.sigma_mm = 0.01;
  options.count = 200;
  PrinterRegion(&options);
  const CalibrationReport report = Identify(Delta(), Measured(Delta(), Delta().nominal(), options));
  ASSERT_TRUE(report.ok());
  ASSERT_FALSE(report.correlated.empty()) << RenderText(report);
  for (const CorrelatedPair& pair : report.correlated) {
    EXPECT_GT(std::abs(pair.correlation), 0.95);
    EXPECT_LE(std::abs(pair.correlation), 1.0 + 1e-12);
  }
}

TEST(Reports, SayTheSameInJsonAsInMemory) {
  SimulateOptions options;
  options.held_out = 5;
  options.sigma_mm = 0.01;
  PrinterRegion(&options);
  const Eigen::VectorXd truth = Good(ChangedGeometry(Delta(), {{"delta.azimuth[1]", 0.001}}));
  const CalibrationReport report = Identify(Delta(), Measured(Delta(), truth, options));
  const nlohmann::json json = ToJson(report);
  EXPECT_EQ(json.at("status"), "converged");
  EXPECT_EQ(json.at("rows").size(), 65U);
  EXPECT_EQ(json.at("parameters").size(), 9U);
  const nlohmann::json& azimuth = json.at("parameters").at(1);
  EXPECT_EQ(azimuth.at("name"), "delta.azimuth[1]");
  EXPECT_EQ(azimuth.at("unit"), "deg");
  EXPECT_NEAR(azimuth.at("change_deg"), 0.0573, 0.01);
  EXPECT_EQ(json.at("errors").at(1).at("held_out"), true);
  EXPECT_EQ(nlohmann::json::parse(json.dump()), json);
}

TEST(Reports, ListEveryRowOnDemand) {
  SimulateOptions options;
  options.count = 4;
  options.held_out = 1;
  PrinterRegion(&options);
  const CalibrationReport report = Identify(Delta(), Measured(Delta(), Delta().nominal(), options));
  EXPECT_THAT(RenderText(report), ::testing::Not(HasSubstr("in deviations")));
  EXPECT_THAT(RenderText(report, {.residuals = true}), HasSubstr("held out\n"));
}

}  // namespace
}  // namespace kompono::calibration
