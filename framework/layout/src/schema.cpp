// SPDX-License-Identifier: Apache-2.0
// LayoutSchema: the reader's table of keys and the modules' descriptions as a JSON Schema.
#include "keys.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cctype>
#include <map>

#include "kompono/layout/layout.hpp"

namespace kompono::layout {
namespace {

using Json = nlohmann::ordered_json;
using plugin::ModuleDescription;
using plugin::ParameterDescription;
using plugin::ParameterShape;

std::string_view UnitWords(Quantity quantity) {
  switch (quantity) {
    case Quantity::kLength:
      return "unit of length of the file, mm by default";
    case Quantity::kAngle:
      return "unit of angle of the file, deg by default";
    case Quantity::kByLetter:
      return "unit of length or angle of the file";
    case Quantity::kSpeed:
      return "per minute, mm/min or deg/min by default";
    case Quantity::kAcceleration:
      return "per second squared, mm/s² or deg/s² by default";
    case Quantity::kStiffness:
      return "N/µm, of rotary drives N·m/rad";
    case Quantity::kNone:
      break;
  }
  return "";
}

Json Numbers(std::size_t count) {
  return {
      {"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", count}, {"maxItems", count}};
}

Json ByName(Json value) {
  return {{"type", "object"}, {"additionalProperties", std::move(value)}};
}

class SchemaWriter {
 public:
  explicit SchemaWriter(const plugin::Registry& registry) : registry_(registry) {}

  std::string Write() {
    Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                {"title", "kompono layout"},
                {"description", "A machine tool composed of mechanism plugins, format 1."}};
    schema.update(Table(FileRule()));
    Json definitions = Json::object();
    for (const auto& [name, definition] : definitions_) definitions[name] = definition;
    schema["$defs"] = std::move(definitions);
    return schema.dump(2) + "\n";
  }

 private:
  Json Table(const TableRule& rule) {
    Json properties = Json::object();
    Json patterns = Json::object();
    Json required = Json::array();
    for (const KeyRule& key : rule.keys) {
      Json value = Value(key, rule);
      value["description"] = Description(key);
      if (key.required) required.push_back(key.key);
      if (key.numbered) {
        patterns[fmt::format("^{}[0-9]*$", key.key)] = std::move(value);
      } else {
        properties[std::string(key.key)] = std::move(value);
      }
    }
    Json table{{"type", "object"}, {"properties", std::move(properties)}};
    if (!patterns.empty()) table["patternProperties"] = std::move(patterns);
    if (!required.empty()) table["required"] = std::move(required);
    table["additionalProperties"] = rule.open;
    return table;
  }

  static std::string Description(const KeyRule& key) {
    const std::string_view unit = UnitWords(key.quantity);
    return unit.empty() ? std::string(key.meaning) : fmt::format("{} ({})", key.meaning, unit);
  }

  Json Value(const KeyRule& key, const TableRule& table) {
    switch (key.kind) {
      case ValueKind::kVersion:
        return {{"const", 1}};
      case ValueKind::kText:
        return key.key == "module" ? ModuleChoice(table) : Json{{"type", "string"}};
      case ValueKind::kWord:
        return {{"enum", key.words}};
      case ValueKind::kNumber:
        return Number(key);
      case ValueKind::kInterval:
        return Numbers(2);
      case ValueKind::kTriple:
        return Numbers(3);
      case ValueKind::kSign:
        return Sign();
      case ValueKind::kFlag:
        return {{"type", "boolean"}};
      case ValueKind::kIndex:
        return {{"type", "integer"}, {"minimum", 0}};
      case ValueKind::kTexts:
        return {{"type", "array"}, {"items", {{"type", "string"}}}};
      case ValueKind::kTable:
        return Reference(*key.table);
      case ValueKind::kTablesByName:
        return ByName(Reference(*key.table));
      case ValueKind::kNumbersByName:
        return ByName(Number(key));
      case ValueKind::kIntervalsByName:
        return ByName(Numbers(2));
      case ValueKind::kSignsByName:
        return ByName(Sign());
      case ValueKind::kParameters:
        return {{"type", "object"}};
      case ValueKind::kAnything:
        break;
    }
    return Json::object();
  }

  static Json Number(const KeyRule& key) {
    Json number{{"type", "number"}};
    if (key.positive) number["exclusiveMinimum"] = 0;
    return number;
  }
  static Json Sign() { return {{"enum", Json::array({"+", "-", 1, -1})}}; }

