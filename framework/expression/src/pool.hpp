// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPRESSION_SRC_POOL_HPP_
#define KOMPONO_EXPRESSION_SRC_POOL_HPP_

#include "graph.hpp"

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kompono/expression/expression.hpp"

namespace kompono::expression_internal {

using Names = std::map<int, std::string>;

/// What handles share: operators on handles append here, under the lock; all other operations first
/// copy the part they need and then work on it alone.
class Pool {
 public:
  std::mutex mutex;
  Graph graph;
  Names names;
};

/// A private copy of some formulas.
struct Local {
  Graph graph;
  std::vector<Index> roots;
  Names names;
};

struct Access {
  [[nodiscard]] static Local Gather(std::span<const Expression> roots);
  [[nodiscard]] static std::vector<Expression> Wrap(Graph graph,
                                                    std::span<const Index> roots,
                                                    Names names);
  /// A handle, or a plain number if the node is one. The caller holds the lock or is alone.
  [[nodiscard]] static Expression Handle(const std::shared_ptr<Pool>& pool, Index place);

  [[nodiscard]] static const std::shared_ptr<Pool>& PoolOf(const Expression& expression) {
    return expression.pool_;
  }
  [[nodiscard]] static Index PlaceOf(const Expression& expression) { return expression.place_; }
  [[nodiscard]] static double ValueOf(const Expression& expression) { return expression.value_; }
};

[[nodiscard]] ExpressionSize SizeOf(const Graph& graph, std::span<const Index> roots);

}  // namespace kompono::expression_internal

#endif  // KOMPONO_EXPRESSION_SRC_POOL_HPP_
