// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SCALAR_JET_HPP_
#define KOMPONO_SCALAR_JET_HPP_

#include <ceres/jet.h>

/// Automatic derivatives: `Jet<double, N>` carries a value and its N partial derivatives through a
/// template over the scalar, `Jet<Pack, N>` does so for eight poses at once, `Jet<Symbol, N>`
/// records them as formulas.
namespace kompono {

using ceres::Jet;

}  // namespace kompono

#endif  // KOMPONO_SCALAR_JET_HPP_
