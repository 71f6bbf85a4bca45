// SPDX-License-Identifier: Apache-2.0
#include "column_check.hpp"

#include "residuals.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kompono/calibration/codes.hpp"
#include "kompono/kinematics/linearisation.hpp"

namespace kompono::calibration {
namespace {

constexpr std::size_t kSampleRows = 40;
constexpr std::size_t kForwardRows = 10;   ///< where every candidate needs the forward problem
constexpr std::size_t kJudgedRows = 2000;  ///< whose distance to nominal is looked at
constexpr double kSuspicious = 1.0;        ///< mm; smaller errors no column explains
constexpr double kGain = 8.0;              ///< by which a change must lower the error
constexpr double kUnreached = 1000.0;      ///< mm; what a row without a pose counts
constexpr double kRadianLengthMm = 100.0;
constexpr double kFarFactor = 10.0;
constexpr double kSlip = 50.0;         ///< mm; a machine or an instrument is not that far off ...
constexpr double kSlipFactor = 100.0;  ///< ... while its other rows are so much nearer

using Errors = std::vector<double>;  ///< of rows, mm

double Median(Errors values) {
  if (values.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A change of a row that may explain its error.
struct Candidate {
  std::string code;
  Role role = Role::kIgnored;
  int first = 0, second = -1;  ///< columns of the role
  std::string message, help;
  std::function<void(Measurement*)> apply;
};

class ColumnCheck {
 public:
  ColumnCheck(const kinematics::Machine& machine,
              const MeasurementSet& set,
              const TableRow& header,
              const Columns& columns,
              bool keep_slips,
              Complaints& complaints)
      : machine_(machine),
        set_(set),
        header_(header),
        columns_(columns),
        keep_slips_(keep_slips),
        complaints_(complaints),
        values_(AllNominal(machine, set)),
        linear_(machine, {}) {
    linear_.SetGeometry(machine.nominal());
    const std::size_t stride = set.measurements.size() / kSampleRows + 1;
    for (std::size_t i = 0; i < set.measurements.size(); i += stride) {
      sample_.push_back(&set.measurements[i]);
    }
  }

  void Run() {
    if (sample_.size() < 4) return;
    const Errors before = ForwardErrors(sample_, {});
    if (Median(before) > kSuspicious && ExplainedByMeasured(before)) return;
    if (ExplainedByReadings(before)) return;
    NameFarRows();
    NameContradictions();
  }

 private:
  [[nodiscard]] FixtureValues Fixtures() const {
    return {.fixtures = &set_.fixtures, .value = values_.data() + machine_.parameters().size()};
  }

  /// Errors of rows after a change, mm.
  Errors ForwardErrors(const std::vector<const Measurement*>& rows,
                       const std::function<void(Measurement*)>& change) {
    Errors errors;
    std::size_t failed = 0;
    for (const Measurement* row : rows) {
      if (2 * failed > rows.size()) return Errors(rows.size(), kUnreached);
      Measurement changed = *row;
      if (change) change(&changed);
      const RowModel model(machine_, changed, 1.0, 1.0);
      const RowModel::Prediction prediction = model.Predict(values_, false);
      if (!prediction.ok()) {
        ++failed;
        errors.push_back(kUnreached);
        continue;
      }
      const RowErrors e = model.Errors(prediction, Fixtures());
      const double unmet = Unmet(changed.readings, prediction.first.coordinates);
      errors.push_back(
          std::min(e.LengthNorm() + kRadianLengthMm * e.AngleNorm() + unmet, kUnreached));
    }
    return errors;
  }

  /// What the readings at the predicted coordinates lack of those given, mm: where squared lengths
  /// are solved for, a leg's sign does not show in the pose.
  double Unmet(const Eigen::VectorXd& given, const Eigen::VectorXd& z) {
    if (!linear_.At(z, kinematics::Linearisation::Depth::kByCoordinates)) return kUnreached;
    return LengthOf(linear_.readings() - given);
  }

  /// Of differences between readings, a radian counting kRadianLengthMm.
  [[nodiscard]] double LengthOf(const Eigen::VectorXd& difference) const {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < difference.size(); ++i) {
      const bool rotary = machine_.drives()[static_cast<std::size_t>(i)].rotary;
      sum += std::abs(difference[i]) * (rotary ? kRadianLengthMm : 1.0);
    }
    return sum;
  }

  /// A slip of a column shows in most of the rows; what makes some rows better is no slip of it.
  static bool Explains(const Errors& before, const Errors& after) {
    std::size_t better = 0;
    for (std::size_t i = 0; i < before.size(); ++i) better += after[i] * kGain < before[i] ? 1 : 0;
    return 3 * better >= 2 * before.size() && Median(after) * kGain < Median(before);
  }

  /// Names the candidate that makes the errors smallest, if it explains them.
  bool TellBest(const Errors& before,
                const std::vector<Candidate>& candidates,
                const std::function<Errors(const std::function<void(Measurement*)>&)>& errors_of) {
    const Candidate* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const Candidate& candidate : candidates) {
      const Errors after = errors_of(candidate.apply);
      if (!Explains(before, after) || Median(after) >= least) continue;
      least = Median(after);
      best = &candidate;
    }
    if (best == nullptr) return false;
    Tell(*best, Median(before), least);
    return true;
  }

  void Tell(const Candidate& candidate, double before, double after) {
    const int column = std::max(0, columns_.Find(candidate.role, candidate.first));
    complaints_.Error(candidate.code,
                      header_.cells[static_cast<std::size_t>(column)],
                      fmt::format("{}: the median error against the nominal machine is {:.4g} mm, "
                                  "and {:.4g} mm after the change (rows from line {} on)",
                                  candidate.message,
                                  before,
                                  after,
                                  sample_.front()->line),
                      candidate.help);
  }

  [[nodiscard]] std::string HeaderOf(Role role, int index) const {
    const int column = columns_.Find(role, index);
    return column < 0 ? std::string("?")
                      : std::string(header_.cells[static_cast<std::size_t>(column)].text);
  }

  bool ExplainedByMeasured(const Errors& before) {
    std::vector<Candidate> candidates;
    const Role role = Role::kPosition;
    for (int i = 0; i < 3; ++i) {
      if (columns_.Find(role, i) < 0) continue;
      const auto at = static_cast<std::size_t>(i);
      candidates.push_back(Negated(role, i, [at](Measurement* m) {
        if (m->position_mm[at]) *m->position_mm[at] *= -1.0;
      }));
      for (const double factor : {1e3, 1e-3}) {
        candidates.push_back(Scaled(role, i, factor, [at, factor](Measurement* m) {
          if (m->position_mm[at]) *m->position_mm[at] *= factor;
        }));
      }
      for (int j = i + 1; j < 3; ++j) {
        if (columns_.Find(role, j) < 0) continue;
        const auto other = static_cast<std::size_t>(j);
        candidates.push_back(Swapped(role, i, j, [at, other](Measurement* m) {
          std::swap(m->position_mm[at], m->position_mm[other]);
        }));
      }
    }
    if (columns_.Has(Role::kRotationVector)) AddRotations(&candidates);
    return TellBest(
        before, candidates, [this](const auto& change) { return ForwardErrors(sample_, change); });
  }

  static void AddRotations(std::vector<Candidate>* candidates) {
    const Role role = Role::kRotationVector;
    Candidate inverse{.code = codes::kNegated.code,
                      .role = role,
                      .message =
                          "it looks as if the rotations are those of the workpiece in the "
                          "tool and not the reverse",
                      .help = "negate rx, ry and rz",
                      .apply = [](Measurement* m) { m->R_WT.transposeInPlace(); }};
    candidates->push_back(std::move(inverse));
    for (int i = 0; i < 3; ++i) {
      for (int j = i + 1; j < 3; ++j) {
        candidates->push_back(
            {.code = codes::kSwapped.code,
             .role = role,
             .first = i,
             .second = j,
             .message = fmt::format("it looks as if r{} and r{} are swapped", "xyz"[i], "xyz"[j]),
             .help = "give the columns their right names",
             .apply = [i, j](Measurement* m) {
               Eigen::Vector3d r = RotationVector(m->R_WT);
               std::swap(r[i], r[j]);
               m->R_WT = RotationFromVector(r);
             }});
      }
    }
  }

  [[nodiscard]] Candidate Negated(Role role, int i, std::function<void(Measurement*)> apply) const {
    return {.code = codes::kNegated.code,
            .role = role,
            .first = i,
            .message = fmt::format("it looks as if {} has the wrong sign", HeaderOf(role, i)),
            .help = "negate the column, or set the drive's direction in the layout",
            .apply = std::move(apply)};
  }
  [[nodiscard]] Candidate Swapped(Role role,
                                  int i,
                                  int j,
                                  std::function<void(Measurement*)> apply) const {
    return {.code = codes::kSwapped.code,
            .role = role,
            .first = i,
            .second = j,
            .message = fmt::format(
                "it looks as if {} and {} are swapped", HeaderOf(role, i), HeaderOf(role, j)),
            .help = "give the columns their right names",
            .apply = std::move(apply)};
  }
  [[nodiscard]] Candidate Scaled(Role role,
                                 int i,
                                 double factor,
                                 std::function<void(Measurement*)> apply) const {
    return {.code = codes::kWrongScale.code,
            .role = role,
            .first = i,
            .message = fmt::format("it looks as if {} is in {} while the others are not",
                                   HeaderOf(role, i),
                                   factor > 1.0 ? "metres" : "micrometres"),
            .help = "give all lengths in millimetres",
            .apply = std::move(apply)};
  }

  [[nodiscard]] std::vector<Candidate> OfReadings() const {
    std::vector<Candidate> candidates;
    const auto drives = static_cast<int>(machine_.drives().size());
    for (int i = 0; i < drives; ++i) {
      candidates.push_back(Negated(Role::kReading, i, [i](Measurement* m) {
        m->readings[i] *= -1.0;
        if (m->second_readings.size() > 0) m->second_readings[i] *= -1.0;
      }));
      for (const double factor : {1e3, 1e-3}) {
        if (machine_.drives()[static_cast<std::size_t>(i)].rotary) continue;
        candidates.push_back(Scaled(Role::kReading, i, factor, [i, factor](Measurement* m) {
          m->readings[i] *= factor;
          if (m->second_readings.size() > 0) m->second_readings[i] *= factor;
        }));
      }
      for (int j = i + 1; j < drives; ++j) {
        candidates.push_back(Swapped(Role::kReading, i, j, [i, j](Measurement* m) {
          std::swap(m->readings[i], m->readings[j]);
          if (m->second_readings.size() > 0) {
            std::swap(m->second_readings[i], m->second_readings[j]);
          }
        }));
      }
    }
    return candidates;
  }

  /// Where the measured numbers determine the coordinates, the nominal machine says what each drive
  /// should have read; else every candidate needs the forward problem.
  bool ExplainedByReadings(const Errors& before) {
    const std::vector<Candidate> candidates = OfReadings();
    const std::vector<std::pair<const Measurement*, Eigen::VectorXd>> expected = Expected();
    if (expected.size() < 4) {
      if (Median(before) <= kSuspicious) return false;
      std::vector<const Measurement*> few = sample_;
      few.resize(std::min(few.size(), kForwardRows));
      const Errors of_few(before.begin(), before.begin() + static_cast<std::ptrdiff_t>(few.size()));
      return TellBest(of_few, candidates, [this, &few](const auto& change) {
        return ForwardErrors(few, change);
      });
    }
    const auto off = [&](const std::function<void(Measurement*)>& change) {
      Errors errors;
      for (const auto& [row, readings] : expected) errors.push_back(Off(*row, readings, change));
      return errors;
    };
    const Errors as_given = off({});
    return Median(as_given) > kSuspicious && TellBest(as_given, candidates, off);
  }

  /// By how much the readings of a row, changed, are not those expected, mm.
  [[nodiscard]] double Off(const Measurement& row,
                           const Eigen::VectorXd& expected,
                           const std::function<void(Measurement*)>& change) const {
    Measurement changed = row;
    if (change) change(&changed);
    return LengthOf(changed.readings - expected);
  }

  [[nodiscard]] std::vector<std::pair<const Measurement*, Eigen::VectorXd>> Expected() const {
    std::vector<std::pair<const Measurement*, Eigen::VectorXd>> expected;
    for (const Measurement* row : sample_) {
      const bool plain =
          row->kind == MeasurementKind::kPosition || row->kind == MeasurementKind::kPose;
      if (!plain || row->target >= 0 ||
          row->Numbers() < static_cast<int>(machine_.coordinates().size())) {
        continue;
      }
      kinematics::PoseTarget target;
      target.order = machine_.layout().rotation_order;
      for (std::size_t i = 0; i < 3; ++i) target.component[i] = row->position_mm[i];
      if (row->kind == MeasurementKind::kPose) {
        Pose<double> X_WT;
        X_WT.R = row->R_WT;
        const kinematics::PoseNumbers numbers = kinematics::NumbersFromPose(X_WT, target.order);
        for (std::size_t i = 3; i < 6; ++i) target.component[i] = numbers.value[i];
      }
      const kinematics::Solution solution = machine_.Inverse(target);
      if (solution.ok()) expected.emplace_back(row, solution.drives);
    }
    return expected;
  }

  /// Rows whose error is far above that of the others.
  void NameFarRows() {
    const std::size_t count = std::min(set_.measurements.size(), kJudgedRows);
    std::vector<double> errors;
    for (std::size_t i = 0; i < count; ++i) {
      RowModel model(machine_, set_.measurements[i], 1.0, 1.0);
      const RowModel::Prediction prediction = model.Predict(values_, false);
      const bool ok = prediction.ok();
      errors.push_back(ok ? model.Errors(prediction, Fixtures()).LengthNorm() : -1.0);
    }
    std::vector<double> known;
    for (const double error : errors) {
      if (error >= 0.0) known.push_back(error);
    }
    const double usual = Median(known);
    for (std::size_t i = 0; i < count; ++i) {
      if (errors[i] <= std::max(kSuspicious, kFarFactor * usual)) continue;
      NameFarRow(set_.measurements[i].line, errors[i], usual);
    }
  }

  void NameFarRow(int line, double error, double usual) {
    const std::string message = fmt::format(
        "the row is {:.4g} mm away from what the nominal machine predicts, the "
        "others {:.4g} mm",
        error,
        usual);
    if (!keep_slips_ && error > std::max(kSlip, kSlipFactor * usual)) {
      AboutLine(line,
                Severity::kError,
                codes::kSlip.code,
                message,
                "mend or remove the row (a unit, a sign, a digit?), or have it left out with "
                "--outliers reject");
    } else {
      AboutLine(line,
                Severity::kWarning,
                codes::kFarRow.code,
                message,
                "look for a slip in this row; it will be left out if it stands out after the fit "
                "too");
    }
  }

  /// The same readings and different measurements.
  void NameContradictions() {
    std::map<std::vector<double>, const Measurement*> seen;
    for (const Measurement& m : set_.measurements) {
      std::vector<double> key(m.readings.begin(), m.readings.end());
      key.insert(key.end(), m.second_readings.begin(), m.second_readings.end());
      key.push_back(static_cast<double>(m.kind));
      key.push_back(static_cast<double>(m.target));
      key.push_back(static_cast<double>(m.fixture));
      const auto [first, is_new] = seen.emplace(std::move(key), &m);
      if (is_new) continue;
      const Measurement& other = *first->second;
      double difference = std::abs(m.value_mm - other.value_mm);
      for (std::size_t i = 0; i < 3; ++i) {
        if (!m.position_mm[i] || !other.position_mm[i]) continue;
        difference = std::max(difference, std::abs(*m.position_mm[i] - *other.position_mm[i]));
      }
      if (difference < std::max(0.05, 10.0 * m.sigma_mm.value_or(0.0))) continue;
      AboutLine(m.line,
                Severity::kWarning,
                codes::kSameReadings.code,
                fmt::format("the row has the readings of line {}, but measured {:.4g} mm beside it",
                            other.line,
                            difference),
                "one of the two has a slip, or the machine does not repeat");
    }
  }

  void AboutLine(
      int line, Severity severity, std::string code, std::string message, std::string help) {
    std::size_t begin = 0;
    for (int i = 1; i < line && begin < set_.text.size(); ++i) {
      begin = set_.text.find('\n', begin) + 1;
    }
    const std::size_t end = std::min(set_.text.find('\n', begin), set_.text.size());
    complaints_.Add(severity, std::move(code), begin, end, std::move(message), std::move(help));
  }

  const kinematics::Machine& machine_;
  const MeasurementSet& set_;
  const TableRow& header_;
  const Columns& columns_;
  bool keep_slips_;
  Complaints& complaints_;
  Eigen::VectorXd values_;
  kinematics::Linearisation linear_;
  std::vector<const Measurement*> sample_;
};

}  // namespace

void CheckColumns(const kinematics::Machine& machine,
                  const MeasurementSet& set,
                  const TableRow& header,
                  const Columns& columns,
                  bool keep_slips,
                  Complaints& complaints) {
  ColumnCheck(machine, set, header, columns, keep_slips, complaints).Run();
}

}  // namespace kompono::calibration
