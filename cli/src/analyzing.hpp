// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_ANALYZING_HPP_
#define KOMPONO_CLI_ANALYZING_HPP_

#include "console.hpp"
#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kompono/analysis/dexterity.hpp"
#include "kompono/analysis/geometry_numbers.hpp"
#include "kompono/analysis/indices.hpp"
#include "kompono/analysis/inscribed.hpp"
#include "kompono/analysis/singularities.hpp"
#include "kompono/analysis/work_zone.hpp"

/// What `kompono analyze` computes, and how it is told.
namespace kompono::cli {

/// What is asked, in mm and rad.
struct AnalysisTask {
  bool zone = false, dexterity = false, singularities = false, geometry = false;
  std::vector<analysis::Span> over;
  Eigen::VectorXd at;  ///< coordinates that are held, and the pose of --geometry
  std::vector<std::pair<std::string, double>> slices;
  std::vector<Eigen::VectorXd> path;
  std::string point;
  analysis::Limits limits;
  bool regular = true;
  std::optional<std::vector<double>> box;       ///< extents to be proven to fit
  std::optional<std::vector<double>> cylinder;  ///< diameter, height
  double tolerance = 0.005;
  std::optional<double> length_mm;  ///< characteristic length
  bool map = false;                 ///< condition over zone and slices
  bool indices = false;
  double tilt_rad = 0.0;  ///< of the orientation space index
  analysis::RunControl control;
};

/// A body asked for by its size: the largest of its proportions, and whether that is enough.
struct FittedBody {
  analysis::InscribedBody body;
  std::vector<double> wanted;  ///< extents; empty if only the largest was asked for
  [[nodiscard]] bool Fits() const;
};

struct SliceResult {
  std::string coordinate;
  double value = 0.0;
  bool rotary = false;
  std::shared_ptr<const analysis::ZoneFunction> function;
  analysis::WorkZone zone;
  analysis::SingularSet singular;
};

struct MechanismDexterity {
  std::string block;
  double length_mm = 1.0;
  analysis::DexterityField field;
  analysis::DexterityDetails home;
};

struct AnalysisResult {
  const kinematics::Machine* machine = nullptr;
  std::shared_ptr<const analysis::PoseJudge> judge;
  std::shared_ptr<const analysis::ZoneFunction> function;
  std::optional<analysis::WorkZone> zone;
  std::vector<FittedBody> bodies;
  std::vector<SliceResult> slices;
  std::vector<MechanismDexterity> dexterity;
  std::optional<analysis::LayoutIndices> indices;
  std::optional<analysis::SingularSet> singular;
  std::optional<analysis::SingularityDistance> home_distance;
  std::optional<analysis::PathReport> path;
  std::vector<Eigen::Vector3d> point_path;
  std::optional<analysis::GeometryNumbers> geometry;
  bool stopped = false;

  /// Something asked for does not hold: an empty zone, a body that does not fit, a singular path.
  [[nodiscard]] bool Negative() const;
};

[[nodiscard]] Parsed<AnalysisResult> Analyze(const kinematics::Machine& machine,
                                             const AnalysisTask& task);

[[nodiscard]] std::string AnalysisText(const Console& console, const AnalysisResult& result);
[[nodiscard]] nlohmann::ordered_json AnalysisJson(const AnalysisResult& result);

/// Panels of the zone, or of its slices, with singular places, bodies and, if asked for, the
/// condition as a map.
[[nodiscard]] std::string AnalysisSvg(const AnalysisResult& result, const AnalysisTask& task);
/// Samples of the zone's cells, or of a path.
[[nodiscard]] std::string AnalysisCsv(const AnalysisResult& result, const AnalysisTask& task);

/// The machine's coordinate that varies in direction i of a region.
[[nodiscard]] const kinematics::Coordinate& VariedCoordinate(const kinematics::Machine& machine,
                                                             const analysis::Region& region,
                                                             std::size_t i);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_ANALYZING_HPP_
