// SPDX-License-Identifier: Apache-2.0
// Slips in measurement files: each is named, with status 3, and nothing is written.
#include "program.hpp"

#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kompono::cli_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Slips : public Program {
 protected:
  Slips() {
    // Every number with a tolerance off by a part of it, full poses with an instrument's noise.
    const std::string region =
        "struts.X=-120:120,struts.Y=-100:140,struts.Z=800:1000,"
        "struts.A=-10:10,struts.B=-10:10,struts.C=-10:10";
    const Outcome outcome = Run({"measure",
                                 hexapod_,
                                 "--as-made",
                                 "5",
                                 "--kind",
                                 "pose",
                                 "--points",
                                 "40",
                                 "--sigma-mm",
                                 "0.005",
                                 "--sigma-deg",
                                 "0.0005",
                                 "--region",
                                 region,
                                 "-o",
                                 "p.csv"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }

  using Cells = std::vector<std::string>;

  /// p.csv with every line of numbers changed; the header is the first argument.
  void Change(const std::function<void(const Cells&, Cells*)>& change,
              const std::function<void(Cells*)>& change_header = nullptr) const {
    Cells header;
    std::string out;
    for (const std::string& line : Lines(Read("p.csv"))) {
      if (line.starts_with('#')) continue;
      Cells cells;
      std::istringstream stream(line);
      for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
      if (header.empty()) {
        header = cells;
        if (change_header) change_header(&cells);
      } else {
        change(header, &cells);
      }
      for (std::size_t i = 0; i < cells.size(); ++i) out += (i == 0 ? "" : ",") + cells[i];
      out += '\n';
    }
    Write("p.csv", out);
  }

  static std::string& Cell(const Cells& header, Cells* cells, const std::string& name) {
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (header[i] == name) return cells->at(i);
    }
    throw std::out_of_range(name);
  }

  static void Scale(std::string* cell, double factor) {
    *cell = std::to_string(std::stod(*cell) * factor);
  }

  /// What is said of p.csv; it must be refused.
  [[nodiscard]] std::string Refused() const {
    const Outcome outcome = Run({"calibrate",
                                 hexapod_,
                                 "p.csv",
                                 "-o",
                                 "out.toml",
                                 "--report",
                                 "r.json",
                                 "--html",
                                 "r.html"});
    EXPECT_EQ(outcome.code, 3) << outcome.out << outcome.err;
    return outcome.err;
  }

  const std::string hexapod_ = Machine("hexapod_reference");
};

TEST_F(Slips, WithoutOneTheFileIsTaken) {
  const Outcome outcome = Run({"calibrate", hexapod_, "p.csv", "-o", "out.toml"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(Files(), ElementsAre("out.toml", "p.csv"));
}

TEST_F(Slips, MetresForMillimetres) {
  Change([](const Cells& header, Cells* row) {
    for (const char* name : {"x_mm", "y_mm", "z_mm"}) Scale(&Cell(header, row, name), 1e-3);
  });
  EXPECT_THAT(Refused(), HasSubstr("it looks as if the measured lengths are in metres"));
  EXPECT_THAT(Files(), ElementsAre("p.csv"));
}

TEST_F(Slips, ReadingsInMetres) {
  Change([](const Cells& header, Cells* row) {
    for (const char leg : {'1', '2', '3', '4', '5', '6'}) {
      Scale(&Cell(header, row, std::string("struts.q") + leg + "_mm"), 1e-3);
    }
  });
  EXPECT_THAT(Refused(), HasSubstr("it looks as if the drive readings are in metres"));
  EXPECT_THAT(Files(), ElementsAre("p.csv"));
}

TEST_F(Slips, OneColumnInAnotherUnit) {
  Change([](const Cells& header, Cells* row) { Scale(&Cell(header, row, "y_mm"), 1e-3); });
  EXPECT_THAT(Refused(), HasSubstr("it looks as if y_mm is in metres while the others are not"));
  EXPECT_THAT(Files(), ElementsAre("p.csv"));
}

TEST_F(Slips, SwappedColumns) {
  Change([](const Cells& header, Cells* row) {
    std::swap(Cell(header, row, "struts.q2_mm"), Cell(header, row, "struts.q5_mm"));
  });
  EXPECT_THAT(Refused(), HasSubstr("struts.q2_mm and struts.q5_mm are swapped"));
  EXPECT_THAT(Files(), ElementsAre("p.csv"));
}

TEST_F(Slips, OneLegsSign) {
  Change([](const Cells& header, Cells* row) { Scale(&Cell(header, row, "struts.q3_mm"), -1.0); });
  EXPECT_THAT(Refused(), HasSubstr("struts.q3_mm has the wrong sign"));
  EXPECT_THAT(Files(), ElementsAre("p.csv"));
}

TEST_F(Slips, TooFewMeasurements) {
  const std::vector<std::string> lines = Lines(Read("p.csv"));
  std::string few;
  int rows = -1;  // the header is none
  for (const std::string& line : lines) {
    if (!line.starts_with('#') && ++rows > 6) break;
    few += line + '\n';
  }
  Write("p.csv", few);
  EXPECT_THAT(Refused(), HasSubstr("36 measured numbers cannot determine 42 parameters"));
  EXPECT_THAT(Files(), ElementsAre("p.csv"));
}

TEST_F(Slips, UnitsThatDoNotFitTheirQuantities) {
  Change([](const Cells&, Cells*) {},
         [](Cells* header) {
           for (std::string& name : *header) {
             if (name == "struts.q4_mm") name = "struts.q4_deg";
             if (name == "y_mm") name = "y_rad";
           }
         });
  const std::string said = Refused();
  EXPECT_THAT(said, HasSubstr("struts.q4_deg"));
  EXPECT_THAT(said, HasSubstr("y_rad"));
  EXPECT_THAT(Files(), ElementsAre("p.csv"));
}

TEST_F(Slips, EmptyFilesAndFilesOfAHeader) {
  Write("p.csv", "");
  EXPECT_THAT(Refused(), HasSubstr("the file is empty"));
  Write("p.csv", "q1,q2,q3,q4,q5,q6,x_mm,y_mm,z_mm\n");
  EXPECT_THAT(Refused(), HasSubstr("the file has a header and no rows"));
  EXPECT_THAT(Files(), ElementsAre("p.csv"));
}

}  // namespace
}  // namespace kompono::cli_test
