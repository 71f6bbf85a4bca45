// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_POSE_JUDGE_HPP_
#define KOMPONO_ANALYSIS_POSE_JUDGE_HPP_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kompono/analysis/region.hpp"
#include "kompono/diagnostics/diagnostic.hpp"
#include "kompono/kinematics/machine.hpp"

/// Whether poses can be taken, many at a time: reach, ranges of the drives, swing of passive
/// joints, clearance between struts.
namespace kompono::analysis {

/// How far a strut may swing in its joint, away from its direction at home as the body that carries
/// the joint sees it (a carriage or the base at one end, the platform at the other).
struct SwingLimit {
  std::string joint;  ///< a skeleton point that ends a strut, "struts.base1"; * matches anything
  double swing_rad = 0.0;
};

/// What a pose must keep. Reach always counts.
struct Limits {
  bool of_layout = true;  ///< ranges of drives, swings and clearances that the layout gives
  std::vector<SwingLimit> swings;  ///< besides those of the layout
  /// Struts are capsules of this radius; those that share a joint may touch. None: as the layout
  /// says, 0 if it does not.
  std::optional<double> strut_radius_mm;
  /// Between the capsules' surfaces. None: as the layout says, 0 if only a radius is given, and not
  /// looked at if nothing is.
  std::optional<double> clearance_mm;
};

/// One thing that can end the zone.
struct Constraint {
  enum class Kind {
    kReach,
    kDriveLower,
    kDriveUpper,
    kSwing,
    kClearance,
    kRegular
  } kind = Kind::kReach;
  std::string name;  ///< "struts.q1 at its upper limit"
  int mechanism = 0;
  int row = 0;  ///< drive, joint or pair of struts of that mechanism
};

/// A machine made ready for judging. Immutable; may be used from several threads, each with a
/// PoseBlock of its own. The machine must live as long.
class PoseJudge {
 public:
  /// E0721: a swing limit that matches no joint.
  [[nodiscard]] static Parsed<PoseJudge> Make(const Machine& machine,
                                              const VectorXd& theta,
                                              const Limits& limits);

  [[nodiscard]] const std::vector<Constraint>& constraints() const { return constraints_; }
  [[nodiscard]] std::size_t coordinates() const { return coordinate_count_; }
  [[nodiscard]] const Machine& machine() const { return *machine_; }
  [[nodiscard]] const VectorXd& theta() const { return theta_; }

  /// A joint whose swing is limited: the strut leads from point `at` to point `other`.
  struct Joint {
    int at = 0, other = 0;
    bool on_platform = false;
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< in base or platform
    double cosine = -1.0;                             ///< smallest allowed
    double swing_rad = 0.0;
  };
  struct StrutPair {
    std::array<int, 2> first{}, second{};  ///< skeleton points
    double distance_mm = 0.0;              ///< smallest allowed between the centre lines
  };
  /// One mechanism with everything its checks need; drive coordinates, not readings.
  struct Mechanism {
    const plugin::Mechanism* code = nullptr;
    const plugin::ModuleDescription* description = nullptr;
    std::string block;
    plugin::MechanismShape shape;
    std::vector<double> parameters, modes;
    std::vector<int> coordinate;
    std::vector<double> sign;          ///< local = sign * coordinate
    std::vector<double> lower, upper;  ///< of the drive coordinates; ±max if open
    std::vector<bool> reversed;        ///< per drive: the reading counts against the coordinate
    std::vector<Joint> joints;
    std::vector<StrutPair> pairs;
  };
  [[nodiscard]] const std::vector<Mechanism>& mechanisms() const { return mechanisms_; }

 private:
  PoseJudge() = default;

  const Machine* machine_ = nullptr;
  VectorXd theta_;
  std::size_t coordinate_count_ = 0;
  std::vector<Mechanism> mechanisms_;
  std::vector<Constraint> constraints_;
};

/// A few thousand poses as columns, and the answers. Nothing is allocated after construction.
class PoseBlock {
 public:
  static constexpr std::size_t kCapacity = 2048;

