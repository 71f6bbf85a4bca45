// SPDX-License-Identifier: Apache-2.0
// The chain of chain.cpp for those who ask very often: constant frames once per geometry, chosen
// columns only, no allocation per pose.
#include "kompono/kinematics/linearisation.hpp"

#include "machine_impl.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace kompono::kinematics {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int kNone = -1;

Vector6 Transport(const Pose<double>& X, const Vector6& twist) {
  Vector6 out;
  const Vector3<double> omega = X.R * twist.tail<3>();
  out << X.R * twist.head<3>() + X.p.cross(omega), omega;
  return out;
}

Vector6 SpatialTwist(const Pose<double>& X, const Pose<double>& d) {
  const Matrix3<double> W = d.R * X.R.transpose();
  const Vector3<double> omega(
      0.5 * (W(2, 1) - W(1, 2)), 0.5 * (W(0, 2) - W(2, 0)), 0.5 * (W(1, 0) - W(0, 1)));
  Vector6 twist;
  twist << d.p - omega.cross(X.p), omega;
  return twist;
}

/// The pose whose twelve numbers stand in column `column` of a row-major table.
Pose<double> PoseOfColumn(const RowMajor& table, Eigen::Index column) {
  Pose<double> out;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out.R(i, j) = table(4 * i + j, column);
    out.p[i] = table(4 * i + 3, column);
  }
  return out;
}

struct Entry {
  bool coordinate = false;  ///< else a number of the geometry
  int column = 0;
  Vector6 twist;  ///< spatial, in the factor's left frame
};

struct Frame {
  Pose<double> X;
  std::vector<Entry> entries;
};

void InvertInPlace(Pose<double>* X, std::vector<Entry>* entries) {
  const Pose<double> inverse = X->Inverse();
  for (Entry& entry : *entries) entry.twist = -Transport(inverse, entry.twist);
  *X = inverse;
}

}  // namespace

