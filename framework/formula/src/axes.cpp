// SPDX-License-Identifier: Apache-2.0
#include "kompono/formula/formula.hpp"

namespace kompono::formula {
namespace {

void Append(const Chain& chain, std::vector<Axis>& axes) {
  for (const Item& item : chain) {
    if (const auto* axis = std::get_if<Axis>(&item)) {
      axes.push_back(*axis);
    } else if (const auto* group = std::get_if<Group>(&item)) {
      axes.insert(axes.end(), group->axes.begin(), group->axes.end());
    } else if (const auto* fork = std::get_if<Fork>(&item)) {
      for (const Chain& branch : fork->branches) Append(branch, axes);
    }
  }
}

}  // namespace

std::vector<Axis> AxesOf(const Formula& formula) {
  std::vector<Axis> axes;
  Append(formula.left, axes);
  Append(formula.right, axes);
  return axes;
}

}  // namespace kompono::formula
