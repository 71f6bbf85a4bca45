// SPDX-License-Identifier: Apache-2.0
#include "budget.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include "kompono/kinematics/linearisation.hpp"

namespace kompono::synthesis {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using kinematics::Machine;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double LargestEigenvalue(const Matrix3d& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(symmetric, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

int DirectionIndex(char direction) {
  return direction == 'x' ? 0 : direction == 'y' ? 1 : 2;
}

/// What one drive is worth to the budget.
struct DriveModel {
  double compliance = 0.0;  ///< mm/N or rad/(N mm)
  double tolerance = 0.0;   ///< mm or rad
  std::size_t item = 0;     ///< index of its axis or mechanism
};

/// What the poses share.
struct Model {
  const Machine* machine = nullptr;
  const EvaluationSettings* settings = nullptr;
  std::vector<DriveModel> drives;
  std::vector<double> item_kg;
  std::vector<int> plain;         ///< coordinates that plain axes make
  std::vector<int> parameters;    ///< of θ that have a tolerance
  std::vector<double> tolerance;  ///< of these
  int tool_axis = 2;
};

std::vector<DriveModel> DriveModels(const Machine& machine,
                                    const MovedMasses& masses,
                                    const EvaluationSettings& settings,
                                    std::vector<double>& item_kg) {
  std::vector<DriveModel> out;
  std::map<std::string, std::size_t> items;
  for (const kinematics::Drive& drive : machine.drives()) {
    const std::string item = drive.name.substr(0, drive.name.find('.'));
    const auto [at, is_new] = items.emplace(item, items.size());
    if (is_new) {
      const auto mass = masses.of.find(item);
      item_kg.push_back(mass == masses.of.end() ? 0.0 : mass->second);
    }
    const double k = drive.stiffness.value_or(drive.rotary ? settings.rotary_stiffness_nmm_per_rad
                                                           : settings.drive_stiffness_n_per_mm);
    out.push_back(
        {.compliance = 1.0 / k,
         .tolerance = drive.rotary ? settings.drive_tolerance_rad : settings.drive_tolerance_mm,
         .item = at->second});
  }
  return out;
}

/// Numbers of the geometry that the workshop does not meet exactly: those with a tolerance in their
/// sidecar, and the directions of plain axes.
void AddTolerances(Model& model) {
  const Machine& machine = *model.machine;
  for (std::size_t i = 0; i < machine.parameters().size(); ++i) {
    const kinematics::Parameter& parameter = machine.parameters()[i];
    double tolerance = parameter.tolerance;
    for (const int c : model.plain) {
      const std::string& axis = machine.coordinates()[static_cast<std::size_t>(c)].name;
      if (parameter.name.starts_with(axis + ".rotation."))
        tolerance = model.settings->squareness_rad;
    }
    if (tolerance <= 0.0) continue;
    model.parameters.push_back(static_cast<int>(i));
    model.tolerance.push_back(tolerance);
  }
}

Model ModelOf(const Machine& machine,
              const MovedMasses& masses,
              char process_direction,
              const EvaluationSettings& settings) {
  Model model{
      .machine = &machine, .settings = &settings, .tool_axis = DirectionIndex(process_direction)};
  model.drives = DriveModels(machine, masses, settings, model.item_kg);
  for (std::size_t i = 0; i < machine.coordinates().size(); ++i) {
    if (machine.coordinates()[i].name.find('.') == std::string::npos)
      model.plain.push_back(static_cast<int>(i));
  }
  AddTolerances(model);
  return model;
}

/// Guides of plain axes run out across their motion and tilt what they carry (SO 44-55): a tilt
/// moves the tool by its distance from the guides, in the two directions across.
double GuideVariance(const Model& model, const VectorXd& z) {
  if (model.plain.empty()) return 0.0;
  const std::vector<Machine::FrameView> frames = model.machine->Frames(z, model.machine->nominal());
  Vector3d tool = Vector3d::Zero();
  for (const Machine::FrameView& frame : frames) {
    if (frame.kind == Machine::FrameView::Kind::kEnd && !frame.workpiece_side) tool = frame.X_MF.p;
  }
  const EvaluationSettings& s = *model.settings;
  double variance = 0.0;
  for (const int c : model.plain) {
    const std::string& name = model.machine->coordinates()[static_cast<std::size_t>(c)].name;
    for (const Machine::FrameView& frame : frames) {
      if (frame.kind != Machine::FrameView::Kind::kAxis || frame.name != name) continue;
      const double lever2 =
          s.guide_lever_mm * s.guide_lever_mm + (tool - frame.X_MF.p).squaredNorm();
      variance += 2.0 * s.guide_straightness_mm * s.guide_straightness_mm +
                  2.0 * lever2 * s.guide_angle_rad * s.guide_angle_rad;
    }
  }
  return variance;
}

/// Tool twists by the drives' readings: J⁻¹, or its pseudo-inverse where there are more drives.
MatrixXd TwistsByDrives(const kinematics::Linearisation& at) {
  const MatrixXd& q = at.readings_by_coordinates();
  if (q.rows() == q.cols())
    return q.transpose().partialPivLu().solve(at.pose_by_coordinates().transpose()).transpose();
  const MatrixXd inverse = q.completeOrthogonalDecomposition().pseudoInverse();
  return at.pose_by_coordinates() * inverse;
}

double Variance(const Model& model,
                const kinematics::Linearisation& at,
                const MatrixXd& by_drives,
                const VectorXd& z) {
  double variance = GuideVariance(model, z);
  if (model.machine->layout().formula.open_base)
    variance += 3.0 * model.settings->foundation_mm * model.settings->foundation_mm;
  for (Eigen::Index i = 0; i < by_drives.cols(); ++i) {
    const double tolerance = model.drives[static_cast<std::size_t>(i)].tolerance;
    variance += by_drives.col(i).head<3>().squaredNorm() * tolerance * tolerance;
  }
  if (model.parameters.empty()) return variance;
  // At fixed readings: what the geometry moves directly, less what the readings would have to do.
  const MatrixXd by_geometry = at.pose_by_parameters() - by_drives * at.readings_by_parameters();
  for (Eigen::Index i = 0; i < by_geometry.cols(); ++i) {
    const double tolerance = model.tolerance[static_cast<std::size_t>(i)];
    variance += by_geometry.col(i).head<3>().squaredNorm() * tolerance * tolerance;
  }
  return variance;
}

/// Of the directions of the tool's axis by the turns.
double OrientationMargin(const Model& model, const kinematics::Linearisation& at) {
  const Vector3d axis = at.X_WT().R.col(model.tool_axis);
  std::vector<Vector3d> rates;
  for (std::size_t i = 0; i < model.machine->coordinates().size(); ++i) {
    if (!model.machine->coordinates()[i].rotary) continue;
    const Vector3d omega = at.pose_by_coordinates().col(static_cast<Eigen::Index>(i)).tail<3>();
    rates.emplace_back(omega.cross(axis));
  }
  if (rates.empty()) return kNaN;
  Matrix3d gram = Matrix3d::Zero();
  for (const Vector3d& rate : rates) gram += rate * rate.transpose();
  Vector3d squares =
      Eigen::SelfAdjointEigenSolver<Matrix3d>(gram, Eigen::EigenvaluesOnly).eigenvalues();
  std::sort(squares.data(), squares.data() + 3, std::greater<>());
  // An axis has two ways to turn: of more turns the second counts.
  const Eigen::Index counted = rates.size() == 1 ? 0 : 1;
  return std::sqrt(std::max(0.0, squares[counted]));
}

void TakePose(const Model& model,
              const kinematics::Linearisation& at,
              const VectorXd& z,
              ToolBudget& out) {
  const MatrixXd by_drives = TwistsByDrives(at);
  if (!by_drives.allFinite()) return;
  std::vector<Matrix3d> compliance(model.item_kg.size(), Matrix3d::Zero());
  for (Eigen::Index i = 0; i < by_drives.cols(); ++i) {
    const DriveModel& drive = model.drives[static_cast<std::size_t>(i)];
    const Vector3d t = by_drives.col(i).head<3>();
    compliance[drive.item] += drive.compliance * t * t.transpose();
  }
  Matrix3d sum = Matrix3d::Zero();
  double deflection = 0.0;
  for (std::size_t item = 0; item < compliance.size(); ++item) {
    sum += compliance[item];
    // kg mm/s² = 1e-3 N
    const double force = model.item_kg[item] * model.settings->acceleration_mm_s2 * 1e-3;
    deflection += force * LargestEigenvalue(compliance[item]);
  }
  const double error = std::sqrt(Variance(model, at, by_drives, z));
  const double margin = OrientationMargin(model, at);
  const bool first = out.poses++ == 0;
  const double stiffness = 1.0 / LargestEigenvalue(sum);
  out.stiffness_n_per_mm = first ? stiffness : std::min(out.stiffness_n_per_mm, stiffness);
  out.error_mm = std::max(out.error_mm, error);
  out.dynamic_mm = std::max(out.dynamic_mm, deflection);
  out.orientation_margin = first ? margin : std::min(out.orientation_margin, margin);
}

/// Struts' lengths at home, m, by block.
std::map<std::string, double> StrutMetres(const Machine& machine) {
  const Machine::SkeletonView skeleton = machine.Skeleton(machine.home(), machine.nominal());
  std::map<std::string, Vector3d> points;
  for (const auto& point : skeleton.points) points[point.name] = point.p_M;
  std::map<std::string, double> out;
  for (const auto& link : skeleton.links) {
    if (link.kind != "strut") continue;
    const double length = (points[link.to] - points[link.from]).norm();
    if (std::isfinite(length)) out[link.from.substr(0, link.from.find('.'))] += length * 1e-3;
  }
  return out;
}

class MassCount {
 public:
  MassCount(const Machine& machine, double part_kg, const EvaluationSettings& settings)
      : machine_(&machine),
        settings_(&settings),
        part_kg_(part_kg),
        struts_(StrutMetres(machine)) {}

  MovedMasses Count() {
    const formula::Formula& formula = machine_->layout().formula;
    (void)Outward(formula.left.begin(), formula.left.end());
    (void)Outward(formula.right.rbegin(), formula.right.rend());
    return std::move(out_);
  }

 private:
  /// From the leaf to the base; what all of it weighs.
  template <class Iterator>
  double Outward(Iterator from, Iterator to) {
    double carried = 0.0;
    for (Iterator item = from; item != to; ++item) carried = With(*item, carried);
    return carried;
  }

  double With(const formula::Item& item, double carried) {
    if (const auto* leaf = std::get_if<formula::Leaf>(&item))
      return carried + (leaf->kind == formula::LeafKind::kPart ? part_kg_ : settings_->tool_kg);
    if (const auto* fork = std::get_if<formula::Fork>(&item)) {
      double sum = 0.0;
      for (const formula::Chain& branch : fork->branches) {
        const bool part_first = !branch.empty() && IsLeaf(branch.front());
        sum += part_first ? Outward(branch.begin(), branch.end())
                          : Outward(branch.rbegin(), branch.rend());
      }
      return carried + fork->count * sum;
    }
    if (const auto* axis = std::get_if<formula::Axis>(&item)) {
      if (axis->orientation != formula::Orientation::kNone) return carried + settings_->tool_kg;
      if (axis->block.empty()) return Plain(axis->Name(), carried);
      return Mechanism({*axis}, axis->block, carried);
    }
    const auto& group = std::get<formula::Group>(item);
    return Mechanism(group.axes, group.block, carried);
  }

  static bool IsLeaf(const formula::Item& item) {
    return std::holds_alternative<formula::Leaf>(item);
  }

  double Plain(const std::string& name, double carried) {
    const double moved = carried + settings_->slide_kg + settings_->slide_share * carried;
    return Moves(name, moved);
  }

  double Mechanism(const std::vector<formula::Axis>& axes, std::string name, double carried) {
    double drives = static_cast<double>(axes.size());
    for (const layout::Block& block : machine_->layout().blocks) {
      const bool realises =
          std::any_of(block.letters.begin(), block.letters.end(), [&](const auto& l) {
            return l.axis == axes.front().Name();
          });
      if (name.empty() ? !realises : block.name != name) continue;
      name = block.name;
      drives = static_cast<double>(block.drives.size());
    }
    return Moves(name,
                 carried + settings_->platform_kg + settings_->carriage_kg * drives +
                     settings_->strut_kg_per_m * struts_[name]);
  }

  double Moves(const std::string& name, double kg) {
    out_.of[name] = kg;
    out_.sum += kg;
    return kg;
  }

  const Machine* machine_;
  const EvaluationSettings* settings_;
  double part_kg_;
  std::map<std::string, double> struts_;
  MovedMasses out_;
};

}  // namespace

MovedMasses MassesOf(const Machine& machine, double part_kg, const EvaluationSettings& settings) {
  return MassCount(machine, part_kg, settings).Count();
}

ToolBudget BudgetOf(const Machine& machine,
                    const std::vector<VectorXd>& poses,
                    const MovedMasses& masses,
                    char process_direction,
                    const EvaluationSettings& settings) {
  const Model model = ModelOf(machine, masses, process_direction, settings);
  kinematics::Linearisation at(machine, model.parameters);
  const VectorXd theta = machine.nominal();
  at.SetGeometry(theta);
  ToolBudget out;
  for (const VectorXd& z : poses) {
    if (!at.At(z, kinematics::Linearisation::Depth::kByParameters)) continue;
    TakePose(model, at, z, out);
    for (const kinematics::Singularity& singularity : machine.Singularities(z, theta))
      out.singularity_margin = std::min(out.singularity_margin, singularity.margin);
  }
  if (out.poses == 0) {
    out.stiffness_n_per_mm = out.error_mm = out.dynamic_mm = kNaN;
    out.orientation_margin = out.singularity_margin = kNaN;
  }
  return out;
}

double SpaceBox::PortalMm() const {
  const Vector3d extents = upper - lower;
  return 2.0 * extents.z() + std::max(extents.x(), extents.y());
}

double SpaceBox::Content(std::size_t n) const {
  const Vector3d extents = upper - lower;
  std::array<double, 3> sides{extents.x(), extents.y(), extents.z()};
  std::sort(sides.begin(), sides.end(), std::greater<>());
  double content = 1.0;
  for (std::size_t i = 0; i < std::min<std::size_t>(n, 3); ++i) content *= sides[i];
  return content;
}

SpaceBox BoxOf(const Machine& machine, const std::vector<VectorXd>& poses, const Study& study) {
  SpaceBox out;
  out.lower = Vector3d::Constant(std::numeric_limits<double>::infinity());
  out.upper = -out.lower;
  const auto take = [&out](const Vector3d& p) {
    if (!p.allFinite()) return;
    out.lower = out.lower.cwiseMin(p);
    out.upper = out.upper.cwiseMax(p);
  };
  Vector3d middle = Vector3d::Zero();
  for (const Motion& motion : study.motions) {
    const std::size_t row = std::string_view("XYZ").find(motion.axis.letter);
    if (row < 3 && motion.axis.number == 0)
      middle[static_cast<Eigen::Index>(row)] = motion.range.middle();
  }
  const VectorXd theta = machine.nominal();
  for (const VectorXd& z : poses) {
    for (const auto& point : machine.Skeleton(z, theta).points) take(point.p_M);
    bool part_taken = false;
    for (const Machine::FrameView& frame : machine.Frames(z, theta)) {
      take(frame.X_MC.p);
      take(frame.X_MF.p);
      if (frame.kind != Machine::FrameView::Kind::kEnd || !frame.workpiece_side || part_taken)
        continue;
      part_taken = true;
      for (int c = 0; c < 8; ++c) {
        Vector3d corner = middle;
        for (int k = 0; k < 3; ++k)
          corner[k] +=
              (((c >> k) & 1) != 0 ? 0.5 : -0.5) * study.part_size_mm[static_cast<std::size_t>(k)];
        take(frame.X_MF.R * corner + frame.X_MF.p);
      }
    }
  }
  return out;
}

}  // namespace kompono::synthesis
