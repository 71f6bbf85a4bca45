// SPDX-License-Identifier: Apache-2.0
#include "kompono/plugin/interfaces.hpp"

namespace kompono::plugin {

Mechanism::~Mechanism() = default;
Unit::~Unit() = default;

}  // namespace kompono::plugin
