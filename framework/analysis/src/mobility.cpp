// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/mobility.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <Eigen/SVD>

#include "kompono/kinematics/branches.hpp"

namespace kompono::analysis {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

int FreedomsOfPair(const std::string& letter) {
  if (letter == "S") return 3;
  if (letter == "U" || letter == "C") return 2;
  return 1;  // R, P, H
}

/// Coordinates and drives less the rank of the loops' constraints, near home: a little off, because
/// symmetric poses may lose rank that their neighbours have.
int NumericMobility(const kinematics::Machine& machine,
                    const kinematics::Machine::BlockView& view) {
  const plugin::MechanismShape shape = view.code->Shape();
  const kinematics::VectorXd home = machine.home();
  std::vector<double> x;
  for (std::size_t i = 0; i < view.coordinates.size(); ++i) {
    const bool rotary = machine.coordinates()[static_cast<std::size_t>(view.coordinates[i])].rotary;
    const double off = rotary ? 0.003 : 0.01;
    x.push_back(view.block->letters[i].sign * home[view.coordinates[i]] +
                off * (1.0 + static_cast<double>(i)));
  }
  const kinematics::VectorXd theta = machine.nominal();
  const std::span<const double> parameters(theta.data() + view.first_parameter,
                                           static_cast<std::size_t>(shape.parameters));
  std::vector<double> q(static_cast<std::size_t>(shape.drives));
  std::vector<double> g(static_cast<std::size_t>(shape.closures));
  RowMajor A(shape.closures, shape.coordinates);
  RowMajor B(shape.closures, shape.drives);
  const plugin::Status drives = view.code->Evaluate(
      plugin::Quantity::kDrives,
      {.coordinates = x, .drives = {}, .parameters = parameters, .modes = view.modes},
      {.values = q});
  const plugin::Status loops = view.code->Evaluate(
      plugin::Quantity::kClosure,
      {.coordinates = x, .drives = q, .parameters = parameters, .modes = view.modes},
      {.values = g,
       .by_coordinates = {A.data(), static_cast<std::size_t>(A.size())},
       .by_drives = {B.data(), static_cast<std::size_t>(B.size())}});
  if (drives != plugin::Status::kOk || loops != plugin::Status::kOk || !A.allFinite() ||
      !B.allFinite())
    return -1;
  Eigen::MatrixXd both(A.rows(), A.cols() + B.cols());
  both << A, B;
  for (Eigen::Index i = 0; i < both.rows(); ++i) {
    const double norm = both.row(i).norm();
    if (norm > 0.0) both.row(i) /= norm;
  }
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(both);
  svd.setThreshold(1e-9);
  return shape.coordinates + shape.drives - static_cast<int>(svd.rank());
}

std::string Explain(const BlockMobility& mobility) {
  if (mobility.numeric < 0) return "the home pose is out of reach, so the rank could not be taken";
  if (mobility.idle > 0) {
    return fmt::format(
        "{} of the counted motions move no platform: struts that spin about themselves",
        mobility.idle);
  }
  if (mobility.passive == 0) return "";
  if (mobility.spatial != mobility.gruebler) {
    return fmt::format(
        "counted in space {}: {} constraints that keep the links in one plane repeat "
        "others (passive constraints)",
        mobility.spatial,
        mobility.passive);
  }
  return fmt::format("{} of the counted constraints repeat others (passive constraints)",
                     mobility.passive);
}

BlockMobility MobilityOf(const kinematics::Machine& machine,
                         const kinematics::Machine::BlockView& view) {
  const plugin::MechanismShape shape = view.code->Shape();
  BlockMobility mobility{.block = view.block->name,
                         .module = view.block->module,
                         .drives = shape.drives,
                         .coordinates = shape.coordinates,
                         .numeric = NumericMobility(machine, view)};
  if (view.description->structure) {
    const plugin::StructureDescription& structure = *view.description->structure;
    int freedoms = 0;
    for (const auto& [letter, count] : structure.pairs) {
      mobility.pairs += count;
      freedoms += count * FreedomsOfPair(letter);
    }
    mobility.counted = true;
    mobility.links = structure.links;
    mobility.loops = mobility.pairs - mobility.links + 1;
    const auto count = [&](int space) {
      return space * (mobility.links - 1 - mobility.pairs) + freedoms;
    };
    mobility.gruebler = count(structure.planar ? 3 : 6);
    mobility.spatial = count(6);
    if (mobility.numeric >= 0) {
      mobility.idle = std::max(0, mobility.gruebler - mobility.numeric);
      mobility.passive = std::max(0, mobility.numeric - mobility.spatial);
    }
  }
  mobility.explanation = Explain(mobility);
  return mobility;
}

}  // namespace

std::vector<BlockMobility> Mobility(const kinematics::Machine& machine) {
  std::vector<BlockMobility> out;
  for (const kinematics::Branch& branch : kinematics::Branches(machine)) {
    for (const kinematics::Machine::BlockView& view : branch.chain.blocks()) {
      const bool known = std::any_of(out.begin(), out.end(), [&view](const BlockMobility& other) {
        return other.block == view.block->name;
      });
      if (!known) out.push_back(MobilityOf(branch.chain, view));
    }
  }
  return out;
}

}  // namespace kompono::analysis
