// SPDX-License-Identifier: Apache-2.0
#include "unit_bench.hpp"

#include "shipped_machines.hpp"

#include <algorithm>
#include <stdexcept>

namespace kompono::tests {

UnitBench::UnitBench(const std::string& module,
                     const std::map<std::string, std::vector<double>>& given)
    : description_(ShippedRegistry().Find(module)) {
  auto unit = ShippedRegistry().CreateUnit(module);
  if (description_ == nullptr || !unit) throw std::runtime_error("no unit " + module);
  unit_ = *unit;
  for (const auto& parameter : description_->parameters) {
    for (const double value : parameter.default_value)
      parameters_.push_back(value * parameter.ToInternal());
  }
  for (const auto& [name, values] : given) {
    const auto* parameter = description_->FindParameter(name);
    if (parameter == nullptr || static_cast<int>(values.size()) != parameter->Numbers())
      throw std::runtime_error(module + ": bad parameter " + name);
    for (std::size_t i = 0; i < values.size(); ++i)
      parameters_[static_cast<std::size_t>(parameter->offset) + i] =
          values[i] * parameter->ToInternal();
  }
}

Pose<double> UnitBench::At(const std::string& station, int state) const {
  const auto found =
      std::find(description_->stations.begin(), description_->stations.end(), station);
  if (found == description_->stations.end()) throw std::runtime_error("no station " + station);
  const Eigen::VectorXd rows =
      Rows(static_cast<int>(found - description_->stations.begin()), state, parameters_);
  return Pose<double>::Read({rows.data(), 12});
}

Eigen::VectorXd UnitBench::Rows(
    int station,
    int state,
    const std::vector<double>& parameters,
    Eigen::Matrix<double, 12, Eigen::Dynamic, Eigen::RowMajor>* by_parameters) const {
  Eigen::VectorXd rows(12);
  std::span<double> table;
  if (by_parameters != nullptr) {
    by_parameters->resize(12, static_cast<Eigen::Index>(parameters.size()));
    table = {by_parameters->data(), static_cast<std::size_t>(by_parameters->size())};
  }
  const plugin::Status status =
      unit_->StationPose(station, state, parameters, {rows.data(), 12}, table);
  if (status != plugin::Status::kOk) throw std::runtime_error("StationPose refused");
  return rows;
}

}  // namespace kompono::tests
