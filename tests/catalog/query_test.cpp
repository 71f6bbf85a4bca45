// SPDX-License-Identifier: Apache-2.0
#include "kompono/catalog/query.hpp"

#include "catalog_fixture.hpp"

#include <gmock/gmock.h>

namespace kompono::catalog {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class QueryTest : public CatalogTest {
 protected:
  QueryTest() : store_(Filled()) {}

  /// First column of the answer, values as text.
  [[nodiscard]] std::vector<std::string> Names(const QueryRequest& request) const {
    const Parsed<Table> table = store_.Query(request);
    if (!table) return {Said(table.error())};
    std::vector<std::string> names;
    for (const auto& row : table->rows) names.push_back(std::get<std::string>(row.front()));
    return names;
  }
  [[nodiscard]] std::vector<std::string> Where(const std::string& where) const {
    return Names({.where = where, .columns = "name", .sort = "name"});
  }
  [[nodiscard]] std::string Complaint(const QueryRequest& request) const {
    const Parsed<Table> table = store_.Query(request);
    return table ? "no complaint" : Said(table.error());
  }
  [[nodiscard]] std::string Plan(const QueryRequest& request) const {
    const auto steps = store_.Explain(request);
    if (!steps) return Said(steps.error());
    std::string plan;
    for (const std::string& step : *steps) plan += step + "\n";
    return plan;
  }