  explicit PoseBlock(const PoseJudge& judge);
  PoseBlock(const PoseBlock&) = delete;  ///< its columns point into one another
  PoseBlock& operator=(const PoseBlock&) = delete;
  PoseBlock(PoseBlock&&) noexcept = default;
  PoseBlock& operator=(PoseBlock&&) noexcept = default;
  ~PoseBlock() = default;

  /// Where the poses are put: coordinate i of pose k at [k]; mm, rad.
  [[nodiscard]] std::span<double> column(std::size_t coordinate) {
    return {coordinates_.data() + coordinate * kCapacity, kCapacity};
  }
  [[nodiscard]] std::span<const double> column(std::size_t coordinate) const {
    return {coordinates_.data() + coordinate * kCapacity, kCapacity};
  }
  /// Judges the first `count` poses. @throws std::logic_error if count > kCapacity, or a module
  /// fails.
  void Judge(std::size_t count);

  [[nodiscard]] bool Inside(std::size_t pose) const { return inside_[pose] != 0; }
  [[nodiscard]] std::size_t InsideCount() const { return inside_count_; }
  /// Index of the first constraint that the pose breaks, -1 if it is inside.
  [[nodiscard]] int CauseOf(std::size_t pose) const;
  /// Drive coordinate of a mechanism (not the reading), as judged.
  [[nodiscard]] double DriveCoordinate(std::size_t mechanism,
                                       std::size_t drive,
                                       std::size_t pose) const;

 private:
  struct Work {
    std::vector<double> local;  ///< negated coordinates, where a sign is -1
    std::vector<double> drives, points, platform;
    std::vector<const double*> in, drives_in;
    std::vector<double*> drives_out, points_out, platform_out;
  };
  void JudgeDrives(const PoseJudge::Mechanism& mechanism, Work& work, std::size_t count);
  void JudgeSkeleton(const PoseJudge::Mechanism& mechanism, Work& work, std::size_t count);
  [[nodiscard]] bool Keeps(const Constraint& constraint, std::size_t pose) const;

  const PoseJudge* judge_;
  std::vector<double> coordinates_;
  std::vector<Work> work_;            ///< per mechanism
  std::vector<std::int64_t> inside_;  ///< 0 or -1
  std::size_t inside_count_ = 0;
};

/// How many poses of a grid are inside, and why the others are not.
struct PoseCount {
  std::uint64_t poses = 0, inside = 0;
  std::vector<std::uint64_t> causes;  ///< per constraint: poses that break it first
  bool stopped = false;
};

/// Judges the middles of a grid of `steps` cells in every varied direction, in any number of
/// dimensions and without keeping them.
[[nodiscard]] PoseCount CountGrid(const PoseJudge& judge,
                                  const Region& region,
                                  std::span<const std::uint64_t> steps,
                                  bool with_causes = false,
                                  const RunControl& control = {});

/// Fills columns with the poses first … first + count - 1 of that grid, the last varied coordinate
/// running fastest; held coordinates are filled by FillHeld once.
void FillHeld(const Region& region, PoseBlock& block);
void FillGrid(const Region& region,
              std::span<const std::uint64_t> steps,
              std::uint64_t first,
              std::size_t count,
              PoseBlock& block);

/// One pose. Index of the first constraint it breaks, -1 if none.
[[nodiscard]] int CauseAt(const PoseJudge& judge, const VectorXd& z);

/// A swing above its limit, or centre lines of struts nearer to each other than they may.
struct BrokenStrutLimit {
  const Constraint* constraint = nullptr;
  double value = 0.0, limit = 0.0;  ///< rad for a swing, mm for a clearance
};
/// All that one pose breaks of swings and clearances.
[[nodiscard]] std::vector<BrokenStrutLimit> BrokenStrutLimits(const PoseJudge& judge,
                                                              const VectorXd& z);

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_POSE_JUDGE_HPP_
