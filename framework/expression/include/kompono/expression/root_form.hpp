// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPRESSION_ROOT_FORM_HPP_
#define KOMPONO_EXPRESSION_ROOT_FORM_HPP_

#include <optional>
#include <span>

#include "kompono/expression/polynomial.hpp"

namespace kompono {

/// polynomial ± sqrt(polynomial): the form of every glide's and pod's control formula.
struct RootForm {
  Polynomial outside;
  int sign = 1;
  Polynomial under;
};

/// The expression in this form, or nothing if it has no root, more than one, or one that is
/// multiplied by anything but a number (which is taken under the root).
[[nodiscard]] std::optional<RootForm> ExpandRootForm(const Expression& expression,
                                                     std::span<const int> variables,
                                                     const ExpandOptions& options = {});

}  // namespace kompono

#endif  // KOMPONO_EXPRESSION_ROOT_FORM_HPP_
