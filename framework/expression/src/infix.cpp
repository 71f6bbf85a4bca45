// SPDX-License-Identifier: Apache-2.0
#include "notation.hpp"
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace kompono::expression_internal {
namespace {

// How tightly text holds together; something looser than its place asks for gets brackets.
enum Level { kOr, kAnd, kComparison, kSum, kProduct, kPower, kAtom };

constexpr int64_t kMostPower = int64_t{1} << 40;

struct Power {
  Index base = -1;
  int64_t power = 1;
};

/// A product as people see it: one number, what is multiplied, what it is divided by.
struct ProductView {
  double coefficient = 1.0;
  std::vector<Power> above, below;
};

struct FunctionText {
  std::string_view before, after;
};

FunctionText TextFunction(int32_t operation) {
  switch (operation) {
    case KOMPONO_SQRT:
      return {"sqrt(", ")"};
    case KOMPONO_SIN:
      return {"sin(", ")"};
    case KOMPONO_COS:
      return {"cos(", ")"};
    case KOMPONO_TAN:
      return {"tan(", ")"};
    case KOMPONO_ASIN:
      return {"asin(", ")"};
    case KOMPONO_ACOS:
      return {"acos(", ")"};
    case KOMPONO_ATAN:
      return {"atan(", ")"};
    case KOMPONO_ATAN2:
      return {"atan2(", ")"};
    case KOMPONO_ABS:
      return {"abs(", ")"};
    case KOMPONO_EXP:
      return {"exp(", ")"};
    default:
      return {"log(", ")"};
  }
}

FunctionText LatexFunction(int32_t operation) {
  constexpr std::string_view kClose = "\\right)";
  switch (operation) {
    case KOMPONO_SQRT:
      return {"\\sqrt{", "}"};
    case KOMPONO_SIN:
      return {"\\sin\\left(", kClose};
    case KOMPONO_COS:
      return {"\\cos\\left(", kClose};
    case KOMPONO_TAN:
      return {"\\tan\\left(", kClose};
    case KOMPONO_ASIN:
      return {"\\arcsin\\left(", kClose};
    case KOMPONO_ACOS:
      return {"\\arccos\\left(", kClose};
    case KOMPONO_ATAN:
      return {"\\arctan\\left(", kClose};
    case KOMPONO_ATAN2:
      return {"\\operatorname{atan2}\\left(", kClose};
    case KOMPONO_ABS:
      return {"\\left|", "\\right|"};
    case KOMPONO_EXP:
      return {"\\exp\\left(", kClose};
    default:
      return {"\\ln\\left(", kClose};
  }
}

std::string Superscript(int64_t power) {
  constexpr std::string_view kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text;
  for (const char digit : std::to_string(power)) text += kDigits[digit - '0'];
  return text;
}

/// Writes from left to right off a stack of what is still to come, so that depth costs no program
/// stack.
class InfixWriter {
 public:
  InfixWriter(const Graph& graph,
              Index root,
              const Notation& notation,
              const VariableNames& variables,
              const PartNames& parts)
      : graph_(graph), root_(root), notation_(notation), variables_(variables), parts_(parts) {}

  std::string Run() {
    waiting_.push_back({{}, root_, kOr, false});
    while (!waiting_.empty()) {
      const Item item = std::move(waiting_.back());
      waiting_.pop_back();
      if (item.node < 0) {
        text_ += item.text;
        continue;
      }
      plan_.clear();
      PlanNode(item);
      waiting_.insert(waiting_.end(),
                      std::make_move_iterator(plan_.rbegin()),
                      std::make_move_iterator(plan_.rend()));
    }
    return std::move(text_);
  }

 private:
  struct Item {
    std::string text;  // if node is negative
    Index node = -1;
    int level = kOr;         // the loosest that needs no brackets here
    bool drop_sign = false;  // the sign was written already
  };

  void Text(std::string_view text) {
    if (!text.empty()) plan_.push_back({std::string(text), -1, kOr, false});
  }
  void Operand(Index i, int level, bool drop_sign = false) {
    plan_.push_back({{}, i, level, drop_sign});
  }
  void Open(bool brackets) {
    if (brackets) Text(notation_.latex ? "\\left(" : "(");
  }
  void Close(bool brackets) {
    if (brackets) Text(notation_.latex ? "\\right)" : ")");
  }

  [[nodiscard]] bool IsNamed(Index i) const {
    return i != root_ && !parts_.empty() && !parts_[static_cast<std::size_t>(i)].empty();
  }
  [[nodiscard]] bool IsOpen(Index i, KomponoOperation operation) const {
    return graph_.Is(i, operation) && !IsNamed(i);
  }
  [[nodiscard]] bool IsOpenSum(Index i) const {
    return IsOpen(i, KOMPONO_ADD) || IsOpen(i, KOMPONO_SUBTRACT);
  }
  [[nodiscard]] bool IsOpenProduct(Index i) const {
    return IsOpen(i, KOMPONO_MULTIPLY) || IsOpen(i, KOMPONO_DIVIDE);
  }
  [[nodiscard]] std::string Spelled(const std::string& name) const {
    return notation_.latex ? LatexName(name) : name;
  }

  void PlanNode(const Item& item) {
    const Index i = item.node;
    if (IsNamed(i)) return Text(Spelled(parts_[static_cast<std::size_t>(i)]));
    const Node& node = graph_.node(i);
    switch (node.operation) {
      case KOMPONO_VARIABLE:
        return Text(Spelled(variables_[node.operand[0]]));
      case KOMPONO_ADD:
      case KOMPONO_SUBTRACT:
        return PlanSum(item);
      case KOMPONO_CONSTANT:
      case KOMPONO_NEGATE:
      case KOMPONO_MULTIPLY:
      case KOMPONO_DIVIDE:
        return PlanProduct(item);
      case KOMPONO_SELECT:
        return PlanSelect(node);
      default:
        break;
    }
    if (GivesCondition(node.operation)) return PlanCondition(item);
    const FunctionText function =
        notation_.latex ? LatexFunction(node.operation) : TextFunction(node.operation);
    Text(function.before);
    Operand(node.operand[0], kOr);
    if (node.operation == KOMPONO_ATAN2) {
      Text(", ");
      Operand(node.operand[1], kOr);
    }
    Text(function.after);
  }

  // --- sums ---
  void PlanSum(const Item& item) {
    const bool brackets = item.level > kSum;
    Open(brackets);
    bool is_first = true;
    std::vector<std::pair<Index, bool>> terms{{item.node, false}};  // and whether subtracted
    while (!terms.empty()) {
      auto [i, negative] = terms.back();
      terms.pop_back();
      while (IsOpen(i, KOMPONO_NEGATE)) {
        i = graph_.node(i).operand[0];
        negative = !negative;
      }
      if (IsOpenSum(i) && !negative) {
        terms.emplace_back(graph_.node(i).operand[1], graph_.Is(i, KOMPONO_SUBTRACT));
        terms.emplace_back(graph_.node(i).operand[0], false);
        continue;
      }
      const bool is_product = IsOpenProduct(i) || graph_.IsConstant(i);
      if (is_product && View(i).coefficient < 0.0) negative = !negative;
      if (is_first) {
        Text(negative ? "-" : "");
      } else {
        Text(negative ? " - " : " + ");
      }
      Operand(i, negative ? kProduct : kSum, is_product);
      is_first = false;
    }
    Close(brackets);
  }

  // --- products ---
  struct Place {
    Index node;
    bool below;
    bool operator<(const Place& other) const {
      return std::tie(node, below) < std::tie(other.node, other.below);
    }
  };

  struct UsersFirst {
    bool operator()(const Place& a, const Place& b) const { return b < a; }
  };

  /// What a product's part consists of, if it is written as part of the product.
  enum class Kind { kFactor, kProduct, kFraction, kMinus, kNumber };
  [[nodiscard]] Kind KindOf(Place place, Index root) const {
    if (place.node != root && IsNamed(place.node)) return Kind::kFactor;
    switch (graph_.node(place.node).operation) {
      case KOMPONO_MULTIPLY:
        return Kind::kProduct;
      case KOMPONO_DIVIDE:
        return place.below ? Kind::kFactor : Kind::kFraction;
      case KOMPONO_NEGATE:
        return Kind::kMinus;
      case KOMPONO_CONSTANT:
        return place.below ? Kind::kFactor : Kind::kNumber;
      default:
        return Kind::kFactor;
    }
  }

  /// Each part is visited once, however often it is contained: first from users to operands for the
  /// powers, then from left to right for the order.
  [[nodiscard]] ProductView View(Index root) const {
    ProductView view;
    std::map<Place, int64_t, UsersFirst> waiting{{{root, false}, 1}};
    std::map<Place, int64_t> powers;
    while (!waiting.empty()) {
      const auto [place, power] = *waiting.begin();
      waiting.erase(waiting.begin());
      const Node& node = graph_.node(place.node);
      // Beyond all sense a product stays closed, lest the exponents overflow.
      switch (power < kMostPower ? KindOf(place, root) : Kind::kFactor) {
        case Kind::kProduct:
        case Kind::kFraction:
          waiting[{node.operand[0], place.below}] += power;
          waiting[{node.operand[1], place.below || node.operation == KOMPONO_DIVIDE}] += power;
          break;
        case Kind::kMinus:
          if (power % 2 != 0) view.coefficient = -view.coefficient;
          waiting[{node.operand[0], place.below}] += power;
          break;
        case Kind::kNumber:
          view.coefficient *= std::pow(node.value, static_cast<double>(power));
          break;
        case Kind::kFactor:
          powers[place] = power;
          break;
      }
    }
    OrderFactors(root, powers, &view);
    return view;
  }

  void OrderFactors(Index root, const std::map<Place, int64_t>& powers, ProductView* view) const {
    std::set<Place> seen;
    std::vector<Place> waiting{{root, false}};
    while (!waiting.empty()) {
      const Place place = waiting.back();
      waiting.pop_back();
      if (!seen.insert(place).second) continue;
      const Node& node = graph_.node(place.node);
      const Kind kind = KindOf(place, root);
      if (const auto factor = powers.find(place); factor != powers.end()) {
        (place.below ? view->below : view->above).push_back({place.node, factor->second});
      } else if (kind == Kind::kMinus) {
        waiting.push_back({node.operand[0], place.below});
      } else if (kind != Kind::kNumber) {
        waiting.push_back({node.operand[1], place.below || kind == Kind::kFraction});
        waiting.push_back({node.operand[0], place.below});
      }
    }
  }

  void PlanProduct(const Item& item) {
    const ProductView view = View(item.node);
    const bool minus = view.coefficient < 0.0 && !item.drop_sign;
    const double number = std::abs(view.coefficient);
    const bool shows_number = number != 1.0 || view.above.empty();
    const std::size_t pieces = view.above.size() + view.below.size() + (shows_number ? 1 : 0);
    // A lone factor, as under a minus sign, keeps the place's level; it is not a product.
    const bool is_lone = pieces == 1 && view.below.empty();
    const bool is_raised = is_lone && !view.above.empty() && view.above.front().power != 1;
    const int own_level = !is_lone ? int{kProduct} : is_raised ? int{kPower} : int{kAtom};
    const bool brackets = item.level > (minus ? int{kSum} : own_level);
    const int lone_level = brackets || minus ? int{kProduct} : item.level;
    Open(brackets);
    if (minus) Text("-");
    const bool is_fraction = notation_.latex && !view.below.empty();
    if (is_fraction) Text("\\frac{");
    if (shows_number) Text(FormatNumber(number, notation_));
    PlanFactors(view.above, shows_number, is_lone ? lone_level : int{kPower});
    if (is_fraction) {
      Text("}{");
      PlanFactors(view.below, false, view.below.size() == 1 ? kSum : kPower);
      Text("}");
    } else if (!view.below.empty()) {
      const bool is_single = view.below.size() == 1;
      Text(is_single ? "/" : "/(");
      PlanFactors(view.below, false, kPower);
      Text(is_single ? "" : ")");
    }
    Close(brackets);
  }

  /// `level` is for a factor that is not raised to a power.
  void PlanFactors(const std::vector<Power>& factors, bool after_number, int level) {
    bool is_first = true;
    for (const Power& factor : factors) {
      const int64_t repeats =
          notation_.powers == PowerStyle::kProduct && !notation_.latex && factor.power <= 8
              ? factor.power
              : 1;
      for (int64_t k = 0; k < repeats; ++k) {
        if (!is_first || after_number) Text(Times(is_first, factor.base));
        Operand(factor.base, factor.power == 1 ? level : int{kAtom});
        is_first = false;
        previous_is_letter_ = IsLetter(factor.base);
      }
      if (factor.power == 1 || repeats > 1) continue;
      if (notation_.latex) {
        Text(fmt::format("^{{{}}}", factor.power));
      } else if (notation_.powers == PowerStyle::kSuperscript) {
        Text(Superscript(factor.power));
      } else {
        Text(fmt::format("^{}", factor.power));
        previous_is_letter_ = false;  // x^2y could be read as x^(2y)
      }
    }
  }

  [[nodiscard]] bool IsLetter(Index i) const {
    if (IsNamed(i)) return parts_[static_cast<std::size_t>(i)].size() == 1;
    return graph_.Is(i, KOMPONO_VARIABLE) && variables_[graph_.node(i).operand[0]].size() == 1;
  }

  [[nodiscard]] std::string Times(bool after_number, Index right) const {
    if (notation_.latex) return " ";
    if (!notation_.times.empty()) return notation_.times;
    if (!after_number) return previous_is_letter_ && IsLetter(right) ? "" : " ";
    // 2e1 would be read as a number
    const bool starts_with_e =
        graph_.Is(right, KOMPONO_VARIABLE) &&
        std::string_view("eE").find(variables_[graph_.node(right).operand[0]][0]) !=
            std::string_view::npos;
    return starts_with_e ? " " : "";
  }

  // --- choices and conditions ---
  void PlanSelect(const Node& node) {
    Text(notation_.latex ? "\\begin{cases} " : "if(");
    Operand(node.operand[notation_.latex ? 1 : 0], kOr);
    Text(notation_.latex ? " & \\text{if } " : ", ");
    Operand(node.operand[notation_.latex ? 0 : 1], kOr);
    Text(notation_.latex ? " \\\\ " : ", ");
    Operand(node.operand[2], kOr);
    Text(notation_.latex ? " & \\text{otherwise} \\end{cases}" : ")");
  }

  void PlanCondition(const Item& item) {
    const Node& node = graph_.node(item.node);
    if (node.operation == KOMPONO_NOT) {
      Text(notation_.latex ? "\\lnot " : "not ");
      return Operand(node.operand[0], kAtom);
    }
    std::string_view sign;
    int own = kComparison;
    switch (node.operation) {
      case KOMPONO_LESS:
        sign = " < ";
        break;
      case KOMPONO_LESS_EQUAL:
        sign = notation_.latex ? " \\le " : " <= ";
        break;
      case KOMPONO_AND:
        sign = notation_.latex ? " \\land " : " and ";
        own = kAnd;
        break;
      default:
        sign = notation_.latex ? " \\lor " : " or ";
        own = kOr;
        break;
    }
    const bool brackets = item.level > own;
    Open(brackets);
    Operand(node.operand[0], own == kComparison ? int{kSum} : own);
    Text(sign);
    Operand(node.operand[1], own == kComparison ? int{kSum} : own);
    Close(brackets);
  }

  const Graph& graph_;
  Index root_;
  const Notation& notation_;
  const VariableNames& variables_;
  const PartNames& parts_;
  std::vector<Item> waiting_;
  std::vector<Item> plan_;
  std::string text_;
  bool previous_is_letter_ = false;
};

}  // namespace

std::string WriteInfix(const Graph& graph,
                       Index root,
                       const Notation& notation,
                       const VariableNames& variables,
                       const PartNames& parts) {
  return InfixWriter(graph, root, notation, variables, parts).Run();
}

}  // namespace kompono::expression_internal
