// SPDX-License-Identifier: Apache-2.0
#include "schema_judge.hpp"

#include <algorithm>
#include <regex>
#include <set>

namespace kompono::layout {
namespace {

using Json = nlohmann::json;

class Judge {
 public:
  explicit Judge(const Json& root) : root_(root) {}

  void Check(const Json& schema, const Json& instance, const std::string& where) {
    if (schema.is_boolean()) {
      if (!schema.get<bool>()) Fault(where, "must not be there");
      return;
    }
    for (const auto& [keyword, value] : schema.items()) {
      if (!CheckKeyword(keyword, value, schema, instance, where))
        Fault(where, "keyword " + keyword);
    }
  }

  std::vector<std::string> faults;

 private:
  void Fault(const std::string& where, const std::string& what) {
    faults.push_back(where + ": " + what);
  }

  bool Fits(const Json& schema, const Json& instance) {
    Judge other(root_);
    other.Check(schema, instance, "");
    return other.faults.empty();
  }

  bool CheckKeyword(const std::string& keyword,
                    const Json& value,
                    const Json& schema,
                    const Json& instance,
                    const std::string& where) {
    static const std::set<std::string> kSilent{
        "$schema", "$defs", "title", "description", "then", "properties", "patternProperties"};
    if (keyword == "$ref") {
      Check(root_.at(Json::json_pointer(value.get<std::string>().substr(1))), instance, where);
    } else if (keyword == "allOf") {
      for (const Json& part : value) Check(part, instance, where);
    } else if (keyword == "anyOf") {
      const bool any = std::any_of(
          value.begin(), value.end(), [&](const Json& part) { return Fits(part, instance); });
      if (!any) Fault(where, "fits none of anyOf");
    } else if (keyword == "if") {
      if (Fits(value, instance)) Check(schema.at("then"), instance, where);
    } else if (keyword == "const") {
      if (instance != value) Fault(where, "is not " + value.dump());
    } else if (keyword == "enum") {
      if (std::find(value.begin(), value.end(), instance) == value.end())
        Fault(where, instance.dump() + " is not one of " + value.dump());
    } else if (keyword == "type") {
      if (!HasType(instance, value)) Fault(where, "is no " + value.get<std::string>());
    } else if (instance.is_object() && CheckObject(keyword, value, schema, instance, where)) {
      return true;
    } else if (keyword == "items") {
      for (std::size_t i = 0; instance.is_array() && i < instance.size(); ++i)
        Check(value, instance[i], where + "/" + std::to_string(i));
    } else if (keyword == "minItems") {
      if (instance.is_array() && instance.size() < value.get<std::size_t>())
        Fault(where, "too few");
    } else if (keyword == "maxItems") {
      if (instance.is_array() && instance.size() > value.get<std::size_t>())
        Fault(where, "too many");
    } else if (keyword == "minimum") {
      if (instance.is_number() && instance.get<double>() < value.get<double>())
        Fault(where, "too small");
    } else if (keyword == "exclusiveMinimum") {
      if (instance.is_number() && instance.get<double>() <= value.get<double>())
        Fault(where, "too small");
    } else {
      static const std::set<std::string> kObjects{
          "required", "additionalProperties", "propertyNames", "dependentRequired"};
      return kSilent.count(keyword) != 0 || kObjects.count(keyword) != 0;
    }
    return true;
  }

  bool CheckObject(const std::string& keyword,
                   const Json& value,
                   const Json& schema,
                   const Json& instance,
                   const std::string& where) {
    if (keyword == "required") {
      for (const Json& key : value) {
        if (!instance.contains(key)) Fault(where, "has no " + key.get<std::string>());
      }
    } else if (keyword == "properties") {
      for (const auto& [key, part] : value.items()) {
        if (instance.contains(key)) Check(part, instance.at(key), where + "/" + key);
      }
    } else if (keyword == "patternProperties") {
      for (const auto& [pattern, part] : value.items()) {
        for (const auto& [key, member] : instance.items()) {
          if (std::regex_search(key, std::regex(pattern))) Check(part, member, where + "/" + key);
        }
      }
    } else if (keyword == "additionalProperties") {
      for (const auto& [key, member] : instance.items()) {
        if (!Covers(schema, key)) Check(value, member, where + "/" + key);
      }
    } else if (keyword == "propertyNames") {
      for (const auto& [key, member] : instance.items()) Check(value, Json(key), where + "/" + key);
    } else if (keyword == "dependentRequired") {
      for (const auto& [key, others] : value.items()) {
        for (const Json& other : others) {
          if (instance.contains(key) && !instance.contains(other)) Fault(where, "needs more");
        }
      }
    } else {
      return false;
    }
    return true;
  }

  static bool Covers(const Json& schema, const std::string& key) {
    if (schema.contains("properties") && schema["properties"].contains(key)) return true;
    if (!schema.contains("patternProperties")) return false;
    for (const auto& [pattern, part] : schema["patternProperties"].items()) {
      if (std::regex_search(key, std::regex(pattern))) return true;
    }
    return false;
  }

  static bool HasType(const Json& instance, const std::string& type) {
    if (type == "object") return instance.is_object();
    if (type == "array") return instance.is_array();
    if (type == "string") return instance.is_string();
    if (type == "boolean") return instance.is_boolean();
    if (type == "integer") return instance.is_number_integer();
    return type == "number" && instance.is_number();
  }

  const Json& root_;
};

}  // namespace

std::vector<std::string> Faults(const Json& schema, const Json& instance) {
  Judge judge(schema);
  judge.Check(schema, instance, "");
  return std::move(judge.faults);
}

}  // namespace kompono::layout
