// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_SPACE_HPP_
#define KOMPONO_SYNTHESIS_SPACE_HPP_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// A morphological space: features in a fixed order, each with alternatives, and for every pair of
/// alternatives of different features whether they go together. A selection takes one alternative
/// of each feature; it is a candidate if all its pairs are allowed.
///
///     Space space;
///     space.Add({.name = "base", .alternatives = {{.name = "closed"}, {.name = "open"}}});
///     …
///     const Enumeration all(space);
///     for (Count i = 0; i < all.count(); ++i) Look(all.Unrank(i));
///
/// Candidates are numbered in lexicographic order of the features: the index of a candidate depends
/// on the space and what is fixed or switched off, and on nothing else.
namespace kompono::synthesis {

/// Exact up to 2^128 - 2; what is more stays at kTooMany.
__extension__ using Count = unsigned __int128;
inline constexpr Count kTooMany = ~Count{0};
/// Sums and products that stay at kTooMany.
[[nodiscard]] Count SumOf(Count a, Count b);
[[nodiscard]] Count ProductOf(Count a, Count b);
/// Decimal digits; "2^128 or more" for kTooMany.
[[nodiscard]] std::string CountText(Count count);
/// As CountText in groups of three digits: "79,900".
[[nodiscard]] std::string GroupedText(Count count);
/// No value for what is no decimal number below 2^128 - 1.
[[nodiscard]] std::optional<Count> ParseCount(std::string_view digits);

/// Why a pair is forbidden. Logical: contradicts itself or cannot be built. Empirical: experience
/// says so. Normative: a standard or a decision; the kind most often switched off.
enum class RuleKind { kLogical, kEmpirical, kNormative };
[[nodiscard]] std::string_view NameOf(RuleKind kind);

struct RuleTitle {
  std::string name;
  RuleKind kind = RuleKind::kLogical;
  std::string reason = {};
  std::string author = {};
  /// Part of what the features mean (one place for each item, …): it cannot be switched off and
  /// Explain does not ask what would be without it.
  bool structural = false;
};

struct Alternative {
  std::string name;
  std::vector<std::string> tags = {};
  [[nodiscard]] bool Has(std::string_view tag) const;
};

struct Feature {
  std::string name;
  std::vector<Alternative> alternatives = {};
  /// The alternative of that name; -1 if there is none.
  [[nodiscard]] int Find(std::string_view alternative) const;
};

/// Alternative `alternative` of feature `feature`, counted from 0.
struct Choice {
  int feature = 0;
  int alternative = 0;
  bool operator==(const Choice&) const = default;
  bool operator<(const Choice& other) const {
    return feature != other.feature ? feature < other.feature : alternative < other.alternative;
  }
};

/// One alternative's number for each feature.
using Selection = std::vector<std::uint16_t>;

/// For some features the alternatives that are let through.
using Fixing = std::vector<Choice>;

class Space {
 public:
  /// The feature's number. At least one alternative, at most 65535.
  int Add(Feature feature);
  /// The rule's number.
  int Add(RuleTitle rule);
  /// Alternatives of different features; the pair may be forbidden by several rules.
  void Forbid(Choice a, Choice b, int rule);
  /// The alternative itself.
  void Forbid(Choice a, int rule);

  [[nodiscard]] const std::vector<Feature>& features() const { return features_; }
  [[nodiscard]] const std::vector<RuleTitle>& rules() const { return rules_; }
  [[nodiscard]] int Find(std::string_view feature) const;  ///< -1 if there is none

  /// A pair that a rule forbids; first < second, equal for an alternative itself.
  struct Conflict {
    Choice first, second;
    int rule = 0;
    bool operator==(const Conflict&) const = default;
  };
  /// As they were added; the same may stand there twice.
  [[nodiscard]] const std::vector<Conflict>& conflicts() const { return conflicts_; }

  void SwitchOff(int rule, bool off = true);  ///< @throws std::logic_error if it is structural
  [[nodiscard]] bool off(int rule) const { return off_[static_cast<std::size_t>(rule)]; }

  /// Selections without any rule.
  [[nodiscard]] Count Raw() const;
  /// Decimal logarithm of that, also where Raw() is kTooMany.
  [[nodiscard]] double RawLog10() const;

 private:
  std::vector<Feature> features_;
  std::vector<RuleTitle> rules_;
  std::vector<bool> off_;
  std::vector<Conflict> conflicts_;
};

struct EnumerationOptions {
  /// Nodes of the decision diagram. What does not fit is counted depth-first; counts and indices
  /// stay the same.
  std::size_t most_nodes = std::size_t{1} << 20U;
};

/// A space compiled for counting and walking. Immutable: may be used by several threads.
class Enumeration {
 public:
  /// `fixed`: several choices of one feature let all of them through.
  explicit Enumeration(const Space& space,
                       const Fixing& fixed = {},
                       EnumerationOptions options = {});
  Enumeration(const Enumeration&) = delete;
  Enumeration& operator=(const Enumeration&) = delete;
  Enumeration(Enumeration&&) noexcept;
  Enumeration& operator=(Enumeration&&) noexcept;
  ~Enumeration();

  [[nodiscard]] Count count() const;
  /// Nodes of the decision diagram, and whether it holds the whole space.
  [[nodiscard]] std::size_t nodes() const;
  [[nodiscard]] bool whole() const;

  /// The candidate with this index. @throws std::logic_error unless index < count() < kTooMany.
  [[nodiscard]] Selection Unrank(Count index) const;
  /// Its index, or nothing if it is no candidate.
  [[nodiscard]] std::optional<Count> Rank(const Selection& selection) const;

  /// Calls `visit(index, selection)` for the candidates [begin, end) in order, until it returns
  /// false. The selection is valid during the call only.
  using Visitor = std::function<bool(Count index, const Selection& selection)>;
  void Visit(Count begin, Count end, const Visitor& visit) const;
  void VisitAll(const Visitor& visit) const { Visit(0, count(), visit); }

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The number of candidates by depth-first search alone, without a diagram.
[[nodiscard]] Count CountDepthFirst(const Space& space, const Fixing& fixed = {});

/// What a rule or a forbidden pair costs.
struct RuleEffect {
  int rule = 0;
  std::size_t pairs = 0;  ///< that it forbids
  Count gained = 0;       ///< candidates more if it alone were switched off
};
struct PairEffect {
  Space::Conflict pair;
  Count gained = 0;  ///< candidates more if this pair alone were allowed
};
struct Effects {
  Count raw = 0;
  Count structural = 0;           ///< candidates under the structural rules alone
  Count count = 0;                ///< under all rules that are not off
  std::vector<RuleEffect> rules;  ///< those that are not structural nor off, most gained first
  std::vector<PairEffect> pairs;  ///< of these rules, most gained first, at most `most_pairs`
};
[[nodiscard]] Effects Explain(const Space& space,
                              const Fixing& fixed = {},
                              std::size_t most_pairs = 10);

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_SPACE_HPP_
