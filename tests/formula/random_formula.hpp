// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_FORMULA_RANDOM_FORMULA_HPP_
#define KOMPONO_TESTS_FORMULA_RANDOM_FORMULA_HPP_

#include <random>
#include <string>

#include "kompono/formula/formula.hpp"

namespace kompono::formula {

/// The seed of a random test: KOMPONO_SEED from the environment, else `otherwise`. Printed, so that
/// a failure can be repeated.
[[nodiscard]] unsigned Seed(unsigned otherwise);

/// A random formula of all the notation has: numbers, setting motions, spindles, groups, nested and
/// counted forks.
[[nodiscard]] Formula RandomFormula(std::mt19937& random);

/// A whole number from 0 to `last`.
[[nodiscard]] int Pick(std::mt19937& random, int last);

}  // namespace kompono::formula

#endif  // KOMPONO_TESTS_FORMULA_RANDOM_FORMULA_HPP_
