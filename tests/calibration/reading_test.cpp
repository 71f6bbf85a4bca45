// SPDX-License-Identifier: Apache-2.0
// Measurement files, good and bad; complaints as whole texts.
#include "machines.hpp"
#include "residuals.hpp"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kompono/calibration/measurements.hpp"

namespace kompono::calibration {
namespace {

using ::testing::ElementsAre;
using testing::Good;
using ::testing::HasSubstr;
using testing::kData;
using testing::MachineFrom;
using testing::MachineOf;

/// Three axes and a turning table: drives X, Y, Z in mm, C in deg or rad.
const kinematics::Machine& Mill() {
  static const kinematics::Machine machine = MachineFrom(R"(kompono = 1
name = "mill"
formula = "part C O X Y Z tool"
[axis.X]
range = [-500, 500]
[axis.Y]
range = [-500, 500]
[axis.Z]
range = [-500, 500]
[axis.C]
range = [-180, 180]
)");
  return machine;
}

std::string Complaints(std::string_view text, const kinematics::Machine& machine = Mill()) {
  Diagnostics notes;
  const Parsed<MeasurementSet> set = ParseMeasurements(text, "m.csv", machine, {}, &notes);
  return RenderAll(set ? notes : set.error(), {});
}

TEST(MeasurementFiles, AreReadWithUnitsKindsAndDeviations) {
  const MeasurementSet set = Good(ParseMeasurements(
      "# by hand\n"
      "kind,value_mm,x_mm,y_mm,z_mm,a_deg,b_deg,c_deg,sigma_mm,sigma_rad,held_out,X,Y,Z,C_deg,"
      "second.X_mm,second.Y_mm,second.Z_mm,second.C_rad\n"
      "\n"
      "height,30,,,,,,,0.01,,,10,20,30,0,,,,\n"
      "distance,50,,,,,,,,,yes,0,0,0,0,30,40,0,0\n"
      "position,,1,2,,,,,,,0,1,2,3,0,,,,\n"
      "pose,,1,2,3,0,0,-90,,0.001,1,1,2,3,90,,,,\n",
      "m.csv",
      Mill()));
  ASSERT_EQ(set.measurements.size(), 4U);
  const Measurement& height = set.measurements[0];
  EXPECT_EQ(height.kind, MeasurementKind::kHeight);
  EXPECT_EQ(height.value_mm, 30.0);
  EXPECT_EQ(height.sigma_mm, 0.01);
  EXPECT_EQ(height.line, 4);
  EXPECT_EQ(height.row, 1);
  EXPECT_FALSE(height.held_out);
  const Measurement& distance = set.measurements[1];
  EXPECT_EQ(distance.second_readings[Mill().FindDrive("Y")], 40.0);
  EXPECT_TRUE(distance.held_out);
  const Measurement& position = set.measurements[2];
  EXPECT_THAT(position.position_mm, ElementsAre(1.0, 2.0, std::nullopt));
  EXPECT_EQ(position.Numbers(), 2);
  const Measurement& pose = set.measurements[3];
  EXPECT_NEAR(pose.readings[Mill().FindDrive("C")], std::acos(0.0), 1e-15);
  EXPECT_NEAR(RotationVector(pose.R_WT).z(), -std::acos(0.0), 1e-15);
  EXPECT_EQ(pose.sigma_rad, 0.001);
  EXPECT_EQ(pose.Numbers(), 6);
}

TEST(MeasurementFiles, NeedNoKindWhenTheFilledCellsLeaveNoDoubt) {
  const MeasurementSet set = Good(ParseMeasurements(
      "X,Y,Z,C_rad,second.X,second.Y,second.Z,second.C_rad,value_mm,x_mm,y_mm,z_mm,rx_rad,ry_rad,"
      "rz_rad\n"
      "1,2,3,0,,,,,3,,,,,,\n"
      "0,0,0,0,3,4,0,0,5,,,,,,\n"
      "1,2,3,0,,,,,,1,,3,,,\n"
      "1,2,3,0,,,,,,1,2,3,0,0,0\n",
      "m.csv",
      Mill()));
  std::vector<MeasurementKind> kinds;
  for (const Measurement& m : set.measurements) kinds.push_back(m.kind);
  EXPECT_THAT(kinds,
              ElementsAre(MeasurementKind::kHeight,
                          MeasurementKind::kDistance,
                          MeasurementKind::kPosition,
                          MeasurementKind::kPose));
}

TEST(MeasurementFiles, MustNotGiveAnApproachThatTheyDoNotMeasure) {
  const auto set = ParseMeasurements(
      "X,Y,Z,C_deg,x_mm,y_mm,approach\n1,2,3,0,1,2,+Q\n1,2,3,0,1,2,-Z\n1,2,3,0,1,2,C+\n",
      "m.csv",
      Mill());
  ASSERT_FALSE(set);
  const std::string said = RenderAll(set.error(), {});
  EXPECT_THAT(said, HasSubstr("'+Q' is no direction of approach"));
  EXPECT_THAT(said, HasSubstr("the row was approached along Z and does not measure z"));
  EXPECT_THAT(said,
              HasSubstr("the row was approached along C and does not measure an orientation"));
  EXPECT_THAT(said, HasSubstr("E0475"));
}

/// What comes out of spreadsheets and instruments and is no table yet: one complaint each.
TEST(MeasurementFiles, ThatAreNoTextOfLinesAreNamed) {
  const auto complaint = [](std::string_view text) {
    const auto set = ParseMeasurements(text, "m.csv", Mill());
    return set ? std::string("accepted") : RenderAll(set.error(), {});
  };
  EXPECT_EQ(complaint(std::string("\xFF\xFEX\0,\0", 6)),
            "m.csv: error: the file is UTF-16 [E0477]\n"
            "  help: save it as UTF-8: \"CSV UTF-8\" in spreadsheets\n1 error\n");
  EXPECT_EQ(complaint(std::string("X,Y\n1,\0002\n", 9)),
            "m.csv: error: byte 7 is zero: the file is no text [E0477]\n"
            "  help: give the file as text in UTF-8, not the program's own format\n1 error\n");
  EXPECT_EQ(complaint("X,Y,Z,C_deg,x_mm\r1,2,3,0,1\r"),
            "m.csv: error: the lines end with a carriage return alone [E0477]\n"
            "  help: save the file with the line ends of Unix or Windows\n1 error\n");
  EXPECT_THAT(complaint("X,Y,Z,C_deg,x_mm,y_mm,\n1,2,3,0,1,2,\n"),
              HasSubstr("m.csv:1:23: error: a column without a name [E0403]"));
}

TEST(MeasurementFiles, OfAHexapodLoadAndTellWhatTheyPassOver) {
  const kinematics::Machine machine = MachineOf("machines/hexapod_reference.toml");
  Diagnostics notes;
  const MeasurementSet set =
      Good(ReadMeasurements(kData / "hexapod_train60.csv", machine, {}, &notes));
  EXPECT_EQ(set.measurements.size(), 60U);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].severity, Severity::kNote);
  EXPECT_THAT(notes[0].message,
              HasSubstr("6 of 18 columns are not used: cmd_x, cmd_y, cmd_z, cmd_rx"));
}

