// SPDX-License-Identifier: Apache-2.0
#include "schema_judge.hpp"
#include "shipped_registry.hpp"

#include <filesystem>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <toml++/toml.h>

namespace kompono::layout {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::IsSupersetOf;

using Json = nlohmann::json;

const Json& Schema() {
  static const Json schema = Json::parse(LayoutSchema(ShippedRegistry()));
  return schema;
}

Json FromToml(const std::string& text) {
  std::ostringstream json;
  json << toml::json_formatter{toml::parse(text)};
  return Json::parse(json.str());
}

std::vector<std::string> FaultsOf(const std::string& text) {
  return Faults(Schema(), FromToml(text));
}

TEST(LayoutSchema, AcceptsEveryShippedMachine) {
  for (const std::string& file : TomlFilesIn("layouts/machines"))
    EXPECT_THAT(FaultsOf(ReadText(file)), IsEmpty()) << file;
}

TEST(LayoutSchema, AcceptsACalibratedMachine) {
  const auto layout = ReadLayout("layouts/machines/so_waterjet_lambda.toml", ShippedRegistry());
  ASSERT_TRUE(layout);
  const auto text = ReplaceNumbers(
      *layout, ShippedRegistry(), {{"drive.L1", 1199, 0.1}, {"drive.q1.zero", 1, {}}}, "m.csv");
  ASSERT_TRUE(text);
  EXPECT_THAT(FaultsOf(*text), IsEmpty());
}

// What the reader refuses for its keys, types, counts, words and modules, the schema refuses too;
// what only the formula or a comparison of numbers can tell is left to the reader.
TEST(LayoutSchema, RefusesWhatTheReaderRefusesForItsForm) {
  for (const char* name : {"unknown_keys",
                           "missing_keys",
                           "newer_format",
                           "wrong_types",
                           "wrong_counts",
                           "missing_parameters",
                           "unknown_module",
                           "disabled_plugin",
                           "wrong_kind",
                           "fixed_parameter",
                           "unknown_parameter",
                           "bad_modes",
                           "unknown_drive",
                           "unknown_station",
                           "unknown_words",
                           "parameters_without_module",
                           "mistyped_tables",
                           "everything"}) {
    EXPECT_FALSE(FaultsOf(ReadText(std::string("layouts/bad/") + name + ".toml")).empty()) << name;
  }
}

TEST(LayoutSchema, NamesThePlaceOfAFault) {
  EXPECT_THAT(FaultsOf("kompono = 1\nformula = \"part X O tool\"\n[axis.X]\nspeed = -1\n"),
              ElementsAre("/axis/X/speed: too small"));
  EXPECT_THAT(FaultsOf("kompono = 1\nformula = \"X O\"\n[tool7]\nstat = 1\n"),
              ElementsAre("/tool7/stat: must not be there"));
}

TEST(LayoutSchema, OffersTheModulesOfTheRegistry) {
  const std::vector<std::string> mechanisms =
      Schema()["$defs"]["block"]["properties"]["module"]["enum"];
  EXPECT_THAT(mechanisms, IsSupersetOf({"hexapod", "lambda", "linear_delta"}));
  EXPECT_EQ(mechanisms, ShippedRegistry().ModuleIds(plugin::ModuleKind::kMechanism));
}

TEST(SchemaJudge, NoticesAKeywordItDoesNotKnow) {
  EXPECT_THAT(Faults(Json::parse(R"({"type": "object", "maxProperties": 1})"), Json::object()),
              ElementsAre(": keyword maxProperties"));
}

}  // namespace
}  // namespace kompono::layout