struct Linearisation::Workspace {
  Workspace(std::shared_ptr<const Machine::Impl> of_machine, std::vector<int> wanted)
      : impl(std::move(of_machine)), parameters(std::move(wanted)) {
    column.assign(impl->model->parameters.size(), kNone);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      column[static_cast<std::size_t>(parameters[i])] = static_cast<int>(i);
    }
    const auto nz = static_cast<Eigen::Index>(impl->coordinates.size());
    const auto nq = static_cast<Eigen::Index>(impl->drives.size());
    const auto np = static_cast<Eigen::Index>(parameters.size());
    readings.setZero(nq);
    by_z.setZero(6, nz);
    by_theta.setZero(6, np);
    q_by_z.setZero(nq, nz);
    q_by_theta.setZero(nq, np);
    mechanisms.resize(impl->mechanisms.size());
    for (std::size_t i = 0; i < mechanisms.size(); ++i)
      Prepare(impl->mechanisms[i], &mechanisms[i]);
  }

  /// Buffers of one mechanism and what of it is wanted.
  struct Block {
    VectorXd x, q;
    std::array<double, 12> pose{};
    RowMajor pose_by_x, pose_by_theta, q_by_x, q_by_theta;
    std::vector<std::pair<int, int>> module_columns;  ///< own number, column
    bool platform_moves_with_theta = true;
  };

  void Prepare(const MechanismModel& model, Block* block) const {
    const plugin::MechanismShape shape = model.code->Shape();
    block->x.resize(shape.coordinates);
    block->q.resize(shape.drives);
    block->pose_by_x.resize(12, shape.coordinates);
    block->pose_by_theta.resize(12, shape.parameters);
    block->q_by_x.resize(shape.drives, shape.coordinates);
    block->q_by_theta.resize(shape.drives, shape.parameters);
    for (int i = 0; i < shape.parameters; ++i) {
      const int at = ColumnOf(model.theta_module + i);
      if (at != kNone) block->module_columns.emplace_back(i, at);
    }
  }

  /// Column of a number of θ, or kNone.
  [[nodiscard]] int ColumnOf(int number) const { return column[static_cast<std::size_t>(number)]; }

  [[nodiscard]] std::span<const double> Own(const MechanismModel& model, Eigen::Index count) const {
    return {theta.data() + model.theta_module, static_cast<std::size_t>(count)};
  }

  void AddPlacement(int first, Frame* frame) const {
    const Matrix3<double> Ra = RotationX(theta[first + 3]);
    const Matrix3<double> Rab = Ra * RotationY(theta[first + 4]);
    frame->X = PlacementPose(theta, first);
    const std::array<Vector3<double>, 3> axes{Vector3<double>::UnitX(), Ra.col(1), Rab.col(2)};
    for (int i = 0; i < 6; ++i) {
      const int at = ColumnOf(first + i);
      if (at == kNone) continue;
      Vector6 twist = Vector6::Zero();
      if (i < 3) {
        twist[i] = 1.0;
      } else {
        const Vector3<double>& omega = axes[static_cast<std::size_t>(i - 3)];
        twist << -omega.cross(frame->X.p), omega;  // the frame's origin stays
      }
      frame->entries.push_back({false, at, twist});
    }
  }

  void AddStation(const EndModel& end, Frame* frame) const {
    AddPlacement(end.theta_mount, frame);
    if (!end.code) return;
    const auto count = static_cast<std::size_t>(end.parameter_count);
    std::array<double, 12> numbers{};
    RowMajor table(12, end.parameter_count);
    const plugin::Status status =
        end.code->StationPose(end.station,
                              impl->layout().ends[static_cast<std::size_t>(end.end)].state,
                              {theta.data() + end.theta_module, count},
                              numbers,
                              {table.data(), static_cast<std::size_t>(table.size())});
    if (status != plugin::Status::kOk) numbers.fill(std::nan(""));
    const Pose<double> station = Pose<double>::Read(numbers);
    for (int i = 0; i < end.parameter_count; ++i) {
      const int at = ColumnOf(end.theta_module + i);
      if (at == kNone) continue;
      const Vector6 twist = SpatialTwist(station, PoseOfColumn(table, i));
      frame->entries.push_back({false, at, Transport(frame->X, twist)});
    }
    frame->X = frame->X * station;
  }

  void SetGeometry(const VectorXd& value) {
    theta = value;
    constant.assign(impl->factors.size(), {});
    for (std::size_t i = 0; i < impl->factors.size(); ++i) {
      const Factor& factor = impl->factors[i];
      const auto index = static_cast<std::size_t>(factor.index);
      Frame* frame = &constant[i];
      switch (factor.kind) {
        case Factor::Kind::kMechanism:
          AddPlacement(impl->mechanisms[index].theta_mount, frame);
          break;
        case Factor::Kind::kAxis:
          AddPlacement(impl->axes[index].theta_frame, frame);
          break;
        case Factor::Kind::kEnd:
          AddStation(impl->model->ends[index], frame);
          if (factor.inverse) InvertInPlace(&frame->X, &frame->entries);
          break;
        case Factor::Kind::kOpenBase:
          AddPlacement(impl->model->theta_open_base, frame);
          if (factor.inverse) InvertInPlace(&frame->X, &frame->entries);
          break;
      }
    }
    if (!probed) Probe();
  }

  /// Most platforms do not depend on the geometry. Two places tell.
  void Probe() {
    probed = true;
    for (std::size_t i = 0; i < mechanisms.size(); ++i) {
      const MechanismModel& model = impl->mechanisms[i];
      Block& block = mechanisms[i];
      bool moves = false;
      for (const double offset : {0.0, 0.0625}) {
        for (std::size_t k = 0; k < model.coordinate.size(); ++k) {
          const auto at = static_cast<Eigen::Index>(k);
          block.x[at] = impl->coordinates[static_cast<std::size_t>(model.coordinate[k])].home +
                        offset * static_cast<double>(k + 1);
        }
        block.pose_by_theta.setZero();
        const bool ok = EvaluatePlatform(model, &block, false, true);
        moves = moves || !ok || !block.pose_by_theta.isZero(0.0);
      }
      block.platform_moves_with_theta = moves;
    }
  }

  bool EvaluatePlatform(const MechanismModel& model, Block* block, bool by_x, bool by_own) const {
    const auto span = [](RowMajor& table, bool wanted) {
      return std::span<double>(table.data(), wanted ? static_cast<std::size_t>(table.size()) : 0);
    };
    return model.code->Evaluate(
               plugin::Quantity::kPlatform,
               {.coordinates = {block->x.data(), static_cast<std::size_t>(block->x.size())},
                .drives = {},
                .parameters = Own(model, block->pose_by_theta.cols()),
                .modes = model.modes},
               {.values = block->pose,
                .by_coordinates = span(block->pose_by_x, by_x),
                .by_drives = {},
                .by_parameters = span(block->pose_by_theta, by_own)}) == plugin::Status::kOk;
  }

  /// Appends `entry` as seen from the left of `X_left`.
  void Add(const Pose<double>& X_left, const Entry& entry) {
    buffer.push_back({entry.coordinate, entry.column, Transport(X_left, entry.twist)});
  }

  bool AddMechanism(std::size_t index, const Frame& mount, Depth depth, const VectorXd& z) {
    const MechanismModel& model = impl->mechanisms[index];
    Block& block = mechanisms[index];
    const layout::Block& of = BlockOf(*impl, model);
    for (std::size_t i = 0; i < model.coordinate.size(); ++i) {
      block.x[static_cast<Eigen::Index>(i)] = of.letters[i].sign * z[model.coordinate[i]];
    }
    const bool by_x = depth != Depth::kValues;
    const bool by_own = depth == Depth::kByParameters && block.platform_moves_with_theta &&
                        !block.module_columns.empty();
    if (!EvaluatePlatform(model, &block, by_x, by_own)) return false;
    const Pose<double> platform = Pose<double>::Read(block.pose);
    if (by_x) {
      for (std::size_t i = 0; i < model.coordinate.size(); ++i) {
        const Vector6 twist =
            SpatialTwist(platform, PoseOfColumn(block.pose_by_x, static_cast<Eigen::Index>(i)));
        Add(mount.X, {true, model.coordinate[i], of.letters[i].sign * twist});
      }
    }
    if (by_own) {
      for (const auto& [own, at] : block.module_columns) {
        Add(mount.X, {false, at, SpatialTwist(platform, PoseOfColumn(block.pose_by_theta, own))});
      }
    }
    X_factor = mount.X * platform;
    return true;
  }

  void AddAxis(const AxisModel& axis, const Frame& frame, Depth depth, const VectorXd& z) {
    const layout::Axis& of = impl->layout().axes[static_cast<std::size_t>(axis.axis)];
    const Pose<double> motion =
        LetterMotion(of.letter, axis.coordinate < 0 ? 0.0 : z[axis.coordinate]);
    X_factor = frame.X * motion * frame.X.Inverse();
    if (depth != Depth::kValues && axis.coordinate >= 0) {
      Vector6 twist = Vector6::Zero();
      twist[AxisOfLetter(of.letter) + (IsRotaryLetter(of.letter) ? 3 : 0)] = 1.0;
      Add(frame.X, {true, axis.coordinate, twist});
    }
    if (depth != Depth::kByParameters) return;
    for (const Entry& entry : frame.entries) {
      buffer.push_back({false, entry.column, -Transport(X_factor, entry.twist)});
    }
  }

  void AddFrame(const Frame& frame) {
    buffer.insert(buffer.end(), frame.entries.begin(), frame.entries.end());
  }

  bool Chain(const VectorXd& z, Depth depth) {
    by_z.setZero();
    if (depth == Depth::kByParameters) by_theta.setZero();
    Pose<double> X_WK;
    for (std::size_t i = 0; i < impl->factors.size(); ++i) {
      const Factor& factor = impl->factors[i];
      const Frame& frame = constant[i];
      const auto index = static_cast<std::size_t>(factor.index);
      const bool moving =
          factor.kind == Factor::Kind::kMechanism || factor.kind == Factor::Kind::kAxis;
      buffer.clear();
      if (depth == Depth::kByParameters) AddFrame(frame);
      X_factor = frame.X;
      if (factor.kind == Factor::Kind::kMechanism && !AddMechanism(index, frame, depth, z)) {
        return false;
      }
      if (factor.kind == Factor::Kind::kAxis) AddAxis(impl->axes[index], frame, depth, z);
      if (moving && factor.inverse) InvertInPlace(&X_factor, &buffer);
      for (const Entry& entry : buffer) {
        auto column_of = (entry.coordinate ? by_z : by_theta).col(entry.column);
        column_of += Transport(X_WK, entry.twist);
      }
      X_WK = X_WK * X_factor;
    }
    X_WT = X_WK;
    ToToolPoint(&by_z);
    if (depth == Depth::kByParameters) ToToolPoint(&by_theta);
    return X_WT.p.allFinite();
  }

  /// From the velocity at W's origin to that of the tool point.
  void ToToolPoint(Twists* table) const {
    for (Eigen::Index i = 0; i < table->cols(); ++i) {
      const Vector3<double> omega = table->col(i).tail<3>();
      table->col(i).head<3>() += omega.cross(X_WT.p);
    }
  }

  void AxisReadings(const VectorXd& z, Depth depth) {
    for (const AxisModel& axis : impl->axes) {
      if (axis.coordinate < 0) continue;
      const int sign = impl->layout().axes[static_cast<std::size_t>(axis.axis)].drive.sign;
      readings[axis.drive] = sign * (z[axis.coordinate] - theta[axis.theta_zero]);
      if (depth == Depth::kValues) continue;
      q_by_z(axis.drive, axis.coordinate) = sign;
      const int at = ColumnOf(axis.theta_zero);
      if (depth == Depth::kByParameters && at != kNone) q_by_theta(axis.drive, at) = -sign;
    }
  }

  /// Needs block.x of the chain's pass.
  bool MechanismReadings(std::size_t index, Depth depth) {
    const MechanismModel& model = impl->mechanisms[index];
    if (model.first_drive < 0) return true;
    Block& block = mechanisms[index];
    const layout::Block& of = BlockOf(*impl, model);
    const bool by_x = depth != Depth::kValues;
    const bool by_own = depth == Depth::kByParameters && !block.module_columns.empty();
    const auto span = [](RowMajor& table, bool wanted) {
      return std::span<double>(table.data(), wanted ? static_cast<std::size_t>(table.size()) : 0);
    };
    const plugin::Status status = model.code->Evaluate(
        plugin::Quantity::kDrives,
        {.coordinates = {block.x.data(), static_cast<std::size_t>(block.x.size())},
         .drives = {},
         .parameters = Own(model, block.pose_by_theta.cols()),
         .modes = model.modes},
        {.values = {block.q.data(), static_cast<std::size_t>(block.q.size())},
         .by_coordinates = span(block.q_by_x, by_x),
         .by_drives = {},
         .by_parameters = span(block.q_by_theta, by_own)});
    if (status != plugin::Status::kOk || !block.q.allFinite()) return false;
    for (std::size_t i = 0; i < of.drives.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const Eigen::Index row = model.first_drive + k;
      const int sign = of.drives[i].sign;
      readings[row] = sign * (block.q[k] - theta[model.theta_zero + k]);
      for (std::size_t j = 0; by_x && j < model.coordinate.size(); ++j) {
        q_by_z(row, model.coordinate[j]) =
            sign * of.letters[j].sign * block.q_by_x(k, static_cast<Eigen::Index>(j));
      }
      if (depth != Depth::kByParameters) continue;
      for (const auto& [own, at] : block.module_columns) {
        q_by_theta(row, at) = sign * block.q_by_theta(k, own);
      }
      const int zero = ColumnOf(model.theta_zero + static_cast<int>(i));
      if (zero != kNone) q_by_theta(row, zero) = -sign;
    }
    return true;
  }

  bool At(const Eigen::Ref<const VectorXd>& at, Depth depth) {
    z_now = at;
    if (!Chain(z_now, depth)) return false;
    AxisReadings(z_now, depth);
    for (std::size_t i = 0; i < mechanisms.size(); ++i) {
      if (!MechanismReadings(i, depth)) return false;
    }
    return true;
  }

  std::shared_ptr<const Machine::Impl> impl;
  std::vector<int> parameters;
  std::vector<int> column;  ///< per number of θ its column, or kNone
  VectorXd theta, z_now;
  std::vector<Frame> constant;  ///< per factor: mount, axis frame, or the whole factor
  std::vector<Block> mechanisms;
  std::vector<Entry> buffer;
  Pose<double> X_factor, X_WT;
  bool probed = false;
  VectorXd readings;
  Twists by_z, by_theta;
  MatrixXd q_by_z, q_by_theta;
};

