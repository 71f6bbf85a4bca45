// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/mobility.hpp"

#include "shipped_machines.hpp"

#include <set>

namespace kompono::analysis {
namespace {

BlockMobility OnlyBlock(const std::string& machine) {
  const std::vector<BlockMobility> all = Mobility(tests::LoadMachine(machine));
  EXPECT_EQ(all.size(), 1U);
  return all.front();
}

/// Worked out by hand from the drawings. links n with base and platform, pairs p, loops e = p - n +
/// 1 (KDD eq. 1), Grübler's count 6 (n - 1 - p) + f, in the plane 3 (n - 1 - p) + f, with f = 1 for
/// R and P, 2 for U, 3 for S.
struct Row {
  const char* machine;
  int links, pairs, loops, gruebler, numeric, idle, passive;
};
constexpr Row kRows[] = {
    // Base, two carriages, two bars; P P R R R: 3 (5 - 1 - 5) + 5 = 2, in space 6 (-1) + 5 = -1.
    {"biglide_mill", 5, 5, 1, 2, 2, 0, 3},
    {"so_waterjet_lambda", 5, 5, 1, 2, 2, 0, 3},
    // Base, platform, three carriages, six bars; 3 P + 12 S: 6 (11 - 1 - 15) + 3 + 36 = 9.
    {"ksm_pyramid", 11, 15, 5, 9, 3, 6, 0},
    {"pyramid_by_angle", 11, 15, 5, 9, 3, 6, 0},
    {"linuxcnc_lineardelta", 11, 15, 5, 9, 3, 6, 0},
    {"triglide", 11, 15, 5, 9, 3, 6, 0},
    {"v100_lathe", 11, 15, 5, 9, 3, 6, 0},
    // Three cranks instead of the carriages.
    {"linuxcnc_rotarydelta", 11, 15, 5, 9, 3, 6, 0},
    // Base, platform, two halves of each of six pods; 6 U + 6 P + 6 S: 6 (14 - 1 - 18) + 36 = 6.
    {"hexapod_reference", 14, 18, 5, 6, 6, 0, 0},
    {"hexapod_symmetric", 14, 18, 5, 6, 6, 0, 0},
    // Carriage and bar for each of six legs, P U S.
    {"hexaglide_mill", 14, 18, 5, 6, 6, 0, 0},
    {"kdd_six_strut_lathe", 14, 18, 5, 6, 6, 0, 0},
    // Three pods welded into one point: base, 3 halves, 3 halves of which one is the platform; 3 U
    // +
    // 3 P + 2 S: 6 (7 - 1 - 8) + 6 + 3 + 6 = 3.
    {"linuxcnc_tripod", 7, 8, 2, 3, 3, 0, 0},
    // Base, platform with the tube, three pods of two halves, the tube's joint; 4 U + 4 P + 3 S:
    // 6 (9 - 1 - 11) + 8 + 4 + 9 = 3.
    {"tripod_guided", 9, 11, 3, 3, 3, 0, 0},
    // Base, platform, three pods of two halves; 3 R + 3 P + 3 S: 6 (8 - 1 - 9) + 15 = 3.
    {"tripod_3rps", 8, 9, 2, 3, 3, 0, 0},
    // Five pods of two halves and four links that hold the turn about the axis: 6 (16 - 1 - 19)
    // + 29.
    {"linuxcnc_pentakins_default", 16, 19, 4, 5, 5, 0, 0},
    // Base, platform, four carriages, four bars, two links of the guide; 4 P U S and the guide's P
    // P U:
    // 6 (12 - 1 - 15) + 6 + 10 + 12 = 4.
    {"kdd_four_strut_lathe", 12, 15, 4, 4, 4, 0, 0},
};

TEST(Mobility, IsWhatHandCountsGive) {
  for (const Row& row : kRows) {
    const BlockMobility mobility = OnlyBlock(row.machine);
    EXPECT_EQ(mobility.links, row.links) << row.machine;
    EXPECT_EQ(mobility.pairs, row.pairs) << row.machine;
    EXPECT_EQ(mobility.loops, row.loops) << row.machine;
    EXPECT_EQ(mobility.gruebler, row.gruebler) << row.machine;
    EXPECT_EQ(mobility.numeric, row.numeric) << row.machine;
    EXPECT_EQ(mobility.idle, row.idle) << row.machine;
    EXPECT_EQ(mobility.passive, row.passive) << row.machine;
    EXPECT_EQ(row.links + row.loops - row.pairs, 1) << row.machine << ": KDD eq. 1";
    EXPECT_EQ(mobility.explanation.empty(), row.idle == 0 && row.passive == 0) << row.machine;
  }
}

TEST(Mobility, TableNamesEveryMechanismThatShips) {
  std::set<std::string> counted;
  for (const Row& row : kRows) counted.insert(OnlyBlock(row.machine).module);
  std::set<std::string> implemented;
  for (const std::string& module : counted)
    implemented.insert(tests::ShippedRegistry().Find(module)->implementation);
  for (const auto& module : tests::ShippedRegistry().modules()) {
    if (module.kind == plugin::ModuleKind::kMechanism && module.implementation == module.id) {
      EXPECT_TRUE(implemented.contains(module.id)) << module.id;
    }
  }
}

TEST(Mobility, SaysWhatTheDifferenceMeans) {
  EXPECT_EQ(OnlyBlock("hexapod_reference").explanation, "");
  EXPECT_EQ(OnlyBlock("ksm_pyramid").explanation,
            "6 of the counted motions move no platform: struts that spin about themselves");
  EXPECT_EQ(OnlyBlock("so_waterjet_lambda").explanation,
            "counted in space -1: 3 constraints that keep the links in one plane repeat others "
            "(passive constraints)");
}

TEST(Mobility, CountsTheMechanismsOfEveryBranch) {
  const std::vector<BlockMobility> both = Mobility(tests::LoadMachine("kdd_mirrored_pair"));
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[0].block, "front");
  EXPECT_EQ(both[1].block, "back");
  EXPECT_EQ(both[1].numeric, 4);
}

TEST(Mobility, OfEveryShippedMechanismIsItsNumberOfDrives) {
  for (const std::string& name : tests::ShippedMachineFiles()) {
    for (const BlockMobility& mobility : Mobility(tests::LoadMachine(name))) {
      EXPECT_EQ(mobility.numeric, mobility.drives) << name;
      EXPECT_TRUE(mobility.counted) << name << ": the sidecar gives no links and pairs";
      EXPECT_GE(mobility.gruebler, mobility.numeric) << name;
    }
  }
}

}  // namespace
}  // namespace kompono::analysis
