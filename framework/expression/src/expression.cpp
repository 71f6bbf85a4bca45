// SPDX-License-Identifier: Apache-2.0
#include "kompono/expression/expression.hpp"

#include "graph.hpp"
#include "pool.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "kompono/diagnostics/expects.hpp"

namespace kompono {

using expression_internal::Access;
using expression_internal::CopyInto;
using expression_internal::Graph;
using expression_internal::Index;
using expression_internal::Local;
using expression_internal::Names;
using expression_internal::Node;
using expression_internal::OperandCount;
using expression_internal::Pool;

namespace expression_internal {

Expression Access::Handle(const std::shared_ptr<Pool>& pool, Index place) {
  if (pool->graph.IsConstant(place)) return {pool->graph.node(place).value};
  return {pool, place};
}

Local Access::Gather(std::span<const Expression> roots) {
  Local local;
  local.roots.resize(roots.size(), -1);
  std::map<Pool*, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < roots.size(); ++i) groups[roots[i].pool_.get()].push_back(i);
  // In the order of the roots, so that the result does not depend on addresses.
  std::set<Pool*> done;
  for (const Expression& root : roots) {
    Pool* const pool = root.pool_.get();
    if (!done.insert(pool).second) continue;
    const std::vector<std::size_t>& members = groups[pool];
    if (pool == nullptr) {
      for (const std::size_t i : members) local.roots[i] = local.graph.Constant(roots[i].value_);
      continue;
    }
    std::vector<Index> places;
    places.reserve(members.size());
    for (const std::size_t i : members) places.push_back(roots[i].place_);
    const auto end = static_cast<std::size_t>(*std::max_element(places.begin(), places.end())) + 1;
    const std::lock_guard<std::mutex> lock(pool->mutex);
    const std::vector<Index> copies =
        CopyInto(local.graph, pool->graph.nodes().subspan(0, end), places);
    for (std::size_t k = 0; k < members.size(); ++k) local.roots[members[k]] = copies[k];
    local.names.insert(pool->names.begin(), pool->names.end());
  }
  return local;
}

std::vector<Expression> Access::Wrap(Graph graph, std::span<const Index> roots, Names names) {
  const auto pool = std::make_shared<Pool>();
  pool->graph = std::move(graph);
  pool->names = std::move(names);
  std::vector<Expression> result;
  result.reserve(roots.size());
  for (const Index root : roots) result.push_back(Handle(pool, root));
  return result;
}

ExpressionSize SizeOf(const Graph& graph, std::span<const Index> roots) {
  const std::vector<bool> reached = Reachable(graph.nodes(), roots);
  std::vector<double> written(graph.size(), 0.0);
  ExpressionSize size;
  for (std::size_t i = 0; i < graph.size(); ++i) {
    const Node& node = graph.nodes()[i];
    const int count = OperandCount(node.operation);
    if (!reached[i] || count == 0) continue;
    ++size.operations;
    written[i] = 1.0;
    for (int k = 0; k < count; ++k)
      written[i] += written[static_cast<std::size_t>(node.operand[k])];
  }
  for (const Index root : roots) {
    size.written += written[static_cast<std::size_t>(root)];
    size.depth = std::max<std::size_t>(size.depth, graph.facts(root).depth);
  }
  return size;
}

}  // namespace expression_internal

Expression::Expression(std::shared_ptr<Pool> pool, int32_t place)
    : pool_(std::move(pool)), place_(place) {}

Expression Expression::Variable(int number, std::string_view name) {
  KOMPONO_EXPECTS(number >= 0);
  const auto pool = std::make_shared<Pool>();
  if (!name.empty()) pool->names.emplace(number, name);
  return {pool, pool->graph.Variable(number)};
}

bool Expression::IsConstant() const {
  return pool_ == nullptr;
}

std::optional<double> Expression::ConstantValue() const {
  return pool_ == nullptr ? std::optional<double>(value_) : std::nullopt;
}

bool Expression::IsCondition() const {
  if (pool_ == nullptr) return false;
  const std::lock_guard<std::mutex> lock(pool_->mutex);
  return expression_internal::GivesCondition(pool_->graph.node(place_).operation);
}

std::vector<int> Expression::Variables() const {
  const Local local = Access::Gather({this, 1});
  std::vector<int> numbers;
  for (const Node& node : local.graph.nodes()) {
    if (node.operation == KOMPONO_VARIABLE) numbers.push_back(node.operand[0]);
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

ExpressionSize Expression::Size() const {
  return SizeOf({this, 1});
}

double Expression::Evaluate(std::span<const double> variables) const {
  return kompono::Evaluate({this, 1}, variables).front();
}

Expression Expression::Substitute(const std::map<int, Expression>& values) const {
  return kompono::Substitute({this, 1}, values).front();
}

Expression Expression::Derivative(int variable) const {
  return Derivatives({this, 1}, {&variable, 1}).front();
}

Expression Expression::Simplify() const {
  return kompono::Simplify({this, 1}).expressions.front();
}

bool Expression::operator==(const Expression& other) const {
  const std::array<Expression, 2> both{*this, other};
  const Local local = Access::Gather(both);
  return local.roots[0] == local.roots[1];
}

Expression Expression::Apply(KomponoOperation operation, const Expression& a) {
  return Apply3(operation, a, {}, {});
}

Expression Expression::Apply(KomponoOperation operation, const Expression& a, const Expression& b) {
  return Apply3(operation, a, b, {});
}

Expression Expression::Apply3(KomponoOperation operation,
                              const Expression& a,
                              const Expression& b,
                              const Expression& c) {
  const std::array<const Expression*, 3> operands{&a, &b, &c};
  const int count = OperandCount(operation);
  // The largest pool among the operands takes in the others.
  std::shared_ptr<Pool> target;
  std::size_t target_size = 0;
  for (int k = 0; k < count; ++k) {
    const Expression& operand = *operands[static_cast<std::size_t>(k)];
    const bool numbers_as_expected =
        operand.IsCondition() == expression_internal::WantsCondition(operation, k);
    KOMPONO_EXPECTS(numbers_as_expected);
    if (operand.pool_ == nullptr || operand.pool_ == target) continue;
    const std::lock_guard<std::mutex> lock(operand.pool_->mutex);
    if (target == nullptr || operand.pool_->graph.size() > target_size) {
      target = operand.pool_;
      target_size = target->graph.size();
    }
  }
  if (target == nullptr) target = std::make_shared<Pool>();

  std::array<Local, 3> strangers;
  for (int k = 0; k < count; ++k) {
    const Expression& operand = *operands[static_cast<std::size_t>(k)];
    if (operand.pool_ != target) {
      strangers[static_cast<std::size_t>(k)] = Access::Gather({&operand, 1});
    }
  }
  const std::lock_guard<std::mutex> lock(target->mutex);
  std::array<Index, 3> places{-1, -1, -1};
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const Local& stranger = strangers[k];
    if (stranger.roots.empty()) {
      places[k] = operands[k]->place_;
    } else {
      places[k] = CopyInto(target->graph, stranger.graph.nodes(), stranger.roots).front();
      target->names.insert(stranger.names.begin(), stranger.names.end());
    }
  }
  return Access::Handle(target, target->graph.Apply(operation, places[0], places[1], places[2]));
}

ExpressionSize SizeOf(std::span<const Expression> roots) {
  const Local local = Access::Gather(roots);
  return expression_internal::SizeOf(local.graph, local.roots);
}

}  // namespace kompono
