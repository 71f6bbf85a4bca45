// SPDX-License-Identifier: Apache-2.0
#include "kompono/plugin/interfaces.hpp"

#include "kompono/plugin/bound_mechanism.hpp"

namespace kompono::plugin {

Mechanism::~Mechanism() = default;
Unit::~Unit() = default;
BoundMechanism::~BoundMechanism() = default;

}  // namespace kompono::plugin
