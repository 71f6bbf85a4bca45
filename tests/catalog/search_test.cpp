// SPDX-License-Identifier: Apache-2.0
#include "kompono/catalog/search.hpp"

#include "catalog_fixture.hpp"
#include "study_fixture.hpp"

#include <gmock/gmock.h>

namespace kompono::catalog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class SearchTest : public CatalogTest {
 protected:
  SearchTest() : store_(Filled()) {}

  [[nodiscard]] std::vector<std::string> Names(const std::string& text) const {
    const auto hits = store_.Search(text);
    if (!hits) return {Said(hits.error())};
    std::vector<std::string> names;
    for (const SearchHit& hit : *hits) names.push_back(hit.name);
    return names;
  }

  Store store_;
};

TEST_F(SearchTest, FindsWordsWhereverTheyStand) {
  EXPECT_THAT(Names("lambda"), ElementsAre("Lambda water-jet"));
  EXPECT_THAT(Names("WATER jet"), ElementsAre("Lambda water-jet"));
  EXPECT_THAT(Names("jet_head"), ElementsAre("Lambda water-jet")) << "a module";
  EXPECT_THAT(Names("sheet"), ElementsAre("Lambda water-jet")) << "what a capability says";
  EXPECT_THAT(Names("struts"), ElementsAre("Hexapod")) << "the formula";
  EXPECT_THAT(Names("org.kompono.hexapod"), ElementsAre("Hexapod"));
  EXPECT_THAT(Names("hexa*"), ElementsAre("Hexapod"));
  EXPECT_THAT(Names("hexa"), IsEmpty());
  EXPECT_THAT(Names("lambda hexapod"), IsEmpty()) << "all words are wanted";
  EXPECT_EQ(Names("kompono").size(), 3U);
}

TEST_F(SearchTest, ShowsWhereTheWordsStand) {
  EXPECT_THAT(store_.Search("water")->front().snippet, HasSubstr("[water]"));
}

TEST_F(SearchTest, FollowsWhatIsAddedAndChanged) {
  LayoutRecord record = KneeMill();
  record.content = "the same";
  record.name = "Räderwerk";
  ASSERT_TRUE(store_.Add(record));
  EXPECT_THAT(Names("raderwerk"), ElementsAre("Räderwerk")) << "accents do not count";
  record.toml = "# now with a turret\n";
  ASSERT_TRUE(store_.Add(record));
  EXPECT_THAT(Names("turret"), ElementsAre("Räderwerk"));
  ASSERT_TRUE(store_.Add(record));
  EXPECT_THAT(Names("turret"), ElementsAre("Räderwerk")) << "once";
  EXPECT_EQ(Said(store_.Verify()->findings), "");
  Tamper("PRAGMA foreign_keys = ON; DELETE FROM layout WHERE name = 'Räderwerk'");
  EXPECT_THAT(Names("turret"), IsEmpty());
}

TEST_F(SearchTest, FindsStudiesByTheirRules) {
  ASSERT_TRUE(store_.BeginStudy(SheetStudy(100)));
  const auto hits = store_.Search("gantry sokolov");
  ASSERT_EQ(hits->size(), 1U);
  EXPECT_EQ(hits->front().kind, SearchHit::Kind::kStudy);
  EXPECT_EQ(hits->front().name, "sheet");
}

TEST_F(SearchTest, LayoutsOfAStudyAreFoundByNameOnlyOnceTheyAreAdded) {
  const std::int64_t study = *store_.BeginStudy(SheetStudy(10));
  ASSERT_TRUE(store_.AppendChunk(study, {0, 10}, EvaluatedAll({0, 10})));
  EXPECT_THAT(Names("sheet 4"), IsEmpty());
  ASSERT_TRUE(store_.Add(*Evaluated(4).layout));
  EXPECT_THAT(Names("sheet 4"), ElementsAre("sheet/4"));
  EXPECT_EQ(Said(store_.Verify()->findings), "");
}

TEST_F(SearchTest, RefusesTextsWithoutWordsOrWithTooMany) {
  for (const std::string& text : {std::string(), std::string(" -*\"() "), std::string(2000, 'x')})
    EXPECT_EQ(CodeOf(store_.Search(text)), "E0548") << text;
  std::string many;
  for (int i = 0; i < 40; ++i) many += "w ";
  EXPECT_EQ(CodeOf(store_.Search(many)), "E0548");
  EXPECT_EQ(CodeOf(store_.Search("\xff")), "E0548");
}

