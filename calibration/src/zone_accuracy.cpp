// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/zone_accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/LU>
#include <Eigen/QR>

#include "kompono/calibration/codes.hpp"
#include "kompono/kinematics/linearisation.hpp"

namespace kompono::calibration {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr std::size_t kMostRows = 300;  ///< whose coordinates tell the measured zone

class ZoneMapper {
 public:
  using Depth = kinematics::Linearisation::Depth;

  ZoneMapper(const kinematics::Machine& machine, const CalibrationReport& report)
      : machine_(machine), own_(Own(machine, report)), linear_(machine, own_) {
    const auto n = static_cast<Eigen::Index>(own_.size());
    covariance_ = report.covariance.topLeftCorner(n, n);
    linear_.SetGeometry(report.theta_after);
  }

  /// Whether the machine stands at z; adds the point if so.
  bool Add(const Eigen::VectorXd& z, ZoneAccuracy* zone) {
    if (!linear_.At(z, Depth::kByParameters)) return false;
    const Eigen::MatrixXd& Q = linear_.readings_by_coordinates();
    const Eigen::MatrixXd inverse = Q.rows() == Q.cols()
                                        ? Eigen::MatrixXd(Q.inverse())
                                        : Q.completeOrthogonalDecomposition().pseudoInverse();
    const Eigen::MatrixXd J = linear_.pose_by_parameters() - linear_.pose_by_coordinates() *
                                                                 inverse *
                                                                 linear_.readings_by_parameters();
    const Eigen::MatrixXd of_twist = J * covariance_ * J.transpose();
    if (!of_twist.allFinite()) return false;
    ZonePoint point;
    point.coordinates = z;
    point.pose = kinematics::NumbersFromPose(linear_.X_WT(), machine_.layout().rotation_order);
    const Eigen::VectorXd variance = of_twist.diagonal().cwiseMax(0.0);
    point.sigma_mm = variance.head<3>().cwiseSqrt();
    point.length_mm = point.sigma_mm.norm();
    point.sigma_rad = std::sqrt(variance.tail<3>().sum());
    zone->points.push_back(std::move(point));
    return true;
  }

 private:
  static std::vector<int> Own(const kinematics::Machine& machine, const CalibrationReport& report) {
    std::vector<int> own = report.free;
    std::erase_if(own, [&machine](int index) {
      return index >= static_cast<int>(machine.parameters().size());
    });
    return own;
  }

  const kinematics::Machine& machine_;
  std::vector<int> own_;
  kinematics::Linearisation linear_;
  Eigen::MatrixXd covariance_;
};

using Range = std::array<double, 2>;

/// What the rows of the set span, coordinate by coordinate.
std::vector<Range> Spans(const kinematics::Machine& machine,
                         const MeasurementSet& set,
                         const Eigen::VectorXd& theta) {
  const Eigen::VectorXd home = machine.home();
  std::vector<Range> spans;
  const std::size_t stride = set.measurements.size() / kMostRows + 1;
  for (std::size_t i = 0; i < set.measurements.size(); i += stride) {
    const kinematics::MeasuredPose at =
        machine.Measure(set.measurements[i].readings, theta, home, false);
    if (at.status != kinematics::SolveStatus::kConverged) continue;
    const bool first = spans.empty();
    spans.resize(static_cast<std::size_t>(home.size()));
    for (std::size_t k = 0; k < spans.size(); ++k) {
      const double value = at.coordinates[static_cast<Eigen::Index>(k)];
      spans[k] = first ? Range{value, value}
                       : Range{std::min(spans[k][0], value), std::max(spans[k][1], value)};
    }
  }
  if (spans.empty()) {
    for (const double value : home) spans.push_back({value, value});
  }
  return spans;
}

}  // namespace

Parsed<ZoneAccuracy> ToolOverZone(const kinematics::Machine& machine,
                                  const MeasurementSet& set,
                                  const CalibrationReport& report,
                                  int steps,
                                  const std::map<std::string, Range>& region) {
  if (!report.ok() || report.covariance.size() == 0 || steps < 1) {
    return tl::unexpected(Diagnostics{
        {.code = codes::kNothingFree.code,
         .file = machine.layout().file.string(),
         .message = "without a good identification nothing is known of the tool's deviation"}});
  }
  const Eigen::VectorXd home = machine.home();
  const std::vector<Range> spans = Spans(machine, set, report.theta_after);
  std::vector<std::vector<double>> values;
  std::size_t count = 1;
  for (std::size_t k = 0; k < machine.coordinates().size(); ++k) {
    const kinematics::Coordinate& coordinate = machine.coordinates()[k];
    Range range{coordinate.lower.value_or(spans[k][0]), coordinate.upper.value_or(spans[k][1])};
    const auto given = region.find(coordinate.name);
    if (given != region.end()) range = given->second;
    std::vector<double> of_coordinate{home[static_cast<Eigen::Index>(k)]};
    if (!coordinate.rotary && range[1] > range[0] && steps > 1) {
      of_coordinate.clear();
      for (int i = 0; i < steps; ++i) {
        of_coordinate.push_back(range[0] + (range[1] - range[0]) * i / (steps - 1));
      }
    }
    count *= of_coordinate.size();
    values.push_back(std::move(of_coordinate));
  }
  ZoneAccuracy zone;
  ZoneMapper mapper(machine, report);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::VectorXd z = home;
    std::size_t rest = i;
    for (std::size_t k = values.size(); k-- > 0;) {
      z[static_cast<Eigen::Index>(k)] = values[k][rest % values[k].size()];
      rest /= values[k].size();
    }
    if (!mapper.Add(z, &zone)) ++zone.out_of_reach;
  }
  for (const ZonePoint& point : zone.points) {
    zone.rms_mm += point.length_mm * point.length_mm / static_cast<double>(zone.points.size());
    zone.max_mm = std::max(zone.max_mm, point.length_mm);
    zone.max_rad = std::max(zone.max_rad, point.sigma_rad);
  }
  zone.rms_mm = std::sqrt(zone.rms_mm);
  return zone;
}

std::string ZoneCsv(const kinematics::Machine& machine, const ZoneAccuracy& zone) {
  std::string text;
  for (const kinematics::Coordinate& coordinate : machine.coordinates()) {
    text += fmt::format("{}_{},", coordinate.name, coordinate.rotary ? "deg" : "mm");
  }
  text += "x_mm,y_mm,z_mm,a_deg,b_deg,c_deg,sigma_x_mm,sigma_y_mm,sigma_z_mm,sigma_mm,sigma_deg\n";
  for (const ZonePoint& point : zone.points) {
    for (std::size_t k = 0; k < machine.coordinates().size(); ++k) {
      const double factor = machine.coordinates()[k].rotary ? kDegPerRad : 1.0;
      text += fmt::format("{:.6f},", point.coordinates[static_cast<Eigen::Index>(k)] * factor);
    }
    for (std::size_t i = 0; i < 6; ++i) {
      text += fmt::format("{:.6f},", point.pose.value[i] * (i < 3 ? 1.0 : kDegPerRad));
    }
    text += fmt::format("{:.6f},{:.6f},{:.6f},{:.6f},{:.3e}\n",
                        point.sigma_mm[0],
                        point.sigma_mm[1],
                        point.sigma_mm[2],
                        point.length_mm,
                        point.sigma_rad * kDegPerRad);
  }
  return text;
}

}  // namespace kompono::calibration
