// SPDX-License-Identifier: Apache-2.0
#include "notation.hpp"
#include "pool.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "kompono/expression/printing.hpp"

namespace kompono {
namespace {

using expression_internal::Access;
using expression_internal::GivesCondition;
using expression_internal::Graph;
using expression_internal::Index;
using expression_internal::IsFunction;
using expression_internal::Local;
using expression_internal::Node;
using expression_internal::OperandCount;
using expression_internal::UseCounts;
using expression_internal::VariableNames;

// Longer statements are broken up, for readers and for compilers' limits on nested brackets.
constexpr uint32_t kMostInOneStatement = 24;

constexpr std::array<std::string_view, 37> kKeywords = {
    "auto",     "break",  "case",   "char",     "const",    "continue", "default",  "do",
    "double",   "else",   "enum",   "extern",   "float",    "for",      "goto",     "if",
    "inline",   "int",    "long",   "register", "restrict", "return",   "short",    "signed",
    "sizeof",   "static", "struct", "switch",   "typedef",  "union",    "unsigned", "void",
    "volatile", "while",  "in",     "out",      "main"};

std::string_view CFunction(int32_t operation) {
  constexpr std::array<std::string_view, 11> kNames = {
      "sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "fabs", "exp", "log"};
  return kNames[static_cast<std::size_t>(operation - KOMPONO_SQRT)];
}

/// Shortest digits that read back as the same number, always recognisable as floating point.
std::string CNumber(double value) {
  if (std::isnan(value)) return "NAN";
  if (std::isinf(value)) return value < 0 ? "-INFINITY" : "INFINITY";
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

// How tightly C holds text together.
enum Level { kChoice, kOr, kAnd, kComparison, kSum, kProduct, kUnary };

/// Writes the operations exactly as they stand in the graph, so that C computes bit by bit what
/// Evaluate does.
class CWriter {
 public:
  CWriter(const Graph& graph, std::vector<std::string> variables, std::vector<std::string> parts)
      : graph_(graph), variables_(std::move(variables)), parts_(std::move(parts)) {}

  /// The text of node `root`, in which named nodes other than itself are names.
  std::string Write(Index root) {
    text_.clear();
    waiting_.push_back({{}, root, kChoice});
    while (!waiting_.empty()) {
      const Item item = std::move(waiting_.back());
      waiting_.pop_back();
      if (item.node < 0) {
        text_ += item.text;
        continue;
      }
      plan_.clear();
      if (item.node != root && !parts_[static_cast<std::size_t>(item.node)].empty()) {
        text_ += parts_[static_cast<std::size_t>(item.node)];
      } else {
        PlanNode(item.node, item.level);
      }
      waiting_.insert(waiting_.end(),
                      std::make_move_iterator(plan_.rbegin()),
                      std::make_move_iterator(plan_.rend()));
    }
    return text_;
  }

 private:
  struct Item {
    std::string text;
    Index node = -1;
    int level = kChoice;
  };

  void Text(std::string_view text) { plan_.push_back({std::string(text), -1, kChoice}); }
  void Operand(Index i, int level) { plan_.push_back({{}, i, level}); }

  void Binary(const Node& node, std::string_view sign, int left, int right, bool brackets) {
    if (brackets) Text("(");
    Operand(node.operand[0], left);
    Text(sign);
    Operand(node.operand[1], right);
    if (brackets) Text(")");
  }

  void PlanNode(Index i, int level) {
    const Node& node = graph_.node(i);
    switch (node.operation) {
      case KOMPONO_CONSTANT: {
        const std::string number = CNumber(node.value);
        return Text(number.front() == '-' && level > kProduct ? "(" + number + ")" : number);
      }
      case KOMPONO_VARIABLE:
        return Text(variables_[static_cast<std::size_t>(i)]);
      case KOMPONO_ADD:
        return Binary(node, " + ", kSum, kProduct, level > kSum);
      case KOMPONO_SUBTRACT:
        return Binary(node, " - ", kSum, kProduct, level > kSum);
      case KOMPONO_MULTIPLY:
        return Binary(node, " * ", kProduct, kUnary, level > kProduct);
      case KOMPONO_DIVIDE:
        return Binary(node, " / ", kProduct, kUnary, level > kProduct);
      case KOMPONO_NEGATE:
        Text(level > kSum ? "(-" : "-");
        Operand(node.operand[0], kUnary);
        return Text(level > kSum ? ")" : "");
      case KOMPONO_LESS:
        return Binary(node, " < ", kSum, kSum, level > kComparison);
      case KOMPONO_LESS_EQUAL:
        return Binary(node, " <= ", kSum, kSum, level > kComparison);
      case KOMPONO_AND:
        return Binary(node, " && ", kAnd, kComparison, level > kAnd);
      case KOMPONO_OR:  // its operands in brackets: compilers warn about a bare && inside ||
        return Binary(node, " || ", kComparison, kComparison, level > kOr);
      case KOMPONO_NOT:
        Text("!");
        return Operand(node.operand[0], kUnary);
      case KOMPONO_SELECT:
        Text("(");
        Operand(node.operand[0], kOr);
        Text(" ? ");
        Operand(node.operand[1], kOr);
        Text(" : ");
        Operand(node.operand[2], kOr);
        return Text(")");
      default:
        Text(CFunction(node.operation));
        Text("(");
        Operand(node.operand[0], kChoice);
        if (node.operation == KOMPONO_ATAN2) {
          Text(", ");
          Operand(node.operand[1], kChoice);
        }
        return Text(")");
    }
  }

  const Graph& graph_;
  std::vector<std::string> variables_;  // by node
  std::vector<std::string> parts_;      // by node
  std::vector<Item> waiting_;
  std::vector<Item> plan_;
  std::string text_;
};

/// The C identifier nearest to `name` that is not among `taken`, which it joins.
std::string Identifier(const std::string& name, std::set<std::string>* taken) {
  std::string identifier;
  for (const char c : name) {
    const bool fits = c == '_' || (static_cast<unsigned char>(c) < 128 &&
                                   std::isalnum(static_cast<unsigned char>(c)) != 0);
    identifier += fits ? c : '_';
  }
  if (identifier.empty() || std::isdigit(static_cast<unsigned char>(identifier.front())) != 0) {
    identifier.insert(0, "v");
  }
  while (!taken->insert(identifier).second) identifier += '_';
  return identifier;
}

std::string Comment(const std::string& name) {
  std::string comment = name;
  std::replace_if(
      comment.begin(),
      comment.end(),
      [](char c) {
        return c == '*' || c == '/' || std::iscntrl(static_cast<unsigned char>(c)) != 0;
      },
      '_');
  return comment;
}

class CFile {
 public:
  CFile(std::span<const NamedExpression> expressions, const COptions& options)
      : expressions_(expressions), options_(options) {
    std::vector<Expression> formulas;
    for (const NamedExpression& each : expressions) formulas.push_back(each.expression);
    local_ = Access::Gather(formulas);
  }

  Parsed<std::string> Write() {
    Diagnostics missing = MissingFunctions();
    if (!missing.empty()) return tl::unexpected(std::move(missing));
    const bool is_function = !options_.function_name.empty();
    taken_.insert(kKeywords.begin(), kKeywords.end());
    taken_.insert(options_.functions.begin(), options_.functions.end());
    taken_.insert(options_.function_name);
    taken_.insert(options_.real_type);
    NameVariables(is_function);
    NameParts();
    CWriter writer(local_.graph, variables_, parts_);
    if (is_function) WriteHead();
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (parts_[i].empty()) continue;
      const auto place = static_cast<Index>(i);
      const bool is_condition = GivesCondition(local_.graph.node(place).operation);
      text_ += fmt::format("{}const {} {} = {};\n",
                           options_.indent,
                           is_condition ? "int" : options_.real_type,
                           parts_[i],
                           writer.Write(place));
    }
    for (std::size_t k = 0; k < expressions_.size(); ++k) {
      const Index root = local_.roots[k];
      const std::string& part = parts_[static_cast<std::size_t>(root)];
      const std::string value = part.empty() ? writer.Write(root) : part;
      const std::string& name = expressions_[k].name;
      if (!is_function) {
        text_ += fmt::format("{}{} = {};\n", options_.indent, name, value);
      } else {
        text_ += fmt::format("{}out[{}] = {};", options_.indent, k, value);
        text_ += name.empty() ? "\n" : fmt::format("  /* {} */\n", Comment(name));
      }
    }
    if (is_function) text_ += "}\n";
    return std::move(text_);
  }

 private:
  [[nodiscard]] Diagnostics MissingFunctions() const {
    std::set<std::string> needed;
    for (const Node& node : local_.graph.nodes()) {
      if (IsFunction(node.operation)) needed.emplace(CFunction(node.operation));
      if (node.operation != KOMPONO_CONSTANT || std::isfinite(node.value)) continue;
      needed.emplace(std::isnan(node.value) ? "NAN" : "INFINITY");
    }
    Diagnostics missing;
    for (const std::string& name : needed) {
      const auto& offered = options_.functions;
      if (std::find(offered.begin(), offered.end(), name) != offered.end()) continue;
      missing.push_back(
          {.severity = Severity::kError,
           .code = "E0286",
           .file = options_.function_name,
           .message = fmt::format("the formula needs '{}' of math.h, which the target "
                                  "does not have",
                                  name),
           .help = fmt::format("the target has: {}", fmt::join(offered, ", "))});
    }
    return missing;
  }

  void NameVariables(bool is_function) {
    const VariableNames names(options_.names, local_.names);
    variables_.resize(local_.graph.size());
    for (std::size_t i = 0; i < local_.graph.size(); ++i) {
      const Node& node = local_.graph.nodes()[i];
      if (node.operation != KOMPONO_VARIABLE) continue;
      const std::string name = names[node.operand[0]];
      variables_[i] = is_function ? Identifier(name, &taken_) : name;
      taken_.insert(name);
    }
  }

  void NameParts() {
    const Graph& graph = local_.graph;
    const std::vector<uint32_t> uses = UseCounts(graph.nodes(), local_.roots);
    std::vector<uint32_t> in_statement(graph.size(), 0);
    parts_.resize(graph.size());
    int number = 0;
    for (std::size_t i = 0; i < graph.size(); ++i) {
      const Node& node = graph.nodes()[i];
      const int count = OperandCount(node.operation);
      if (count == 0) continue;
      in_statement[i] = 1;
      for (int k = 0; k < count; ++k) {
        in_statement[i] += in_statement[static_cast<std::size_t>(node.operand[k])];
      }
      const bool is_cheap = node.operation == KOMPONO_NEGATE || node.operation == KOMPONO_NOT;
      if ((uses[i] < 2 || is_cheap) && in_statement[i] <= kMostInOneStatement) continue;
      do {
        parts_[i] = fmt::format("{}{}", options_.part_name, ++number);
      } while (!taken_.insert(parts_[i]).second);
      in_statement[i] = 0;
    }
  }

  void WriteHead() {
    if (!options_.include.empty()) text_ += fmt::format("#include {}\n\n", options_.include);
    text_ += fmt::format(
        "void {0}(const {1} in[], {1} out[]) {{\n", options_.function_name, options_.real_type);
    std::vector<std::pair<int, std::string>> used;
    for (std::size_t i = 0; i < variables_.size(); ++i) {
      if (!variables_[i].empty()) {
        used.emplace_back(local_.graph.nodes()[i].operand[0], variables_[i]);
      }
    }
    std::sort(used.begin(), used.end());
    for (const auto& [number, name] : used) {
      text_ += fmt::format(
          "{}const {} {} = in[{}];\n", options_.indent, options_.real_type, name, number);
    }
    if (used.empty()) text_ += options_.indent + "(void)in;\n";
  }

  std::span<const NamedExpression> expressions_;
  const COptions& options_;
  Local local_;
  std::set<std::string> taken_;
  std::vector<std::string> variables_, parts_;
  std::string text_;
};

}  // namespace

Parsed<std::string> ToC(std::span<const NamedExpression> expressions, const COptions& options) {
  return CFile(expressions, options).Write();
}

}  // namespace kompono
