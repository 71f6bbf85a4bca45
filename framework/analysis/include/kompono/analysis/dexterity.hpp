// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_ANALYSIS_DEXTERITY_HPP_
#define KOMPONO_ANALYSIS_DEXTERITY_HPP_

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kompono/analysis/pose_judge.hpp"

/// How evenly a mechanism turns its drives' motions into the platform's.
///
/// With t = (v, L ω) the platform's twist in millimetres per second, L the characteristic length, J
/// gives the drives' speeds, q̇ = J t, on the twists that the mechanism can make. By the principle
/// of virtual work the platform's wrench is Jᵀ f for drive forces f. So a singular value s of J
/// means a direction in which 1 mm/s of the drives moves the platform at 1/s mm/s and 1 N of the
/// drives holds s N: where the smallest is 0 the drives hold nothing (type 2), where the largest is
/// infinite they move nothing (type 1).
namespace kompono::analysis {

struct Dexterity {
  double condition = 0.0;         ///< largest over smallest singular value of J; 1 is best
  double weakest_force = 0.0;     ///< smallest singular value of J: N of the platform per N
  double slowest_velocity = 0.0;  ///< 1 / largest: mm/s of the platform per mm/s of the drives
};

/// One axis of the velocity and the force ellipsoid; they share their directions.
struct EllipsoidAxis {
  Eigen::Matrix<double, 6, 1> twist;  ///< unit (v, L ω) in the mechanism's base
  double velocity = 0.0;              ///< semi-axis: platform mm/s for drives together at 1 mm/s
  double force = 0.0;                 ///< semi-axis: N for drive forces together 1 N
};

struct DexterityDetails {
  Dexterity dexterity;
  std::vector<EllipsoidAxis> axes;  ///< by falling velocity
};

/// The length that makes the mechanism's home best conditioned (Angeles); 1 if it does not turn.
[[nodiscard]] double CharacteristicLength(const PoseJudge& judge, std::size_t mechanism);

/// One pose, from exact derivatives. NaN out of reach.
[[nodiscard]] DexterityDetails DexterityAt(const PoseJudge& judge,
                                           std::size_t mechanism,
                                           const VectorXd& z,
                                           double length_mm);

/// Many poses: central differences of the plugin's batches, singular values by Jacobi rotations in
/// registers. Nothing is allocated after construction.
class DexterityBlock {
 public:
  /// With sides, poses are told apart by the sign of det J, which changes where a type 2
  /// singularity is crossed within reach; only for as many drives as coordinates.
  DexterityBlock(const PoseJudge& judge,
                 std::size_t mechanism,
                 double length_mm,
                 bool with_sides = false);
  DexterityBlock(const DexterityBlock&) = delete;
  DexterityBlock& operator=(const DexterityBlock&) = delete;
  DexterityBlock(DexterityBlock&&) noexcept;
  DexterityBlock& operator=(DexterityBlock&&) noexcept;
  ~DexterityBlock();

  /// Poses 0 … count - 1 of a block. NaN out of reach.
  void Evaluate(const PoseBlock& poses, std::size_t count);
  [[nodiscard]] Dexterity At(std::size_t pose) const;
  /// True wherever sides are not looked at.
  [[nodiscard]] bool OnHomeSide(std::size_t pose) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What a region is like on a grid: only poses inside count, and of these, unless `regular` is
/// false, only those on home's side of type 2 singularities.
struct DexterityField {
  std::uint64_t poses = 0;                     ///< inside
  double best = 0.0, worst = 0.0, mean = 0.0;  ///< condition; mean of its inverse is `global`
  double global = 0.0;         ///< mean of 1/condition: the global conditioning index (Gosselin)
  VectorXd best_at, worst_at;  ///< z
  double weakest_force = 0.0, slowest_velocity = 0.0;  ///< the least of all
  bool stopped = false;
};
[[nodiscard]] DexterityField DexterityOver(const PoseJudge& judge,
                                           std::size_t mechanism,
                                           double length_mm,
                                           const Region& region,
                                           std::span<const std::uint64_t> steps,
                                           const RunControl& control = {},
                                           bool regular = true);

}  // namespace kompono::analysis

#endif  // KOMPONO_ANALYSIS_DEXTERITY_HPP_