Linearisation::Linearisation(const Machine& machine, std::vector<int> parameters)
    : workspace_(std::make_unique<Workspace>(machine.impl_, std::move(parameters))) {
  SetGeometry(machine.nominal());
}
Linearisation::~Linearisation() = default;
Linearisation::Linearisation(Linearisation&& other) noexcept = default;
Linearisation& Linearisation::operator=(Linearisation&& other) noexcept = default;

void Linearisation::SetGeometry(const VectorXd& theta) {
  workspace_->SetGeometry(theta);
}
bool Linearisation::At(const Eigen::Ref<const VectorXd>& z, Depth depth) {
  return workspace_->At(z, depth);
}
bool Linearisation::PoseAt(const Eigen::Ref<const VectorXd>& z) {
  workspace_->z_now = z;
  return workspace_->Chain(workspace_->z_now, Depth::kByCoordinates);
}
const Pose<double>& Linearisation::X_WT() const {
  return workspace_->X_WT;
}
const VectorXd& Linearisation::readings() const {
  return workspace_->readings;
}
const Linearisation::Twists& Linearisation::pose_by_coordinates() const {
  return workspace_->by_z;
}
const Linearisation::Twists& Linearisation::pose_by_parameters() const {
  return workspace_->by_theta;
}
const MatrixXd& Linearisation::readings_by_coordinates() const {
  return workspace_->q_by_z;
}
const MatrixXd& Linearisation::readings_by_parameters() const {
  return workspace_->q_by_theta;
}

}  // namespace kompono::kinematics
