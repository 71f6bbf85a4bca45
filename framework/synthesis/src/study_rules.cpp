// SPDX-License-Identifier: Apache-2.0
// [[rule]]: what a designer would not combine.
#include "study_reader.hpp"
#include <fmt/format.h>

#include <algorithm>

namespace kompono::synthesis {

void StudyReader::ReadRules() {
  const toml::node* node = root_.get("rule");
  const toml::array* list = node == nullptr ? nullptr : node->as_array();
  if (list == nullptr) return;
  for (const toml::node& element : *list) {
    if (const toml::table* table = element.as_table()) ReadRule(*table);
  }
}

void StudyReader::ReadRule(const toml::table& table) {
  StudyRule rule;
  rule.title.name = TextAt(table, "name").value_or("");
  const std::string kind = TextAt(table, "kind").value_or("");
  rule.title.kind = kind == "empirical"   ? RuleKind::kEmpirical
                    : kind == "normative" ? RuleKind::kNormative
                                          : RuleKind::kLogical;
  rule.title.reason = TextAt(table, "reason").value_or("");
  rule.title.author = TextAt(table, "author").value_or("");
  const toml::node* off = table.get("off");
  rule.off = off != nullptr && off->value_exact<bool>().value_or(false);
  const toml::node* forbid = table.get("forbid");
  const toml::node* order = table.get("forbid_order");
  rule.place = complaints_.Span(table.contains("name") ? *table.get("name") : table);
  if ((forbid == nullptr) == (order == nullptr)) {
    complaints_.Error(codes::kMissingKey,
                      rule.place,
                      "a rule needs either 'forbid' or 'forbid_order'",
                      "forbid = [\"base:open\", \"tool:X\"]");
    return;
  }
  rule.ordered = order != nullptr;
  rule.forbid =
      ReadTerms(rule.ordered ? *order : *forbid, rule.ordered ? "forbid_order" : "forbid");
  const bool taken = std::any_of(study_.rules.begin(), study_.rules.end(), [&](const auto& other) {
    return other.title.name == rule.title.name;
  });
  if (taken) {
    complaints_.Error(codes::kNameTaken,
                      rule.place,
                      fmt::format("a rule '{}' stands above already", rule.title.name));
  }
  if (!rule.forbid.empty()) study_.rules.push_back(std::move(rule));
}

std::vector<Term> StudyReader::ReadTerms(const toml::node& node, std::string_view key) {
  const toml::array* list = node.as_array();
  const std::size_t least = key == "forbid" ? 1 : 2;
  if (list == nullptr || list->size() < least || list->size() > 2) {
    complaints_.Error(
        codes::kBadRule,
        complaints_.Span(node),
        fmt::format("'{}' must be a list of {}two terms", key, least == 1 ? "one or " : ""),
        "a term is a tag, or a list of tags that must all be met");
    return {};
  }
  std::vector<Term> terms;
  for (const toml::node& element : *list) {
    Term term;
    if (const auto tag = element.value_exact<std::string>()) term.push_back(*tag);
    if (const toml::array* tags = element.as_array()) {
      for (const toml::node& tag : *tags) {
        if (auto text = tag.value_exact<std::string>()) term.push_back(std::move(*text));
      }
      if (term.size() != tags->size()) term.clear();
    }
    if (term.empty()) {
      complaints_.Error(codes::kWrongType,
                        complaints_.Span(element),
                        "a term must be a tag or a list of tags",
                        "write \"part:X\" or [\"part:X\", \"place:1\"]");
      return {};
    }
    terms.push_back(std::move(term));
  }
  return terms;
}

}  // namespace kompono::synthesis