  /// Tables that modules fill further are known by their keys, so that a new kind of table needs no
  /// change here.
  static std::optional<plugin::ModuleKind> KindOf(const TableRule& rule) {
    if (rule.Find("module") == nullptr) return std::nullopt;
    return rule.Find("station") != nullptr ? plugin::ModuleKind::kUnit
                                           : plugin::ModuleKind::kMechanism;
  }

  Json ModuleChoice(const TableRule& table) {
    return {{"enum", registry_.ModuleIds(*KindOf(table))}};
  }

  Json Reference(const TableRule& rule) {
    const std::string name = DefinitionName(rule.title);
    if (definitions_.count(name) == 0) {
      definitions_[name] = Json::object();
      Json table = Table(rule);
      if (const auto kind = KindOf(rule)) AddModules(*kind, table);
      definitions_[name] = std::move(table);
    }
    return {{"$ref", "#/$defs/" + name}};
  }

  /// "[block.<name>.drive.<drive>]" is "block.drive".
  static std::string DefinitionName(std::string_view title) {
    std::string name;
    bool placeholder = false;
    for (const char c : title) {
      if (c == '<' && !name.empty() && name.back() == '.') name.pop_back();
      if (c == '<' || c == '>') placeholder = c == '<';
      const bool kept = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
      if (kept && !placeholder) name += c;
      if (c == ',') name += '_';
    }
    return name;
  }

  void AddModules(plugin::ModuleKind kind, Json& table) {
    Json cases = Json::array();
    for (const ModuleDescription& module : registry_.modules()) {
      if (module.kind == kind) cases.push_back(Case(module));
    }
    table["allOf"] = std::move(cases);
    if (kind != plugin::ModuleKind::kUnit) return;
    for (const char* key : {"parameters", "station", "state"})
      table["dependentRequired"][key] = Json::array({"module"});
  }

  Json Case(const ModuleDescription& module) {
    const Json condition{{"properties", {{"module", {{"const", module.id}}}}},
                         {"required", Json::array({"module"})}};
    Json then = Json::object();
    Json required = Json::array();
    then["properties"]["parameters"] = Parameters(module, required);
    if (module.kind == plugin::ModuleKind::kMechanism) {
      then["properties"]["mode"] = Names(module.modes);
      then["properties"]["drive"] = Names(module.drives);
    } else if (!module.stations.empty()) {
      then["properties"]["station"] = {{"enum", module.stations}};
    }
    if (!required.empty()) {
      then["properties"]["parameters"]["required"] = std::move(required);
      then["required"] = Json::array({"parameters"});
    }
    return {{"if", condition}, {"then", std::move(then)}};
  }

  template <class Description>
  static Json Names(const std::vector<Description>& list) {
    Json names = Json::array();
    for (const Description& item : list) names.push_back(item.name);
    return {{"propertyNames", {{"enum", std::move(names)}}}};
  }

  static Json Parameters(const ModuleDescription& module, Json& required) {
    Json properties = Json::object();
    for (const ParameterDescription& parameter : module.parameters) {
      if (parameter.fixed) continue;
      Json value = Parameter(parameter);
      value["description"] = Meaning(parameter);
      properties[parameter.name] = std::move(value);
      if (parameter.default_value.empty()) required.push_back(parameter.name);
    }
    return {
        {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  }

  static Json Parameter(const ParameterDescription& parameter) {
    const auto count = static_cast<std::size_t>(parameter.count);
    switch (parameter.shape) {
      case ParameterShape::kNumber:
        return {{"type", "number"}};
      case ParameterShape::kNumbers:
        return {{"anyOf", Json::array({Json{{"type", "number"}}, Numbers(count)})}};
      case ParameterShape::kPoint:
        return Numbers(3);
      case ParameterShape::kPoints:
        break;
    }
    return {{"type", "array"}, {"items", Numbers(3)}, {"minItems", count}, {"maxItems", count}};
  }

  /// Limits are told in words: the file's units decide which numbers they are.
  static std::string Meaning(const ParameterDescription& parameter) {
    std::string text = parameter.meaning;
    if (parameter.lower && parameter.upper) {
      text +=
          fmt::format(" ({:.6g} to {:.6g} {})", *parameter.lower, *parameter.upper, parameter.unit);
    } else if (parameter.unit != "1") {
      text += fmt::format(" ({} by default)", parameter.unit);
    }
    return text;
  }

  const plugin::Registry& registry_;
  std::map<std::string, Json> definitions_;
};

}  // namespace

std::string LayoutSchema(const plugin::Registry& registry) {
  return SchemaWriter(registry).Write();
}

}  // namespace kompono::layout