TEST(MeasurementFiles, MayUseSemicolonsQuotesAByteOrderMarkAndWindowsLineEnds) {
  const MeasurementSet set = Good(ParseMeasurements(
      "\xEF\xBB\xBFX;Y;Z;C_deg;\"x_mm\";y_mm;z_mm\r\n1;2;3;0;+1.0;2e0;3\r\n", "m.csv", Mill()));
  EXPECT_EQ(set.measurements[0].position_mm[1], 2.0);
}

TEST(MeasurementFiles, ComeBackFromTheWriterToTheSameNumbers) {
  const MeasurementSet set = Good(ParseMeasurements(
      "kind,value_mm,x_mm,y_mm,z_mm,rx_rad,ry_rad,rz_rad,sigma_mm,sigma_rad,held_out,X,Y,Z,C_rad,"
      "second.X,second.Y,second.Z,second.C_rad\n"
      "height,3.1,,,,,,,0.1,,0,1.1,2.2,3.3,0.1,,,,\n"
      "distance,5.1,,,,,,,,,1,0,0,0,0,3,4,0,0.3\n"
      "pose,,0.1,0.2,0.3,0.01,-0.02,0.03,0.3,0.001,0,0.1,0.2,0.3,0,,,,\n",
      "m.csv",
      Mill()));
  const std::string text = WriteMeasurements(set, Mill(), {"made by a test"});
  EXPECT_THAT(text, HasSubstr("# made by a test\nkind,value_mm,x_mm"));
  const MeasurementSet again = Good(ParseMeasurements(text, "again.csv", Mill()));
  ASSERT_EQ(again.measurements.size(), set.measurements.size());
  for (std::size_t i = 0; i < set.measurements.size(); ++i) {
    const Measurement& a = set.measurements[i];
    const Measurement& b = again.measurements[i];
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.readings, b.readings);
    EXPECT_EQ(a.second_readings, b.second_readings);
    EXPECT_EQ(a.value_mm, b.value_mm);
    EXPECT_EQ(a.position_mm, b.position_mm);
    EXPECT_TRUE(a.R_WT.isApprox(b.R_WT, 1e-15));
    EXPECT_EQ(a.sigma_mm, b.sigma_mm);
    EXPECT_EQ(a.sigma_rad, b.sigma_rad);
    EXPECT_EQ(a.held_out, b.held_out);
  }
}

