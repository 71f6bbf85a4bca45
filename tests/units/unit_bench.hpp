// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_UNITS_UNIT_BENCH_HPP_
#define KOMPONO_TESTS_UNITS_UNIT_BENCH_HPP_

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kompono/geometry/pose.hpp"
#include "kompono/plugin/registry.hpp"

namespace kompono::tests {

/// One shipped unit with numbers of its own: those of `given` in the units of its sidecar, the
/// others at their defaults.
class UnitBench {
 public:
  /// @throws std::runtime_error if the module or a parameter does not exist.
  explicit UnitBench(const std::string& module,
                     const std::map<std::string, std::vector<double>>& given = {});

  [[nodiscard]] const plugin::ModuleDescription& description() const { return *description_; }
  [[nodiscard]] const std::vector<double>& parameters() const { return parameters_; }  ///< mm, rad

  [[nodiscard]] Pose<double> At(const std::string& station, int state = 0) const;
  /// The 12 numbers of the pose, with other parameters; optionally 12 x parameters.
  [[nodiscard]] Eigen::VectorXd Rows(
      int station,
      int state,
      const std::vector<double>& parameters,
      Eigen::Matrix<double, 12, Eigen::Dynamic, Eigen::RowMajor>* by_parameters = nullptr) const;

 private:
  const plugin::ModuleDescription* description_ = nullptr;
  std::shared_ptr<const plugin::Unit> unit_;
  std::vector<double> parameters_;
};

}  // namespace kompono::tests

#endif  // KOMPONO_TESTS_UNITS_UNIT_BENCH_HPP_
