// SPDX-License-Identifier: Apache-2.0
#include "graph.hpp"
#include "pool.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "kompono/expression/expression.hpp"

namespace kompono {
namespace {

using expression_internal::Access;
using expression_internal::CopyInto;
using expression_internal::GivesCondition;
using expression_internal::Graph;
using expression_internal::Index;
using expression_internal::Node;
using expression_internal::OperandCount;
using expression_internal::WantsCondition;

constexpr std::size_t kMostComplaints = 20;

/// Checks a list of nodes that came from a plugin, without trusting anything in it.
class RecordingCheck {
 public:
  RecordingCheck(std::span<const Node> nodes, int variable_count, std::string_view source)
      : nodes_(nodes), variable_count_(variable_count), source_(source) {}

  Diagnostics Run(std::span<const int32_t> roots) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) CheckNode(i);
    for (std::size_t k = 0; k < roots.size(); ++k) CheckRoot(k, roots[k]);
    return std::move(complaints_);
  }

 private:
  void Complain(std::string code, std::string message) {
    if (complaints_.size() >= kMostComplaints) return;
    complaints_.push_back({.severity = Severity::kError,
                           .code = std::move(code),
                           .file = std::string(source_),
                           .message = std::move(message),
                           .help = "the plugin recorded this formula wrongly; rebuild it with the "
                                   "kompono SDK or report it to its author"});
  }

  void CheckNode(std::size_t i) {
    const Node& node = nodes_[i];
    const int count = OperandCount(node.operation);
    if (count < 0) {
      Complain(
          "E0281",
          fmt::format(
              "node {} of the recorded formula has the unknown operation {}", i, node.operation));
      return;
    }
    if (node.operation == KOMPONO_VARIABLE &&
        (node.operand[0] < 0 || node.operand[0] >= variable_count_)) {
      Complain("E0284",
               fmt::format("node {} of the recorded formula is variable {}, but there are "
                           "{} variables",
                           i,
                           node.operand[0],
                           variable_count_));
    }
    for (int k = 0; k < count; ++k) CheckOperand(i, k);
  }

  void CheckOperand(std::size_t i, int k) {
    const Node& node = nodes_[i];
    const int32_t operand = node.operand[k];
    if (operand < 0 || static_cast<std::size_t>(operand) >= i) {
      Complain("E0282",
               fmt::format("node {} of the recorded formula needs node {}, which does not "
                           "stand before it",
                           i,
                           operand));
      return;
    }
    const int32_t operation = nodes_[static_cast<std::size_t>(operand)].operation;
    if (OperandCount(operation) < 0) return;  // has its own complaint
    if (GivesCondition(operation) != WantsCondition(node.operation, k)) {
      Complain("E0283",
               fmt::format("node {} of the recorded formula needs a {}, but node {} is a {}",
                           i,
                           WantsCondition(node.operation, k) ? "condition" : "number",
                           operand,
                           GivesCondition(operation) ? "condition" : "number"));
    }
  }

  void CheckRoot(std::size_t k, int32_t root) {
    if (root < 0 || static_cast<std::size_t>(root) >= nodes_.size()) {
      Complain("E0285",
               fmt::format("result {} of the recorded formula is node {}, but there are "
                           "{} nodes",
                           k,
                           root,
                           nodes_.size()));
    } else if (GivesCondition(nodes_[static_cast<std::size_t>(root)].operation)) {
      Complain("E0285", fmt::format("result {} of the recorded formula is a condition", k));
    }
  }

  std::span<const Node> nodes_;
  int variable_count_;
  std::string_view source_;
  Diagnostics complaints_;
};

}  // namespace

Parsed<std::vector<Expression>> ImportRecording(std::span<const KomponoExpressionNode> nodes,
                                                std::span<const int32_t> roots,
                                                int variable_count,
                                                std::string_view source) {
  Diagnostics complaints = RecordingCheck(nodes, variable_count, source).Run(roots);
  if (!complaints.empty()) return tl::unexpected(std::move(complaints));
  Graph graph;
  const std::vector<Index> places = CopyInto(graph, nodes, roots);
  return Access::Wrap(std::move(graph), places, {});
}

}  // namespace kompono