TEST(Structure, EqualFeaturesAreOneAndNoneZero) {
  const auto features = [](const char* text, const std::vector<std::string>& modules = {}) {
    return StructureFeatures(*formula::ParseFormula(text), modules);
  };
  const auto mill = features("part X Y Z O C_v tool");
  EXPECT_DOUBLE_EQ(Similarity(mill, features("part X Y Z O C_v tool")), 1.0);
  EXPECT_DOUBLE_EQ(Similarity(mill, {"nothing of it"}), 0.0);
  EXPECT_DOUBLE_EQ(Similarity({"a", "a", "b"}, {"a", "b", "b"}), 0.5) << "2 of 4";
  EXPECT_DOUBLE_EQ(Similarity({}, {}), 1.0);
  const double near = Similarity(mill, features("part Y X Z O C_v tool"));
  const double far = Similarity(mill, features("part O (XYZABC):struts C_v tool"));
  EXPECT_LT(near, 1.0) << "the order counts";
  EXPECT_GT(near, 0.6);
  EXPECT_LT(far, 0.5);
  EXPECT_LT(Similarity(mill, features("part X Y Z O C_v tool", {"spindle"})), 1.0);
  EXPECT_DOUBLE_EQ(Similarity(mill, features("part O (XYZABC):struts C_v tool")),
                   Similarity(features("part O (XYZABC):struts C_v tool"), mill));
}

TEST_F(SearchTest, SimilarLayoutsComeInOrder) {
  LayoutRecord twin = KneeMill();
  twin.name = "Twin";
  LayoutRecord turned = KneeMill();
  turned.name = "Turned";
  turned.formula = "part Y X Z O C_v tool";
  ASSERT_TRUE(store_.AddAll(std::vector{twin, turned}));
  const auto similar = store_.Similar("Knee mill");
  ASSERT_TRUE(similar) << Said(similar.error());
  std::vector<std::string> names;
  for (const SimilarLayout& layout : *similar) names.push_back(layout.name);
  ASSERT_EQ(names.size(), 4U);
  EXPECT_EQ(names[0], "Twin");
  EXPECT_EQ(names[1], "Turned");
  EXPECT_DOUBLE_EQ(similar->front().similarity, 1.0);
  for (std::size_t i = 1; i < similar->size(); ++i)
    EXPECT_LE((*similar)[i].similarity, (*similar)[i - 1].similarity);
  EXPECT_EQ(store_.Similar("Knee mill", 2)->size(), 2U);
  EXPECT_EQ(CodeOf(store_.Similar("Lathe")), "E0512");
  EXPECT_EQ(CodeOf(store_.Similar("Knee mill", 2, std::chrono::milliseconds(0))), "E0526");
}

TEST_F(SearchTest, TheTreeOfEveryFormulaIsKept) {
  SQLite::Database db(File().string());
  EXPECT_EQ(db.execAndGet("SELECT tree FROM formulas WHERE base = 'open'").getString(),
            R"({"left":[{"leaf":"part_xy","kind":"part"},{"group":[{"axis":"X","working":true},)"
            R"({"axis":"Y","working":true}],"block":"drive"}],"base":"open",)"
            R"("right":[{"axis":"Z","working":true},{"leaf":"P_z","kind":"process"}]})");
  EXPECT_EQ(db.execAndGet("SELECT count(*) FROM formulas WHERE tree IS NULL").getInt(), 0);
}

TEST_F(SearchTest, ExportsEverythingWithoutIdsAndTimes) {
  ASSERT_TRUE(store_.ExportAll(ExportFormat::kJson, File("all.json")));
  const std::string json = Bytes(File("all.json"));
  EXPECT_THAT(json, HasSubstr("Lambda water-jet"));
  EXPECT_THAT(json, Not(HasSubstr("added_at")));
  const auto toml = store_.ExportAll(ExportFormat::kToml, File("layouts"));
  ASSERT_TRUE(toml) << Said(toml.error());
  EXPECT_EQ(toml->files, 3);
  const std::string hash = store_.Show("Knee mill")->hash;
  EXPECT_EQ(Bytes(File("layouts") / ("knee-mill-" + hash.substr(0, 16) + ".toml")),
            KneeMill().toml);
  const auto csv = store_.ExportAll(ExportFormat::kCsv, File("tables"));
  ASSERT_TRUE(csv) << Said(csv.error());
  EXPECT_EQ(csv->layouts, 3);
  EXPECT_THAT(Bytes(File("tables") / "metrics.csv"),
              HasSubstr(",stiffness_min,,N/um,grid 50x50,no stiffness given\r\n"));
  EXPECT_EQ(CodeOf(store_.ExportAll(ExportFormat::kJson, File("no/such/folder.json"))), "E0550");
  EXPECT_EQ(CodeOf(store_.ExportAll(ExportFormat::kCsv, File("all.json"))), "E0550");
}

TEST_F(SearchTest, NamesCannotLeadOutOfTheFolder) {
  LayoutRecord record = KneeMill();
  record.name = "../../etc/passwd\n; rm";
  ASSERT_TRUE(store_.Add(record));
  ASSERT_TRUE(store_.ExportAll(ExportFormat::kToml, File("layouts")));
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(File("layouts"))) {
    EXPECT_TRUE(entry.is_regular_file());
    ++files;
  }
  EXPECT_EQ(files, 4);
}

}  // namespace
}  // namespace kompono::catalog
