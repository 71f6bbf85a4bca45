// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SYNTHESIS_EVALUATION_HPP_
#define KOMPONO_SYNTHESIS_EVALUATION_HPP_

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"

/// What is said of one layout of a study: the metrics, their units and how each is computed, and
/// the row that an evaluation leaves behind.
namespace kompono::synthesis {

/// Cheap first. A layout that a stage rejects does not reach the next.
enum class Stage { kStructure, kMobility, kSizing, kZone, kBudget };
inline constexpr std::size_t kStages = 5;

struct StageDescription {
  Stage stage = Stage::kStructure;
  std::string_view name;   ///< "structure": the same in every version
  std::string_view needs;  ///< in words
  std::string_view gives;
};
[[nodiscard]] const std::array<StageDescription, kStages>& Stages();
[[nodiscard]] std::string_view NameOf(Stage stage);

/// Numbers of metrics, in the order of Metrics().
enum class MetricId : std::uint8_t {
  kDriveCount,
  kPartCount,
  kPassiveJoints,
  kStack,
  kPartMotions,
  kFoundations,
  kMobility,
  kPassiveConstraints,
  kAbilities,
  kTravel,
  kZoneShare,
  kDexterityMean,
  kDexterityWorst,
  kSingularityMargin,
  kOrientationMargin,
  kStiffness,
  kErrorBudget,
  kDynamicError,
  kMovingMass,
  kFootprint,
  kFrame,
  kSpaceEfficiency,
};
inline constexpr std::size_t kMetrics = 22;

struct MetricDescription {
  MetricId id = MetricId::kDriveCount;
  std::string_view name;  ///< as studies and the catalog write it
  std::string_view unit;  ///< "1" for a pure number
  bool maximise = false;  ///< what is better, unless a study says otherwise
  Stage stage = Stage::kStructure;
  std::string_view method;  ///< how it is computed, in a few words; goes into the catalog
  std::string_view meaning;
};
[[nodiscard]] const std::array<MetricDescription, kMetrics>& Metrics();
[[nodiscard]] const MetricDescription& DescriptionOf(MetricId id);
[[nodiscard]] const MetricDescription* FindMetric(std::string_view name);
/// For the study reader.
[[nodiscard]] const std::vector<std::string>& MetricNames();

/// Values of all metrics; not a number where a metric was not computed or does not exist (a machine
/// that does not turn has no orientation margin).
class MetricValues {
 public:
  [[nodiscard]] double operator[](MetricId id) const {
    return values_[static_cast<std::size_t>(id)];
  }
  void Set(MetricId id, double value) { values_[static_cast<std::size_t>(id)] = value; }
  [[nodiscard]] bool Has(MetricId id) const {
    const double value = (*this)[id];
    return value == value;
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::array<double, kMetrics> values_ = Empty();
  static constexpr std::array<double, kMetrics> Empty() {
    std::array<double, kMetrics> out{};
    for (double& value : out) value = kNone;
    return out;
  }
};

enum class EvaluationStatus { kOk, kRejected, kFailed };
[[nodiscard]] std::string_view NameOf(EvaluationStatus status);

/// A number that sizing has found, for people and the catalog.
struct SizedNumber {
  std::string name;  ///< "drive.L1"
  double value = 0.0;
  bool angle = false;  ///< rad, else mm
};

/// What became of one candidate. Every candidate leaves one: never a hole.
struct Evaluation {
  std::uint64_t index = 0;
  EvaluationStatus status = EvaluationStatus::kOk;
  Stage stage = Stage::kStructure;  ///< the last that looked at it
  /// Why it is not ok, in words that many rows share; the numbers stand in the metrics.
  std::string reason;
  std::string formula;  ///< canonical text
  MetricValues metrics;
  std::vector<SizedNumber> sizes;
};

/// Assumptions that a comparison rests on, the table [evaluation] of a study; the same for all of
/// its layouts.
struct EvaluationSettings {
  std::uint64_t poses = 10000;        ///< of the work-zone map
  double zone_share = 0.999;          ///< least share of the required zone; below: rejected
  double dexterity_goal = 0.3;        ///< sizing: worst 1/condition that is asked for
  std::uint64_t sizing_steps = 5;     ///< poses per coordinate while sizing
  std::uint64_t sizing_rounds = 150;  ///< most evaluations of the optimiser
  // Tolerances, one standard deviation.
  double drive_tolerance_mm = 0.005;
  double drive_tolerance_rad = 2.5e-5;
  double guide_straightness_mm = 0.005;  ///< of a plain axis, across its motion
  double guide_angle_rad = 2.0e-5;       ///< roll, pitch and yaw of a plain axis
  double squareness_rad = 2.0e-5;        ///< direction of a plain axis
  double guide_lever_mm = 300.0;         ///< how far a plain axis' guides are from the work zone
  double foundation_mm = 0.05;  ///< of an open base's mutual position, each way, identified
  // Stiffness of a drive with all that it acts through, where the study gives none.
  double drive_stiffness_n_per_mm = 5.0e4;
  double rotary_stiffness_nmm_per_rad = 2.0e9;
  // Masses, kg.
  double slide_kg = 100.0;    ///< of a plain axis
  double slide_share = 0.5;   ///< and of it for each kg that it carries
  double platform_kg = 30.0;  ///< of a mechanism
  double carriage_kg = 15.0;  ///< of each of its drives
  double strut_kg_per_m = 10.0;
  double tool_kg = 30.0;
  double acceleration_mm_s2 = 2000.0;  ///< of the tool's relative motion, for the dynamic error
};

/// The table [evaluation] of a study file's text; defaults where there is none. E0840: unknown key;
/// E0841: wrong type or value. All problems at once.
[[nodiscard]] Parsed<EvaluationSettings> ReadEvaluationSettings(std::string_view study_text,
                                                                std::string_view file);
/// The keys of that table with their meaning, for schema and documents.
struct SettingDescription {
  std::string_view key, unit, meaning;
  double lower = 0.0, upper = 0.0;
};
[[nodiscard]] std::vector<SettingDescription> EvaluationKeys();

}  // namespace kompono::synthesis

#endif  // KOMPONO_SYNTHESIS_EVALUATION_HPP_
