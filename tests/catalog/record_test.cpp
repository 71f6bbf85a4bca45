// SPDX-License-Identifier: Apache-2.0
#include "kompono/catalog/record.hpp"

#include "catalog_fixture.hpp"
#include <nlohmann/json.hpp>

#include <cmath>
#include <functional>
#include <limits>

#include <gmock/gmock.h>

namespace kompono::catalog {
namespace {

using testing::HasSubstr;

// FIPS 180-4 examples: the empty message, "abc", and the two-block message.
TEST(Sha256Of, MatchesThePublishedExamples) {
  EXPECT_EQ(Hex(Sha256Of("")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Hex(Sha256Of("abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Hex(Sha256Of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Sha256FromHex, ReadsBothCasesAndNothingElse) {
  const Sha256 digest = Sha256Of("abc");
  std::string hex = Hex(digest);
  EXPECT_EQ(Sha256FromHex(hex), digest);
  for (char& c : hex) c = static_cast<char>(std::toupper(c));
  EXPECT_EQ(Sha256FromHex(hex), digest);
  EXPECT_FALSE(Sha256FromHex(hex.substr(1)));
  hex[7] = 'g';
  EXPECT_FALSE(Sha256FromHex(hex));
}

TEST(ContentHash, ChangesWithEverythingTheLayoutStates) {
  const LayoutRecord record = Lambda();
  const std::vector<std::function<void(LayoutRecord&)>> changes = {
      [](LayoutRecord& r) { r.name += "2"; },
      [](LayoutRecord& r) { r.formula += "2"; },
      [](LayoutRecord& r) { r.blocks[0].name = "d"; },
      [](LayoutRecord& r) { r.blocks[0].module = "scara"; },
      [](LayoutRecord& r) { r.blocks.pop_back(); },
      [](LayoutRecord& r) { r.parameters[0].value = std::nextafter(1200.0, 1300.0); },
      [](LayoutRecord& r) { r.parameters[0].unit = "m"; },
      [](LayoutRecord& r) { r.parameters[0].name = "drive.L3"; },
      [](LayoutRecord& r) { r.toml += "x = 1\n"; },
      [](LayoutRecord& r) { r.content = "something else"; },
  };
  std::vector<std::string> hashes = {ContentHash(record)};
  for (const auto& change : changes) {
    LayoutRecord other = record;
    change(other);
    hashes.push_back(ContentHash(other));
  }
  std::sort(hashes.begin(), hashes.end());
  EXPECT_EQ(std::adjacent_find(hashes.begin(), hashes.end()), hashes.end());
}

TEST(ContentHash, StaysWithResultsOriginOrderOfParametersAndLineEnds) {
  const LayoutRecord record = Lambda();
  LayoutRecord other = record;
  other.metrics.clear();
  other.calibrations.clear();
  other.capabilities.clear();
  other.provenance = {};
  std::swap(other.parameters[0], other.parameters[1]);
  other.toml = "kompono = 1\r\nname = \"Lambda water-jet\"\r\n";
  EXPECT_EQ(ContentHash(other), ContentHash(record));
}

TEST(ContentHash, DoesNotConfuseNeighbouringTexts) {
  LayoutRecord a = KneeMill();
  LayoutRecord b = a;
  a.name = "ab";
  a.formula = "c";
  b.name = "a";
  b.formula = "bc";
  EXPECT_NE(ContentHash(a), ContentHash(b));
}

TEST(Check, AcceptsTheSamples) {
  for (const LayoutRecord& record : {Lambda(), KneeMill(), Hexapod()})
    EXPECT_EQ(Said(Check(record)), "");
}

TEST(Check, ReportsEverythingAtOnce) {
  LayoutRecord record = Lambda();
  record.formula = "";
  record.drives = -1;
  record.blocks[1].name = "drive";
  record.parameters[0].value = std::numeric_limits<double>::infinity();
  record.metrics[0].failure = "but it has a value";
  record.metrics[1].failure = "";
  record.calibrations[0].measurements_sha256 = "abc";
  record.calibrations[0].report_json = "{";
  record.calibrations[0].rms_after_um = std::nan("");
  record.toml = "\xff";
  EXPECT_EQ(
      Said(Check(record)),
      "layouts/machines/lambda.toml: error: the formula is empty [E0511]\n"
      "layouts/machines/lambda.toml: error: the layout file is not UTF-8 text [E0511]\n"
      "layouts/machines/lambda.toml: error: the number of drives is negative [E0511]\n"
      "layouts/machines/lambda.toml: error: block 'drive' is given twice [E0511]\n"
      "layouts/machines/lambda.toml: error: parameter 'drive.L1' is not a finite number [E0511]\n"
      "layouts/machines/lambda.toml: error: metric 'workspace_area' has a value and a failure "
      "[E0511]\n"
      "layouts/machines/lambda.toml: error: metric 'stiffness_min' has neither a value nor a "
      "reason why [E0511]\n"
      "layouts/machines/lambda.toml: error: the measurements' hash of the calibration with "
      "'lambda.csv' is not 64 "
      "hexadecimal digits [E0511]\n"
      "layouts/machines/lambda.toml: error: a residual of the calibration with 'lambda.csv' is not "
      "a finite number "
      "[E0511]\n"
      "layouts/machines/lambda.toml: error: the report of the calibration with 'lambda.csv' is not "
      "JSON [E0511]\n"
      "10 errors\n");
}

TEST(Check, RefusesBrokenUtf8InEveryShape) {
  for (const char* text :
       {"\x80", "\xc3", "\xc0\xaf", "\xe2\x82", "\xed\xa0\x80", "\xf4\x90\x80\x80", "a\xffz"}) {
    LayoutRecord record = KneeMill();
    record.name = text;
    EXPECT_THAT(Said(Check(record)), HasSubstr("not UTF-8"));
  }
  LayoutRecord record = KneeMill();
  record.name = "Фрезерный 機械 🛠";
  EXPECT_TRUE(Check(record).empty());
  record.name = std::string("a\0b", 3);
  EXPECT_FALSE(Check(record).empty()) << "SQLite would cut the name at the NUL";
}

class RecordTest : public CatalogTest {};

TEST_F(RecordTest, AnUnfitRecordKeepsTheOthersOutToo) {
  Store store = Create();
  std::vector<LayoutRecord> records = {KneeMill(), Hexapod()};
  records[1].formula = "";
  EXPECT_EQ(CodeOf(store.AddAll(records, {.layouts_per_transaction = 1})), "E0511");
  EXPECT_EQ(store.Stats()->layouts, 0);
}

TEST_F(RecordTest, JsonHoldsTheWholeEntry) {
  const nlohmann::ordered_json json = ToJson(*Filled().Show("Lambda water-jet"));
  EXPECT_EQ(json["base"], "open");
  EXPECT_EQ(json["motions"][0]["block"], "drive");
  EXPECT_EQ(json["parameters"][0]["value"], 1200.0);
  EXPECT_EQ(json["metrics"][0]["value"], nullptr);
  EXPECT_EQ(json["metrics"][0]["failure"], "no stiffness given");
  EXPECT_EQ(json["calibrations"][0]["report"]["iterations"], 6);
  EXPECT_EQ(json["provenance"]["plugins"][1]["id"], "org.kompono.units");
  EXPECT_EQ(json["toml"], Lambda().toml);
  EXPECT_EQ(json.begin().key(), "id") << "members keep their reading order";
}

}  // namespace
}  // namespace kompono::catalog
