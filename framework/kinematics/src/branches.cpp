// SPDX-License-Identifier: Apache-2.0
#include "kompono/kinematics/branches.hpp"

#include <cstddef>
#include <utility>
#include <variant>

namespace kompono::kinematics {
namespace {

void AddLeaves(const formula::Chain& chain, std::vector<std::string>* names) {
  for (const formula::Item& item : chain) {
    if (const auto* leaf = std::get_if<formula::Leaf>(&item)) names->push_back(leaf->Name());
    if (const auto* fork = std::get_if<formula::Fork>(&item)) {
      for (const formula::Chain& branch : fork->branches) AddLeaves(branch, names);
    }
  }
}

}  // namespace

std::vector<Branch> Branches(const Machine& machine) {
  std::vector<std::string> parts;
  std::vector<std::string> tools;
  AddLeaves(machine.layout().formula.left, &parts);
  AddLeaves(machine.layout().formula.right, &tools);
  std::vector<Branch> out;
  const auto add = [&](const std::string& part, const std::string& tool) {
    Parsed<Machine> chain = machine.Between(part, tool);
    if (chain) out.push_back({.part = part, .tool = tool, .chain = std::move(*chain)});
  };
  for (const std::string& part : parts) add(part, tools.front());
  for (std::size_t i = 1; i < tools.size(); ++i) add(parts.front(), tools[i]);
  return out;
}

VectorXd CoordinatesOn(const Machine& chain, const Machine& other, const VectorXd& z_of_other) {
  VectorXd z = chain.home();
  for (std::size_t i = 0; i < chain.coordinates().size(); ++i) {
    const int at = other.FindCoordinate(chain.coordinates()[i].name);
    if (at >= 0) z[static_cast<Eigen::Index>(i)] = z_of_other[at];
  }
  return z;
}

}  // namespace kompono::kinematics
