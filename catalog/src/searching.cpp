// SPDX-License-Identifier: Apache-2.0
#include "searching.hpp"

#include "failure.hpp"
#include "guard.hpp"
#include "reading.hpp"
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>

namespace kompono::catalog {
namespace {

constexpr std::size_t kMostBytes = 1000;
constexpr std::size_t kMostWords = 32;

bool Separates(char c) {
  const auto byte = static_cast<unsigned char>(c);
  const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  return byte < 0x80 && !letter;
}

/// The words as a question in FTS5's language: each a string in quotes, so that nothing in it is an
/// operator, all of them wanted. Bytes of other alphabets count as letters here; the tokenizer
/// knows better and may find nothing in them.
Parsed<std::string> Question(std::string_view text) {
  if (text.size() > kMostBytes || !IsText(text)) {
    return Refuse("E0548",
                  "search",
                  text.size() > kMostBytes ? "the text is too long" : "the text is not UTF-8");
  }
  std::string question;
  std::size_t words = 0;
  for (std::size_t i = 0; i < text.size();) {
    if (Separates(text[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && !Separates(text[end])) ++end;
    const bool begins = end < text.size() && text[end] == '*';
    question += fmt::format(
        "{}\"{}\"{}", question.empty() ? "" : " AND ", text.substr(i, end - i), begins ? " *" : "");
    ++words;
    i = end;
  }
  if (words == 0)
    return Refuse(
        "E0548", "search", "there is no word to search for", "give words of letters or digits");
  if (words > kMostWords)
    return Refuse("E0548", "search", fmt::format("there are more than {} words", kMostWords));
  return question;
}

/// Formulas that share no feature are not worth sorting.
struct Resembling {
  std::int64_t formula = 0;
  double similarity = 0.0;
};

std::vector<std::string> ModulesOf(SQLite::Statement& query, std::int64_t layout) {
  std::vector<std::string> modules;
  query.reset();
  query.bind(1, layout);
  while (query.executeStep()) modules.push_back(query.getColumn(0).getString());
  return modules;
}

/// A text that is no formula has nothing in common with others but their modules.
std::vector<std::string> FeaturesOf(const std::string& text) {
  const Parsed<formula::Formula> formula = formula::ParseFormula(text);
  return formula ? StructureFeatures(*formula, {}) : std::vector<std::string>{"text " + text};
}

/// The most that any layout of a formula can reach, whatever its modules are: those of `wanted` are
/// taken for shared.
double MostPossible(const std::vector<std::string>& wanted, std::vector<std::string> features) {
  for (const std::string& feature : wanted) {
    if (feature.starts_with("module ")) features.push_back(feature);
  }
  std::sort(features.begin(), features.end());
  return Similarity(wanted, features);
}

using Moment = std::chrono::steady_clock::time_point;

bool Past(Moment deadline) {
  return std::chrono::steady_clock::now() >= deadline;
}

/// Nothing if the time was not enough.
std::optional<std::vector<Resembling>> ResemblingFormulas(SQLite::Database& db,
                                                          const std::vector<std::string>& wanted,
                                                          Moment deadline) {
  std::vector<Resembling> found;
  SQLite::Statement row(db, "SELECT id, text FROM formula");
  while (row.executeStep()) {
    if (Past(deadline)) return std::nullopt;
    const double similarity = MostPossible(wanted, FeaturesOf(row.getColumn(1).getString()));
    if (similarity > 0.0)
      found.push_back({.formula = row.getColumn(0).getInt64(), .similarity = similarity});
  }
  std::sort(found.begin(), found.end(), [](const Resembling& a, const Resembling& b) {
    return std::pair(-a.similarity, a.formula) < std::pair(-b.similarity, b.formula);
  });
  return found;
}

std::vector<std::string> WithModules(std::vector<std::string> features,
                                     const std::vector<std::string>& modules) {
  for (const std::string& module : modules) features.push_back("module " + module);
  std::sort(features.begin(), features.end());
  return features;
}

}  // namespace

Parsed<std::vector<SearchHit>> SearchWords(SQLite::Database& db,
                                           std::string_view text,
                                           std::int64_t limit) {
  const Parsed<std::string> question = Question(text);
  if (!question) return tl::make_unexpected(question.error());
  const Watch watch(db, {});
  std::vector<SearchHit> hits;
  try {
    SQLite::Statement row(
        db,
        "SELECT rowid, name, formula, snippet(word, -1, '[', ']', '...', 12) FROM word "
        "WHERE word MATCH ? ORDER BY bm25(word, 10.0, 4.0, 4.0, 1.0), rowid LIMIT ?");
    row.bind(1, *question);
    row.bind(2, limit > 0 ? limit : std::int64_t{-1});
    while (row.executeStep()) {
      const std::int64_t rowid = row.getColumn(0).getInt64();
      hits.push_back({.kind = rowid % 2 == 0 ? SearchHit::Kind::kLayout : SearchHit::Kind::kStudy,
                      .id = rowid / 2,
                      .name = row.getColumn(1).getString(),
                      .formula = row.getColumn(2).getString(),
                      .snippet = row.getColumn(3).getString()});
    }
  } catch (const SQLite::Exception&) {
    if (watch.Reason() == Watch::Stop::kNone) throw;
    return Refuse("E0526", "search", "stopped after 5 seconds", "give more words, or longer ones");
  }
  return hits;
}

/// Formulas first, there are fewer of them; their layouts in the order of what the formulas can
/// reach, until nothing better can come.
Parsed<std::vector<SimilarLayout>> SearchSimilar(SQLite::Database& db,
                                                 std::int64_t layout,
                                                 std::int64_t limit,
                                                 std::chrono::milliseconds deadline) {
  const Moment end = std::chrono::steady_clock::now() + deadline;
  const auto too_late = [deadline] {
    return Refuse("E0526",
                  "similar",
                  fmt::format("stopped after {} ms", deadline.count()),
                  "the catalog has too many formulas to compare; 'kompono catalog query' with a "
                  "condition on the formula finds layouts by index");
  };
  SQLite::Statement modules(db,
                            "SELECT m.name FROM layout_block AS b JOIN module AS m "
                            "ON m.id = b.module_id WHERE b.layout_id = ?");
  SQLite::Statement formula(
      db, "SELECT f.text FROM layout AS l JOIN formula AS f ON f.id = l.formula_id WHERE l.id = ?");
  formula.bind(1, layout);
  if (!formula.executeStep()) return std::vector<SimilarLayout>{};
  const std::vector<std::string> wanted =
      WithModules(FeaturesOf(formula.getColumn(0).getString()), ModulesOf(modules, layout));

  SQLite::Statement row(
      db,
      "SELECT l.id, l.name, f.text, l.content_hash FROM layout AS l JOIN formula AS f "
      "ON f.id = l.formula_id WHERE l.formula_id = ? AND l.id <> ? ORDER BY l.id");
  const auto most = static_cast<std::size_t>(std::max<std::int64_t>(limit, 1));
  std::vector<SimilarLayout> best;
  const auto resembling = ResemblingFormulas(db, wanted, end);
  if (!resembling) return too_late();
  for (const Resembling& candidate : *resembling) {
    const auto enough = [&] {
      return best.size() >= most && best.back().similarity >= candidate.similarity;
    };
    row.reset();
    row.bind(1, candidate.formula);
    row.bind(2, layout);
    std::vector<std::string> features;  // of the formula
    while (!enough() && row.executeStep()) {
      if (Past(end)) return too_late();
      const std::string text = row.getColumn(2).getString();
      if (features.empty()) features = FeaturesOf(text);
      const std::int64_t id = row.getColumn(0).getInt64();
      SimilarLayout similar{
          .id = id,
          .name = row.getColumn(1).getString(),
          .formula = text,
          .hash = Hex(DigestAt(row, 3)),
          .similarity = Similarity(wanted, WithModules(features, ModulesOf(modules, id)))};
      const auto place = std::upper_bound(
          best.begin(), best.end(), similar, [](const SimilarLayout& a, const SimilarLayout& b) {
            return a.similarity > b.similarity;
          });
      best.insert(place, std::move(similar));
      if (best.size() > most) best.pop_back();
    }
    if (enough()) break;
  }
  return best;
}

}  // namespace kompono::catalog