struct BadFile {
  std::string name;
  std::string text;
  std::string complaint;
};

void PrintTo(const BadFile& file, std::ostream* out) {
  *out << file.name;
}

class BadFiles : public ::testing::TestWithParam<BadFile> {};

TEST_P(BadFiles, AreRefusedInTheseWords) {
  EXPECT_EQ(Complaints(GetParam().text), GetParam().complaint);
}

INSTANTIATE_TEST_SUITE_P(
    Gallery,
    BadFiles,
    ::testing::Values(
        BadFile{"Empty", "# nothing yet\n", R"(m.csv: error: the file is empty [E0402]
  help: a header line with the columns' names, then one line for each measurement
1 error
)"},
        BadFile{"HeaderOnly",
                "X,Y,Z,C_deg,x_mm\n",
                R"(m.csv: error: the file has a header and no rows [E0402]
  help: a header line with the columns' names, then one line for each measurement
1 error
)"},
        BadFile{"Columns",
                "X,Y,C_deg,C_rad,kinnd,x,y_in,value\n1,2,3,4,5,6,7,8\n",
                R"(m.csv:1:1: error: no column for 1 of the 4 drives: Z_mm [E0404]
 1 | X,Y,C_deg,C_rad,kinnd,x,y_in,value
   | ^~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~
  help: every row needs the readings of all drives at which it was measured
m.csv:1:11: error: column 'C_rad' gives again what an earlier column gives [E0405]
 1 | X,Y,C_deg,C_rad,kinnd,x,y_in,value
   |           ^~~~~
  help: remove one of them
m.csv:1:17: error: unknown column 'kinnd' [E0403]
 1 | X,Y,C_deg,C_rad,kinnd,x,y_in,value
   |                 ^~~~~
  help: did you mean 'kind'?
m.csv:1:23: error: column 'x' does not tell its unit [E0406]
 1 | X,Y,C_deg,C_rad,kinnd,x,y_in,value
   |                       ^
  help: write 'x_mm' and give the numbers in millimetres
m.csv:1:25: error: column 'y_in' is a length and cannot be in 'in' [E0406]
 1 | X,Y,C_deg,C_rad,kinnd,x,y_in,value
   |                         ^~~~
  help: write 'y_mm' and give the numbers in millimetres
m.csv:1:30: error: column 'value' does not tell its unit [E0406]
 1 | X,Y,C_deg,C_rad,kinnd,x,y_in,value
   |                              ^~~~~
  help: write 'value_mm' and give the numbers in millimetres
6 errors
)"},
        BadFile{"DriveUnits",
                "X_deg,Y_m,Z,C,x_mm\n1,2,3,4,5\n",
                R"(m.csv:1:1: error: column 'X_deg' is a length and cannot be in 'deg' [E0406]
 1 | X_deg,Y_m,Z,C,x_mm
   | ^~~~~
  help: write 'X_mm' and give the numbers in millimetres
m.csv:1:7: error: column 'Y_m' is a length and cannot be in 'm' [E0406]
 1 | X_deg,Y_m,Z,C,x_mm
   |       ^~~
  help: write 'Y_mm' and give the numbers in millimetres
m.csv:1:13: error: column 'C' does not tell its unit [E0406]
 1 | X_deg,Y_m,Z,C,x_mm
   |             ^
  help: write 'C_deg' and give the numbers in degrees
3 errors
)"},
        BadFile{"NothingMeasured",
                "X,Y,Z,C_deg\n1,2,3,4\n",
                R"(m.csv:1:1: error: no column for what was measured [E0404]
 1 | X,Y,Z,C_deg
   | ^~~~~~~~~~~
  help: value_mm for heights and distances; x_mm, y_mm, z_mm for positions and poses
1 error
)"},
        BadFile{"Cells",
                "kind,X,Y,Z,C_deg,x_mm,y_mm,z_mm,sigma_mm,held_out\n"
                "position,1,two,3,0,1,2,nan,-0.1,maybe\n"
                "positon,1,2,3,0,1e999,2,3,,\n"
                "position,1,2,3,0,1,2,3\n"
                "height,1,2,3,0,,,,,\n"
                "position,,2,3,0,,,,,\n",
                R"(m.csv:2:12: error: 'two' is not a number [E0408]
 2 | position,1,two,3,0,1,2,nan,-0.1,maybe
   |            ^~~
m.csv:2:24: error: 'nan' is not a finite number [E0409]
 2 | position,1,two,3,0,1,2,nan,-0.1,maybe
   |                        ^~~
m.csv:2:28: error: a standard deviation must be greater than 0 [E0412]
 2 | position,1,two,3,0,1,2,nan,-0.1,maybe
   |                            ^~~~
  help: leave the cell empty if it is not known
m.csv:2:33: error: 'maybe' is neither yes nor no [E0413]
 2 | position,1,two,3,0,1,2,nan,-0.1,maybe
   |                                 ^~~~~
  help: write 1 for a row that is kept out of the fit, else 0 or nothing
m.csv:3:1: error: unknown kind of measurement 'positon' [E0410]
 3 | positon,1,2,3,0,1e999,2,3,,
   | ^~~~~~~
  help: did you mean 'position'?
m.csv:3:17: error: '1e999' is not a finite number [E0409]
 3 | positon,1,2,3,0,1e999,2,3,,
   |                 ^~~~~
m.csv:4:1: error: the row has 8 cells, the header 10 [E0407]
 4 | position,1,2,3,0,1,2,3
   | ^~~~~~~~~~~~~~~~~~~~~~
  help: empty cells need their separators too
m.csv:5:1: error: a height and no column for it [E0411]
 5 | height,1,2,3,0,,,,,
   | ^~~~~~~~~~~~~~~~~~~
m.csv:6:1: error: a position needs at least one of x_mm, y_mm, z_mm [E0411]
 6 | position,,2,3,0,,,,,
   | ^~~~~~~~~~~~~~~~~~~~
m.csv:6:10: error: 'X' is empty, but the row is a measurement [E0411]
 6 | position,,2,3,0,,,,,
   |          ^
10 errors
)"},
        BadFile{"Doubt",
                "X,Y,Z,C_deg,x_mm,value_mm,a_deg,b_deg,c_deg,rx_rad,ry_rad,rz_rad,y_mm,z_mm\n"
                "1,2,3,0,1,3,,,,,,,,\n"
                "1,2,3,0,1,,0,0,0,0,0,0,2,3\n",
                R"(m.csv:2:1: error: the row may be of more than one kind [E0416]
 2 | 1,2,3,0,1,3,,,,,,,,
   | ^~~~~~~~~~~~~~~~~~~
  help: name it in a column 'kind': height, distance, position, pose, ball_bar, plane, hole or relative
m.csv:3:1: error: the row gives its orientation twice [E0411]
 3 | 1,2,3,0,1,,0,0,0,0,0,0,2,3
   | ^~~~~~~~~~~~~~~~~~~~~~~~~~
  help: fill either rx_rad, ry_rad, rz_rad or a_deg, b_deg, c_deg
2 errors
)"},
        BadFile{"DecimalComma",
                "X;Y;Z;C_deg;x_mm\n1;2;3;0;1,5\n",
                R"(m.csv:2:9: error: '1,5' is not a number [E0408]
 2 | 1;2;3;0;1,5
   |         ^~~
  help: write decimals with a point
1 error
)"},
        BadFile{"TypedTwice",
                "X,Y,Z,C_deg,x_mm\n1,2,3,0,1\n2,2,3,0,2\n1,2,3,0,1\n",
                R"(m.csv:4:1: warning: the row is the same as line 2 [W0414]
 4 | 1,2,3,0,1
   | ^~~~~~~~~
  help: it counts twice; remove it unless it was really measured twice
1 warning
)"},
        BadFile{
            "Metres",
            "X,Y,Z,C_deg,x_mm,y_mm,z_mm\n100,200,300,0,0.1001,0.2,0.3\n"
            "300,-200,100,0,0.3001,-0.2,0.1\n",
            R"(m.csv:1:13: error: it looks as if the measured lengths are in metres: the median error against the nominal machine is 373.8 mm, and 0.1 mm after a factor of 1000 [E0415]
 1 | X,Y,Z,C_deg,x_mm,y_mm,z_mm
   |             ^~~~
  help: give all lengths in millimetres, or switch the check of units off
1 error
)"},
        BadFile{
            "ReadingsInMetres",
            "X,Y,Z,C_deg,x_mm,y_mm,z_mm\n0.1,0.2,0.3,0,100.1,200,300\n"
            "0.3,-0.2,0.1,0,300.1,-200,100\n",
            R"(m.csv:1:1: error: it looks as if the drive readings are in metres: the median error against the nominal machine is 373.9 mm, and 0.1 mm after a factor of 1000 [E0415]
 1 | X,Y,Z,C_deg,x_mm,y_mm,z_mm
   | ^
  help: give all lengths in millimetres, or switch the check of units off
1 error
)"},
        BadFile{
            "LengthsInMicrometres",
            "X,Y,Z,C_deg,x_mm,y_mm,z_mm\n100,200,300,0,100100,200000,300000\n",
            R"(m.csv:1:13: error: it looks as if the measured lengths are in micrometres: the median error against the nominal machine is 3.738e+05 mm, and 0.1 mm after a factor of 0.001 [E0415]
 1 | X,Y,Z,C_deg,x_mm,y_mm,z_mm
   |             ^~~~
  help: give all lengths in millimetres, or switch the check of units off
1 error
)"},
        BadFile{"RotationsInDegrees",
                "X,Y,Z,C_deg,x_mm,y_mm,z_mm,rx_rad,ry_rad,rz_rad\n0,0,3,1,0,0,3,0,0,-1\n"
                "0,0,3,2,0,0,3,0,0,-2\n0,0,3,-3,0,0,3,0,0,3\n",
                R"(m.csv:1:28: error: it looks as if the rotation vectors are in degrees [E0415]
 1 | X,Y,Z,C_deg,x_mm,y_mm,z_mm,rx_rad,ry_rad,rz_rad
   |                            ^~~~~~
  help: give them in radians, or call the columns rx_deg, ry_deg, rz_deg
1 error
)"},
        BadFile{
            "RotationsOfManyDegrees",
            "X,Y,Z,C_deg,x_mm,y_mm,z_mm,rx_rad,ry_rad,rz_rad\n0,0,3,30,0,0,3,0,0,-30\n",
            R"(m.csv:2:16: error: the rotation vector is longer than a full turn, as if it were in degrees [E0415]
 2 | 0,0,3,30,0,0,3,0,0,-30
   |                ^
  help: give it in radians, or call the columns rx_deg, ry_deg, rz_deg
1 error
)"}),
    [](const auto& file) { return file.param.name; });

TEST(MeasurementFiles, WithThousandsOfEqualMistakesStayReadable) {
  std::string text = "X,Y,Z,C_deg,x_mm\n";
  for (int i = 0; i < 2000; ++i) text += "1,2,3,0,?\n";
  Diagnostics notes;
  const Parsed<MeasurementSet> set = ParseMeasurements(text, "m.csv", Mill(), {}, &notes);
  ASSERT_FALSE(set);
  EXPECT_LT(set.error().size(), 120U);
  EXPECT_THAT(RenderAll(set.error(), {}), HasSubstr("1950 more of E0408 are not shown"));
}

TEST(MeasurementFiles, ThatDoNotExistAreNamed) {
  const Parsed<MeasurementSet> set = ReadMeasurements("no/such.csv", Mill());
  ASSERT_FALSE(set);
  EXPECT_EQ(RenderAll(set.error(), {}),
            "no/such.csv: error: cannot read the measurement file [E0401]\n1 error\n");
}

TEST(MeasurementFiles, InOtherUnitsAreReadWhenTheCheckIsOff) {
  const Parsed<MeasurementSet> set =
      ParseMeasurements("X,Y,Z,C_deg,x_mm,y_mm,z_mm\n100,200,300,0,0.1,0.2,0.3\n",
                        "m.csv",
                        Mill(),
                        {.check_units = false});
  EXPECT_TRUE(set);
}

TEST(MeasurementFiles, WithRandomDamageAreReadOrRefusedButNeverCrash) {
  const std::string good =
      "# by hand\nkind,value_mm,x_mm,y_mm,z_mm,a_deg,b_deg,c_deg,sigma_mm,held_out,X,Y,Z,C_deg,"
      "second.X,second.Y,second.Z,second.C_rad\n"
      "height,30,,,,,,,0.01,,10,20,30,0,,,,\n"
      "distance,50,,,,,,,,yes,0,0,0,0,30,40,0,0\n"
      "pose,,1,2,3,0,0,-90,,1,1,2,3,90,,,,\n";
  const std::string bytes = ",;\"#\n\r\t-+.eE0189xnaif_\xD0\x80";
  for (unsigned seed = 1; seed <= 3000; ++seed) {
    std::mt19937 random(seed);
    std::string text = good;
    for (int i = 0; i < 4; ++i) {
      const std::size_t at = random() % text.size();
      switch (random() % 3) {
        case 0:
          text[at] = bytes[random() % bytes.size()];
          break;
        case 1:
          text.erase(at, 1 + random() % 20);
          break;
        default:
          text.insert(at, 1, bytes[random() % bytes.size()]);
          break;
      }
    }
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Parsed<MeasurementSet> set = ParseMeasurements(text, "m.csv", Mill());
    if (set) continue;
    ASSERT_TRUE(HasErrors(set.error()));
    for (const Diagnostic& d : set.error()) {
      ASSERT_FALSE(d.message.empty());
    }
  }
}

TEST(KlipperFiles, AreRefusedWithAllTheirFaults) {
  const kinematics::Machine delta = MachineOf("machines/flsun_v400.toml");
  const std::string header = "kind,value_mm,s1_a_mm,s1_b_mm,s1_c_mm,s2_a_mm,s2_b_mm,s2_c_mm\n";
  EXPECT_EQ(
      Complaints(header + "height,1,2,3,x,,,\nwidth,1,2,3,4,,,\ndistance,1,2,3,4,5,6,\nheight,1\n",
                 delta),
      R"(m.csv:2:14: error: 'x' is not a number [E0408]
 2 | height,1,2,3,x,,,
   |              ^
m.csv:3:1: error: unknown kind of measurement 'width' [E0410]
 3 | width,1,2,3,4,,,
   | ^~~~~
  help: known are: height, distance
m.csv:4:22: error: '' is not a number [E0408]
 4 | distance,1,2,3,4,5,6,
   |                      ^
m.csv:5:1: error: the row has 2 cells, the header 8 [E0407]
 5 | height,1
   | ^~~~~~~~
  help: empty cells need their separators too
4 errors
)");
  EXPECT_EQ(
      Complaints(header + "height,1,2,3,4,,,\n"),
      R"(m.csv:1:1: error: Klipper's delta runs have three towers, the machine has 4 drives [E0424]
 1 | kind,value_mm,s1_a_mm,s1_b_mm,s1_c_mm,s2_a_mm,s2_b_mm,s2_c_mm
   | ^~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~
  help: take a layout with a linear_delta
1 error
)");
}

}  // namespace
}  // namespace kompono::calibration
