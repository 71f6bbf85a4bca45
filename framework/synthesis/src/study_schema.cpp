// SPDX-License-Identifier: Apache-2.0
// StudySchema: the reader's table of keys as a JSON Schema.
#include "study_keys.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "kompono/synthesis/study.hpp"

namespace kompono::synthesis {
namespace {

using Json = nlohmann::ordered_json;

Json Numbers(int count) {
  return {
      {"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", count}, {"maxItems", count}};
}

Json ByName(Json value) {
  return {{"type", "object"}, {"additionalProperties", std::move(value)}};
}

/// A tag or a list of tags, one or two of them, or exactly two.
Json Terms(int least) {
  const Json tag{{"type", "string"}};
  const Json term{
      {"anyOf", Json::array({tag, Json{{"type", "array"}, {"items", tag}, {"minItems", 1}}})}};
  return {{"type", "array"}, {"items", term}, {"minItems", least}, {"maxItems", 2}};
}

/// A value, { levels = […] } or { range = [a, b], start = c }.
Json Values() {
  const Json levels{{"type", "object"},
                    {"properties", {{"levels", {{"type", "array"}, {"minItems", 1}}}}},
                    {"required", Json::array({"levels"})},
                    {"additionalProperties", false}};
  const Json range{{"type", "object"},
                   {"properties", {{"range", Numbers(2)}, {"start", {{"type", "number"}}}}},
                   {"required", Json::array({"range"})},
                   {"additionalProperties", false}};
  return ByName(
      {{"anyOf", Json::array({Json{{"type", "number"}}, Json{{"type", "array"}}, levels, range})}});
}

Json Modes() {
  const Json sign{{"enum", Json::array({"+", "-", 1, -1})}};
  return {{"anyOf",
           Json::array({Json{{"const", "all"}},
                        Json{{"type", "array"}, {"items", ByName(sign)}, {"minItems", 1}}})}};
}

class SchemaWriter {
 public:
  SchemaWriter(const plugin::Registry& registry, std::span<const std::string> metrics)
      : registry_(registry), metrics_(metrics) {}

  std::string Write() {
    Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                {"title", "kompono study"},
                {"description", "A space of machine layouts to search, format 1."}};
    schema.update(Table(StudyRuleOfFile()));
    return schema.dump(2) + "\n";
  }

 private:
  Json Table(const TableRule& rule) {
    Json properties = Json::object();
    Json required = Json::array();
    for (const KeyRule& key : rule.keys) {
      Json value = Value(key);
      value["description"] = key.meaning;
      if (key.required) required.push_back(key.key);
      properties[std::string(key.key)] = std::move(value);
    }
    Json table{{"type", "object"}, {"properties", std::move(properties)}};
    if (!required.empty()) table["required"] = std::move(required);
    table["additionalProperties"] = false;
    return table;
  }

  Json Value(const KeyRule& key) {
    switch (key.kind) {
      case ValueKind::kVersion:
        return {{"const", 1}};
      case ValueKind::kText:
        return key.key == "module"
                   ? Json{{"enum", registry_.ModuleIds(plugin::ModuleKind::kMechanism)}}
                   : Json{{"type", "string"}};
      case ValueKind::kWord:
        return {{"enum", key.words}};
      case ValueKind::kWords:
        return {{"type", "array"},
                {"items", {{"enum", key.words}}},
                {"minItems", 1},
                {"uniqueItems", true}};
      case ValueKind::kNumber:
        return key.positive ? Json{{"type", "number"}, {"exclusiveMinimum", 0}}
                            : Json{{"type", "number"}};
      case ValueKind::kInterval:
        return Numbers(2);
      case ValueKind::kTriple:
        return Numbers(3);
      case ValueKind::kFlag:
        return {{"type", "boolean"}};
      case ValueKind::kTexts:
        return {{"type", "array"}, {"items", {{"type", "string"}}}};
      case ValueKind::kTable:
        return Table(*key.table);
      case ValueKind::kTablesByName:
        return OfMetrics(key, ByName(Table(*key.table)));
      case ValueKind::kTableList:
        return {{"type", "array"}, {"items", Table(*key.table)}};
      case ValueKind::kWordsByName:
        return OfMetrics(key, ByName({{"enum", key.words}}));
      case ValueKind::kTextsByName:
        return ByName({{"type", "string"}});
      case ValueKind::kAnything:
        break;
    }
    return Free(key.key);
  }

  Json OfMetrics(const KeyRule& key, Json value) {
    const bool named = key.key == "objectives" || key.key == "limits";
    if (named && !metrics_.empty()) value["propertyNames"] = {{"enum", metrics_}};
    return value;
  }

  /// What the reader judges by hand.
  static Json Free(std::string_view key) {
    if (key == "forbid") return Terms(1);
    if (key == "forbid_order") return Terms(2);
    if (key == "modes") return Modes();
    if (key == "parameters" || key == "home") return Values();
    return {{"type", "object"}};
  }

  const plugin::Registry& registry_;
  std::span<const std::string> metrics_;
};

}  // namespace

std::string StudySchema(const plugin::Registry& registry, std::span<const std::string> metrics) {
  return SchemaWriter(registry, metrics).Write();
}

}  // namespace kompono::synthesis