  Store store_;
};

TEST_F(QueryTest, ChoosesLayoutsByAnExpression) {
  EXPECT_THAT(Where(""), ElementsAre("Hexapod", "Knee mill", "Lambda water-jet"));
  EXPECT_THAT(Where("rms_after_um < 100 and formula like '%(XY)%'"),
              ElementsAre("Lambda water-jet"));
  EXPECT_THAT(Where("base = 'open'"), ElementsAre("Lambda water-jet"));
  EXPECT_THAT(Where("coordinates > 3 or name glob 'Knee*'"), ElementsAre("Hexapod", "Knee mill"));
  EXPECT_THAT(Where("plugins like '%units 1.2%'"), ElementsAre("Knee mill", "Lambda water-jet"));
  EXPECT_THAT(Where("modules = 'drive=lambda, tool=jet_head'"), ElementsAre("Lambda water-jet"));
  EXPECT_THAT(Where("rms_after_um is null"), ElementsAre("Hexapod", "Knee mill"));
  EXPECT_THAT(Where("false"), ElementsAre());
}

TEST_F(QueryTest, SubSelectsReadTheOtherViews) {
  EXPECT_THAT(
      Where("id in (select layout_id from metrics where name = 'workspace_area' and value > 1e5)"),
      ElementsAre("Knee mill", "Lambda water-jet"));
  EXPECT_THAT(Where("(select value from parameters p where p.layout_id = layouts.id and p.name = "
                    "'drive.L1') = 1200"),
              ElementsAre("Lambda water-jet"));
  EXPECT_THAT(
      Where("exists (select 1 from capabilities c where c.layout_id = id and c.name = 'milling')"),
      ElementsAre("Hexapod", "Knee mill"));
}

TEST_F(QueryTest, EveryViewHasTheDocumentedColumns) {
  const std::string documentation =
      Bytes(std::filesystem::path(KOMPONO_SOURCE_DIR) / "docs/catalog.md");
  SQLite::Database db(File().string());
  SQLite::Statement column(
      db,
      "SELECT s.name, c.name FROM sqlite_schema AS s, pragma_table_info(s.name) AS c "
      "WHERE s.type = 'view' ORDER BY 1");
  int columns = 0;
  std::string view;
  std::string section;
  while (column.executeStep()) {
    if (column.getColumn(0).getString() != view) {
      view = column.getColumn(0).getString();
      const std::size_t begin = documentation.find("### `" + view + "`");
      ASSERT_NE(begin, std::string::npos) << view;
      section = documentation.substr(begin, documentation.find("\n#", begin + 1) - begin);
    }
    EXPECT_THAT(section, HasSubstr("\n| `" + column.getColumn(1).getString() + "` |")) << view;
    ++columns;
  }
  EXPECT_GT(columns, 50);
}

/// The lines of the fenced blocks between two headings of docs/catalog.md.
std::vector<std::string> Examples(const std::string& from, const std::string& to) {
  const std::string text = Bytes(std::filesystem::path(KOMPONO_SOURCE_DIR) / "docs/catalog.md");
  const std::size_t begin = text.find("## " + from);
  std::istringstream lines(text.substr(begin, text.find("## " + to, begin) - begin));
  std::vector<std::string> examples;
  bool fenced = false;
  for (std::string line; std::getline(lines, line);) {
    if (line == "```") {
      fenced = !fenced;
    } else if (fenced) {
      examples.push_back(line);
    }
  }
  return examples;
}

TEST_F(QueryTest, EveryExampleOfTheDocumentationIsAnswered) {
  LayoutRecord record = KneeMill();
  record.metrics = {{.name = "singularity_margin", .value = 0.5, .unit = "1", .method = "at home"},
                    {.name = "mobility.drive", .value = 2.0, .unit = "1", .method = "at home"}};
  ASSERT_TRUE(store_.Add(record));
  const std::vector<std::string> examples = Examples("Asking", "Searching words");
  EXPECT_EQ(examples.size(), 8U);
  for (const std::string& where : examples) {
    const Parsed<Table> table = store_.Query({.where = where});
    EXPECT_TRUE(table) << where << "\n" << (table ? "" : Said(table.error()));
  }
  EXPECT_THAT(Where(examples.back()), ElementsAre("Knee mill"));
}

TEST_F(QueryTest, SortsByExpressionsInBothDirections) {
  EXPECT_THAT(Names({.columns = "name", .sort = "coordinates desc, name"}),
              ElementsAre("Hexapod", "Knee mill", "Lambda water-jet"));
  EXPECT_THAT(Names({.columns = "name", .sort = "rms_after_um desc nulls last, length(name)"}),
              ElementsAre("Lambda water-jet", "Hexapod", "Knee mill"));
  EXPECT_THAT(Names({.columns = "name, drives * 10 as ten", .sort = "ten desc, name desc"}),
              ElementsAre("Hexapod", "Lambda water-jet", "Knee mill"))
      << "an alias can be sorted by";
}

TEST_F(QueryTest, TellsWhetherTheLimitCutRowsOff) {
  const Parsed<Table> two = store_.Query({.limit = 2});
  ASSERT_TRUE(two);
  EXPECT_EQ(two->rows.size(), 2U);
  EXPECT_TRUE(two->more);
  const Parsed<Table> three = store_.Query({.limit = 3});
  EXPECT_EQ(three->rows.size(), 3U);
  EXPECT_FALSE(three->more);
  EXPECT_EQ(store_.Query({.limit = 0})->rows.size(), 3U);
}

TEST_F(QueryTest, ChoosesColumnsWithNamesAndTypes) {
  const Parsed<Table> table =
      store_.Query({.where = "name = 'Lambda water-jet'",
                    .columns = "name, rms_before_um / rms_after_um AS gain, coordinates, name, "
                               "iif(1, null, 2) as \"the \"\"odd\"\" one\""});
  ASSERT_TRUE(table) << Said(table.error());
  std::vector<std::string> heads;
  for (const Column& column : table->columns) heads.push_back(column.name + ":" + column.type);
  EXPECT_THAT(
      heads,
      ElementsAre(
          "name:text", "gain:real", "coordinates:integer", "name_2:text", "the \"odd\" one:null"));
  EXPECT_DOUBLE_EQ(std::get<double>(table->rows[0][1]), 842.0 / 38.25);
  EXPECT_EQ(std::get<std::int64_t>(table->rows[0][2]), 3);
}

TEST_F(QueryTest, StarMeansEveryColumnOfTheView) {
  const Parsed<Table> table = store_.Query({.columns = " * "});
  ASSERT_TRUE(table) << Said(table.error());
  EXPECT_EQ(table->columns.size(), 18U);
  EXPECT_EQ(table->columns.back().name, "added_at");
}

TEST_F(QueryTest, ColumnTypesFollowTheValues) {
  const auto type = [this](const std::string& expression) {
    return store_.Query({.columns = expression + " as x"})->columns[0].type;
  };
  EXPECT_EQ(type("iif(id = 1, 1, 2.5)"), "real");
  EXPECT_EQ(type("iif(id = 1, 'one', 2.5)"), "mixed");
  EXPECT_EQ(type("iif(id = 3, 'one', 2)"), "mixed");
  EXPECT_EQ(type("iif(id = 1, null, 2)"), "integer");
}

TEST_F(QueryTest, ShowsBytesThatAreNoTextAsHexadecimal) {
  EXPECT_THAT(Names({.where = "id = 1", .columns = "x'c3ff'"}), ElementsAre("x'c3ff'"));
  EXPECT_THAT(Names({.where = "id = 1", .columns = "cast(x'61ff' as text)"}),
              ElementsAre("x'61ff'"));
}

TEST_F(QueryTest, PointsAtAnUnknownColumnAndSuggestsTheRightOne) {
  EXPECT_EQ(Complaint({.where = "rms_aftr_um < 100 and id > 0"}),
            "where:1:1: error: no column is called 'rms_aftr_um' [E0521]\n"
            " 1 | rms_aftr_um < 100 and id > 0\n"
            "   | ^~~~~~~~~~~\n"
            "  help: did you mean 'rms_after_um'?\n"
            "1 error\n");
  EXPECT_EQ(Complaint({.where = "id in (select layout_id\n  from metrics where vallue > 1)"}),
            "where:2:22: error: no column is called 'vallue' [E0521]\n"
            " 2 |   from metrics where vallue > 1)\n"
            "   |                      ^~~~~~\n"
            "  help: did you mean 'value'?\n"
            "1 error\n");
  EXPECT_THAT(Complaint({.sort = "name, nam desc"}),
              HasSubstr("sort:1:7: error: no column is called 'nam'"));
  EXPECT_THAT(Complaint({.columns = "name, формула as f"}),
              AllOf(HasSubstr("columns:1:7: error: no column is called 'формула'"),
                    HasSubstr("^~~~~~~\n")));
}

TEST_F(QueryTest, ExplainsQuotes) {
  EXPECT_THAT(Complaint({.where = "name = \"Knee mill\""}),
              AllOf(HasSubstr("where:1:8: error: no column is called 'Knee mill' [E0521]"),
                    HasSubstr("help: text stands in single quotes: 'Knee mill'")));
}

TEST_F(QueryTest, PointsAtWrongSyntax) {
  EXPECT_EQ(Complaint({.where = "coordinates > > 3"}),
            "where:1:15: error: near \">\": syntax error [E0520]\n"
            " 1 | coordinates > > 3\n"
            "   |               ^\n"
            "1 error\n");
  EXPECT_EQ(Complaint({.where = "coordinates >"}),
            "where:1:14: error: the expression ends too early [E0520]\n"
            " 1 | coordinates >\n"
            "   |              ^\n"
            "1 error\n");
  EXPECT_THAT(Complaint({.where = "id", .columns = "name,,id"}),
              HasSubstr("columns:1:6: error: something is missing"));
  EXPECT_THAT(Complaint({.sort = "name,"}), HasSubstr("sort:1:6: error: something is missing"));
  EXPECT_THAT(Complaint({.where = "where id = 1"}),
              HasSubstr("'where' is put there by the program"));
}

TEST_F(QueryTest, ReportsTheFaultsOfAllTextsAtOnce) {
  EXPECT_THAT(Complaint({.where = "name = 'open", .columns = "name;", .sort = "(id"}),
              AllOf(HasSubstr("where:1:8"),
                    HasSubstr("columns:1:5"),
                    HasSubstr("sort:1:1"),
                    HasSubstr("3 errors")));
}

TEST_F(QueryTest, SuggestsViewsAndFunctions) {
  EXPECT_THAT(Complaint({.where = "id in (select layout_id from metric_s)"}),
              AllOf(HasSubstr("where:1:30: error: no view is called 'metric_s' [E0522]"),
                    HasSubstr("did you mean 'metrics'?")));
  EXPECT_THAT(Complaint({.where = "lenght(name) > 3"}),
              AllOf(HasSubstr("where:1:1: error: no function is called 'lenght'"),
                    HasSubstr("did you mean 'length'?")));
  EXPECT_THAT(Complaint({.where = "length(name, 3) > 3"}), HasSubstr("wrong number of arguments"));
}

TEST_F(QueryTest, ReportsWhatCannotBeComputed) {
  EXPECT_THAT(Complaint({.where = "abs(-9223372036854775807 - id) > 0"}),
              HasSubstr("the expression cannot be computed: integer overflow [E0528]"));
}

TEST_F(QueryTest, SeesWhatWasAddedMeanwhile) {
  EXPECT_EQ(Where("").size(), 3U);
  LayoutRecord record = KneeMill();
  record.name = "Another";
  ASSERT_TRUE(store_.Add(record));
  EXPECT_EQ(Where("").size(), 4U);
}

TEST_F(QueryTest, ReadsCatalogsWithLongReports) {
  LayoutRecord record = KneeMill();
  Calibration calibration = Lambda().calibrations[0];
  calibration.report_json = "[\"" + std::string(2'000'000, 'r') + "\"]";
  record.calibrations = {calibration};
  record.toml += "# " + std::string(2'000'000, 't') + "\n";
  record.name = "Long";
  ASSERT_TRUE(store_.Add(record));
  EXPECT_THAT(Where("id in (select layout_id from calibrations where status = 'converged' and "
                    "added_at > '2000')"),
              ElementsAre("Lambda water-jet", "Long"))
      << "texts longer than a query may make are not in its way";
}

TEST_F(QueryTest, MainLookupsUseAnIndex) {
  struct Lookup {
    const char* where;
    const char* index;
  };
  const Lookup lookups[] = {
      {"id = 3", "SEARCH l USING INTEGER PRIMARY KEY"},
      {"name = 'Hexapod'", "SEARCH l USING INDEX layout_by_name"},
      {"formula = 'part X O tool'", "SEARCH l USING INDEX layout_by_formula"},
      {"distribution = 'd'", "SEARCH f USING INDEX formula_by_distribution"},
      {"relative_motion = 'r'", "SEARCH f USING INDEX formula_by_relative_motion"},
      {"rms_after_um < 100", "SEARCH l USING INDEX layout_by_rms_after"},
      {"rms_after_um between 10 and 100", "SEARCH l USING INDEX layout_by_rms_after"},
      {"id in (select layout_id from metrics where name = 'a' and value > 5)",
       "INDEX metric_by_value"},
      {"id in (select layout_id from modules where module = 'm')", "INDEX layout_block_by_module"},
      {"id in (select layout_id from capabilities where name = 'c')", "INDEX capability_by_name"},
      {"(select max(value) from parameters where layout_id = id and name = 'p') > 1",
       "SEARCH r USING PRIMARY KEY"},
  };
  for (const auto& [where, index] : lookups)
    EXPECT_THAT(Plan({.where = where}), HasSubstr(index)) << where;
}

TEST_F(QueryTest, MainLookupsScanNoLargeTable) {
  for (const char* where :
       {"id = 3",
        "name = 'Hexapod'",
        "formula = 'f'",
        "rms_after_um < 100",
        "id in (select layout_id from metrics where name = 'a' and value > 5)"}) {
    EXPECT_THAT(Plan({.where = where, .columns = "name, formula, rms_after_um"}),
                AllOf(Not(HasSubstr("SCAN l")), Not(HasSubstr("SCAN r"))))
        << where;
  }
  EXPECT_THAT(Plan({.where = "base = 'open' and program_version = 'x'", .columns = "name"}),
              HasSubstr("SCAN"))
      << "the check above would notice a scan";
}

TEST_F(QueryTest, TheBestByResidualNeedNoSorting) {
  EXPECT_THAT(Plan({.where = "rms_after_um < 100", .columns = "name", .sort = "rms_after_um"}),
              AllOf(HasSubstr("layout_by_rms_after"), Not(HasSubstr("TEMP B-TREE"))));
}

}  // namespace
}  // namespace kompono::catalog
