// SPDX-License-Identifier: Apache-2.0
// metric.NAME in queries: what it means, which index serves it, what it must not do.
#include "catalog_fixture.hpp"
#include "study_fixture.hpp"

#include <gmock/gmock.h>

namespace kompono::catalog {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class MetricTermsTest : public CatalogTest {
 protected:
  MetricTermsTest() : store_(Filled()) {}

  [[nodiscard]] std::vector<std::string> Names(const QueryRequest& request) const {
    const Parsed<Table> table = store_.Query(request);
    if (!table) return {Said(table.error())};
    std::vector<std::string> names;
    for (const auto& row : table->rows) names.push_back(std::get<std::string>(row.front()));
    return names;
  }
  [[nodiscard]] std::string Complaint(const std::string& where) const {
    const Parsed<Table> table = store_.Query({.where = where});
    return table ? "no complaint" : Said(table.error());
  }
  [[nodiscard]] std::string Plan(const QueryRequest& request) const {
    const auto steps = store_.Explain(request);
    if (!steps) return Said(steps.error());
    std::string plan;
    for (const std::string& step : *steps) plan += step + "\n";
    return plan;
  }
  /// So many layouts that the planner has reason to use indexes.
  void Evaluate(std::int64_t candidates) {
    const std::int64_t study = *store_.BeginStudy(SheetStudy(candidates));
    ASSERT_TRUE(store_.AppendChunk(study, {0, candidates}, EvaluatedAll({0, candidates})));
  }

