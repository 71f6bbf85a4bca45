// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/cross_validation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace kompono::calibration {

std::vector<FoldedError> CrossValidate(const kinematics::Machine& machine,
                                       const MeasurementSet& set,
                                       const IdentifyOptions& options,
                                       int folds) {
  MeasurementSet fitted = set;
  std::erase_if(fitted.measurements, [](const Measurement& m) { return m.held_out; });
  const std::size_t rows = fitted.measurements.size();
  // Rows stand in an order of their own in most files; neighbours must not share a fold.
  std::vector<std::size_t> order(rows);
  for (std::size_t i = 0; i < rows; ++i) order[i] = i;
  std::mt19937_64 random(options.seed);
  for (std::size_t i = 0; i + 1 < rows; ++i) std::swap(order[i], order[i + random() % (rows - i)]);
  IdentifyOptions plain = options;
  plain.held_out_fraction = 0.0;
  std::map<std::string, FoldedError> sums;
  const CalibrationReport whole = Identify(machine, fitted, plain);
  if (!whole.ok()) return {};
  for (const ErrorStatistics& s : whole.statistics) {
    sums[s.quantity] = {.quantity = s.quantity, .angle = s.angle, .rms_fitted = s.rms_after};
  }
  for (int fold = 0; fold < folds; ++fold) {
    MeasurementSet part = fitted;
    for (std::size_t i = 0; i < rows; ++i) {
      const bool out = static_cast<int>(i % static_cast<std::size_t>(folds)) == fold;
      part.measurements[order[i]].held_out = out;
    }
    const bool rejected = !whole.rejected.empty();
    if (rejected) {  // rows that are known to be wrong judge nothing
      std::erase_if(part.measurements, [&whole](const Measurement& m) {
        return m.held_out && std::find(whole.rejected.begin(), whole.rejected.end(), m.row) !=
                                 whole.rejected.end();
      });
    }
    const CalibrationReport report = Identify(machine, part, plain);
    if (!report.ok()) return {};
    for (const ErrorStatistics& s : report.statistics) {
      if (!s.held_out) continue;
      FoldedError& sum = sums[s.quantity];
      sum.count += s.count;
      sum.rms_held_out += s.count * s.rms_after * s.rms_after;
    }
  }
  std::vector<FoldedError> out;
  for (auto& [name, sum] : sums) {
    if (sum.count == 0) continue;
    sum.rms_held_out = std::sqrt(sum.rms_held_out / sum.count);
    out.push_back(sum);
  }
  return out;
}

}  // namespace kompono::calibration
