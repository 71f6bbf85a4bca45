// SPDX-License-Identifier: Apache-2.0
#include "end_tables.hpp"

#include "study_keys.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace kompono::synthesis {
namespace {

constexpr double kDegPerRad = 57.295779513082320877;

/// `inner` under its name (and the name of the table it stands in) as a table with a heading of its
/// own, so that several follow one another whatever they were in the study.
void PrintTable(std::ostringstream& out,
                std::string_view outer,
                std::string_view name,
                const toml::node& inner) {
  toml::table one;
  one.insert(name, inner);
  if (toml::table* table = one.get_as<toml::table>(name)) table->is_inline(false);
  if (!outer.empty()) {
    toml::table around;
    around.insert(outer, std::move(one));
    one = std::move(around);
  }
  out << '\n' << one << '\n';
}

Vector3<double> TripleOf(const toml::table& table, std::string_view key) {
  const auto triple = TripleAt(table, key).value_or(std::array<double, 3>{});
  return {triple[0], triple[1], triple[2]};
}

/// Without what a turn by right angles leaves.
double Cleaned(double value) {
  return std::abs(value) < 1e-9 ? 0.0 : value;
}

void Put(toml::table& table, std::string_view key, const Vector3<double>& triple) {
  table.insert_or_assign(key,
                         toml::array{Cleaned(triple[0]), Cleaned(triple[1]), Cleaned(triple[2])});
}

/// `position` and `rotation` of the table, before turned by R.
void Turn(toml::table& placement, const Matrix3<double>& R) {
  const Vector3<double> angles = TripleOf(placement, "rotation") / kDegPerRad;
  const Matrix3<double> turned = R * RotationXYZ(angles[0], angles[1], angles[2]);
  const std::array<double, 3> abc = AnglesOf(turned);
  Put(placement, "position", R * TripleOf(placement, "position"));
  Put(placement, "rotation", Vector3<double>(abc[0], abc[1], abc[2]) * kDegPerRad);
}

toml::table& TableIn(toml::table& table, std::string_view key) {
  if (table.get_as<toml::table>(key) == nullptr) table.insert_or_assign(key, toml::table{});
  return *table.get_as<toml::table>(key);
}

/// Names of the leaves without planes.
void CollectLeaves(const formula::Chain& chain, std::vector<formula::Leaf>& leaves) {
  for (const formula::Item& item : chain) {
    if (const auto* leaf = std::get_if<formula::Leaf>(&item)) {
      leaves.push_back(*leaf);
      leaves.back().plane.clear();
    } else if (const auto* fork = std::get_if<formula::Fork>(&item)) {
      for (const formula::Chain& branch : fork->branches) CollectLeaves(branch, leaves);
    }
  }
}

/// Axes of the chain that stand directly on the end's carrier or on each other: plain ones.
void CollectAxes(const formula::Chain& chain, std::vector<std::string>& axes) {
  for (const formula::Item& item : chain) {
    if (const auto* axis = std::get_if<formula::Axis>(&item)) {
      axes.push_back(axis->Name());
    } else if (const auto* fork = std::get_if<formula::Fork>(&item)) {
      for (const formula::Chain& branch : fork->branches) CollectAxes(branch, axes);
    }
  }
}

void CollectBlocks(const formula::Chain& chain, std::vector<std::string>& blocks) {
  for (const formula::Item& item : chain) {
    if (const auto* group = std::get_if<formula::Group>(&item)) {
      blocks.push_back(group->block);
    } else if (const auto* fork = std::get_if<formula::Fork>(&item)) {
      for (const formula::Chain& branch : fork->branches) CollectBlocks(branch, blocks);
    }
  }
}

/// The table that describes the leaf; a process may be called so, or as a tool.
toml::table& TableOfLeaf(toml::table& tables, const formula::Leaf& leaf) {
  if (leaf.kind == formula::LeafKind::kProcess) {
    for (const char* name : {"process", "tool"}) {
      if (toml::table* table = tables.get_as<toml::table>(name)) return *table;
    }
  }
  return TableIn(tables, leaf.Name());
}

}  // namespace

std::string TablesText(const toml::table& tables) {
  std::ostringstream out;
  for (const auto& [key, node] : tables) {
    const toml::table* table = node.as_table();
    const bool named = key.str() == "axis" || key.str() == "block";
    if (table == nullptr || !named) {
      PrintTable(out, "", key.str(), node);
      continue;
    }
    for (const auto& [name, inner] : *table) PrintTable(out, key.str(), name.str(), inner);
  }
  return out.str();
}

std::string TurnedTables(const EndChoice& end, const Matrix3<double>& R) {
  if (R.isApprox(Matrix3<double>::Identity(), 1e-12)) return end.tables;
  toml::table tables = toml::parse(end.tables);
  std::vector<std::string> axes;
  CollectAxes(end.chain, axes);
  for (const std::string& axis : axes) Turn(TableIn(TableIn(tables, "axis"), axis), R);
  std::vector<std::string> blocks;
  CollectBlocks(end.chain, blocks);
  for (const std::string& block : blocks) {
    Turn(TableIn(TableIn(TableIn(tables, "block"), block), "mount"), R);
  }
  std::vector<formula::Leaf> leaves;
  CollectLeaves(end.chain, leaves);
  // What a block carries is turned with the block already.
  for (const formula::Leaf& leaf : leaves) {
    if (blocks.empty()) Turn(TableIn(TableOfLeaf(tables, leaf), "mount"), R);
  }
  return TablesText(tables);
}

std::array<double, 3> AnglesOf(const Matrix3<double>& R) {
  const double sine = std::clamp(R(0, 2), -1.0, 1.0);
  if (std::abs(sine) > 1.0 - 1e-14) {  // only a and c together count
    return {std::atan2(R(2, 1), R(1, 1)), std::asin(sine), 0.0};
  }
  return {std::atan2(-R(1, 2), R(2, 2)), std::asin(sine), std::atan2(-R(0, 1), R(0, 0))};
}

}  // namespace kompono::synthesis