  Store store_;
};

TEST_F(MetricTermsTest, StandsForTheValueOfTheLayout) {
  EXPECT_THAT(Names({.where = "metric.workspace_area > 1e5", .columns = "name", .sort = "name"}),
              ElementsAre("Knee mill", "Lambda water-jet"));
  EXPECT_THAT(Names({.where = "METRIC.\"workspace_area\" between 1 and 1e5", .columns = "name"}),
              ElementsAre("Hexapod"));
  EXPECT_THAT(Names({.columns = "name, metric.workspace_area as area", .sort = "area desc"}),
              ElementsAre("Lambda water-jet", "Knee mill", "Hexapod"));
  EXPECT_THAT(Names({.columns = "name", .sort = "metric.workspace_area / drives"}),
              ElementsAre("Hexapod", "Knee mill", "Lambda water-jet"));
  const Parsed<Table> table = store_.Query(
      {.where = "id = 2", .columns = "metric.workspace_area, metric.workspace_area / 1e6 as m2"});
  EXPECT_EQ(table->columns[0].name, "metric.workspace_area");
  EXPECT_DOUBLE_EQ(std::get<double>(table->rows[0][1]), 0.24);
}

TEST_F(MetricTermsTest, LeavesOutLayoutsWithoutTheMetric) {
  EXPECT_THAT(Names({.where = "metric.stiffness_min is null", .columns = "name"}),
              ElementsAre("Lambda water-jet"))
      << "it was tried there and failed";
}

TEST_F(MetricTermsTest, WorksInsideSubSelects) {
  EXPECT_THAT(Names({.where = "metric.workspace_area = (select max(value) from metric_values where "
                              "measure in (select measure from measures where name = "
                              "'workspace_area'))",
                     .columns = "name"}),
              ElementsAre("Lambda water-jet"));
  EXPECT_THAT(Names({.where = "exists (select 1 from motions v where v.layout_id = id and v.axis = "
                              "'Z' and metric.workspace_area > 1e6)",
                     .columns = "name"}),
              ElementsAre("Lambda water-jet"));
}

TEST_F(MetricTermsTest, LeavesSomebodysOwnNameAlone) {
  EXPECT_THAT(
      Names({.where = "exists (select 1 from metrics metric where metric.layout_id = id and "
                      "metric.value > 1e6)",
             .columns = "name"}),
      ElementsAre("Lambda water-jet"));
  EXPECT_THAT(Names({.where = "name <> 'metric.workspace_area'", .columns = "name", .sort = "id"}),
              ElementsAre("Lambda water-jet", "Knee mill", "Hexapod"))
      << "in quotes it is a text";
}

TEST_F(MetricTermsTest, PointsAtAnUnknownMetric) {
  EXPECT_EQ(Complaint("drives > 2 and metric.workspace_aera > 5"),
            "where:1:23: error: no metric is called 'workspace_aera' [E0543]\n"
            " 1 | drives > 2 and metric.workspace_aera > 5\n"
            "   |                       ^~~~~~~~~~~~~~\n"
            "  help: did you mean 'workspace_area'?\n"
            "1 error\n");
  EXPECT_THAT(Complaint("metric.a > 1 or metric.b > 2"), HasSubstr("2 errors"));
  EXPECT_THAT(Complaint("metric.workspace_area > drivez"),
              AllOf(HasSubstr("where:1:25: error: no column is called 'drivez'"),
                    HasSubstr("did you mean 'drives'?")))
      << "places behind a metric are right";
}

TEST_F(MetricTermsTest, AsksWhichOfSeveralWaysIsMeant) {
  LayoutRecord record = KneeMill();
  record.metrics[0].method = "grid 9x9";
  record.metrics[0].value = 7.0;
  ASSERT_TRUE(store_.Add(record));
  EXPECT_THAT(Complaint("metric.workspace_area > 5"),
              AllOf(HasSubstr("'workspace_area' was computed in 2 ways [E0544]"),
                    HasSubstr("metric.\"workspace_area [mm2, grid 9x9]\"")));
  EXPECT_THAT(Names({.where = "metric.\"workspace_area [mm2, grid 9x9]\" > 5", .columns = "name"}),
              ElementsAre("Knee mill"));
}

TEST_F(MetricTermsTest, TheBestByThreeMetricsUseIndexesOnly) {
  Evaluate(3000);
  const QueryRequest best{.where = "metric.stiffness > 100 and metric.volume > 200 and drives = 4",
                          .columns = "name, formula, metric.stiffness",
                          .sort = "metric.stiffness desc",
                          .limit = 20};
  EXPECT_THAT(Plan(best),
              AllOf(HasSubstr("metric_by_value (measure_id=? AND value>?)"),
                    HasSubstr("SEARCH l USING INTEGER PRIMARY KEY"),
                    HasSubstr("SEARCH metric USING PRIMARY KEY (layout_id=? AND measure_id=?)"),
                    Not(HasSubstr("SCAN")),
                    Not(HasSubstr("TEMP B-TREE"))))
      << Plan(best);
  EXPECT_EQ(store_.Query(best)->rows.size(), 20U);
}

TEST_F(MetricTermsTest, LookupsOfStudiesUseIndexes) {
  Evaluate(3000);
  struct Lookup {
    const char* where;
    const char* index;
  };
  for (const auto& [where, index] :
       {Lookup{"id in (select layout_id from evaluations where study_id = 1 and candidate < 10)",
               "SEARCH e USING PRIMARY KEY (study_id=? AND candidate<?)"},
        Lookup{"exists (select 1 from evaluations where layout_id = id)",
               "evaluation_by_layout (layout_id=?)"},
        Lookup{"exists (select 1 from rules r where r.study_id = 1)",
               "SEARCH r USING PRIMARY KEY (study_id=?)"},
        Lookup{"id in (select layout_id from evaluations where study = 'sheet')",
               "study_by_name (name=?)"},
        Lookup{"exists (select 1 from evaluation_metrics where study_id = 1 and candidate = 4)",
               "SEARCH r USING PRIMARY KEY (study_id=? AND candidate=?)"}}) {
    EXPECT_THAT(Plan({.where = where, .columns = "name"}), HasSubstr(index)) << where;
  }
}

TEST_F(MetricTermsTest, NamesFromAForeignFileCannotReachTheStatement) {
  LayoutRecord record = KneeMill();
  record.name = "Odd";
  record.metrics = {
      {.name = "x\") OR 1; DROP TABLE layout; --", .value = 1.0, .unit = "'", .method = ")"}};
  ASSERT_TRUE(store_.Add(record));
  EXPECT_THAT(
      Names({.where = "metric.\"x\"\") OR 1; DROP TABLE layout; --\" = 1", .columns = "name"}),
      ElementsAre("Odd"));
  for (const char* hostile : {"metric.\"x\"; DROP TABLE layout",
                              "metric.workspace_area; DROP TABLE layout",
                              "metric.workspace_area) OR (1",
                              "metric.sqlite_schema = 1",
                              "metric.* = 1",
                              "metric.1 = 1",
                              "metric. = 1",
                              "metric.[workspace_area",
                              "metric.workspace_area.value = 1",
                              "main.metric.value > 0",
                              "(select value from metric) > 0"})
    EXPECT_THAT(Complaint(hostile), HasSubstr("error")) << hostile;
  EXPECT_TRUE(store_.Verify()->Ok());
}

}  // namespace
}  // namespace kompono::catalog
