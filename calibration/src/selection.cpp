// SPDX-License-Identifier: Apache-2.0
#include "selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::calibration {
namespace {

/// `*` matches any characters, everything else itself; linear in the product of the lengths.
bool MatchesGlob(std::string_view pattern, std::string_view name) {
  std::size_t p = 0;
  std::size_t n = 0;
  std::size_t star = std::string_view::npos;
  std::size_t resume = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++p;
      ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++resume;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

/// What one unit of u is: the manufacturing tolerance; where none is known, much less is known of
/// where a block stands than of where its drive's zero is.
double ScaleOf(const kinematics::Parameter& parameter) {
  if (parameter.tolerance > 0.0) return parameter.tolerance;
  if (parameter.name.ends_with(".zero")) return parameter.angle ? 1e-4 : 0.1;
  return parameter.angle ? 1e-2 : 10.0;
}

class Selector {
 public:
  Selector(const kinematics::Machine& machine,
           const MeasurementSet& set,
           const IdentifyOptions& options)
      : machine_(machine), set_(set), options_(options), chosen_(machine.parameters().size()) {}

  Parsed<Selection> Select() {
    ChooseFree();
    ChooseLocked();
    Selection selection;
    selection.nominal = machine_.nominal();
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      if (chosen_[i]) selection.free.push_back(static_cast<int>(i));
    }
    if (selection.free.empty() && complaints_.empty()) {
      Complain("E0432", "no parameter is free, so that there is nothing to identify");
    }
    selection.scale.resize(selection.size());
    for (std::size_t i = 0; i < selection.free.size(); ++i) {
      selection.scale[static_cast<Eigen::Index>(i)] = ScaleOf(At(selection.free[i]));
    }
    GivePriors(&selection);
    GiveBounds(&selection);
    if (!complaints_.empty()) return tl::unexpected(std::move(complaints_));
    return selection;
  }

 private:
  [[nodiscard]] const kinematics::Parameter& At(int index) const {
    return machine_.parameters()[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] const layout::CalibrationSettings& settings() const {
    return machine_.layout().calibration;
  }

  void ChooseFree() {
    if (!options_.free.empty()) {
      Mark(options_.free, true, "free");
    } else if (!settings().free.empty()) {
      Mark(settings().free, true, "the layout's [calibration] free");
    } else if (!set_.suggested_free.empty()) {
      Mark(set_.suggested_free, true, set_.origin);
    } else {
      for (std::size_t i = 0; i < chosen_.size(); ++i) {
        chosen_[i] = machine_.parameters()[i].identifiable;
      }
    }
  }

  void ChooseLocked() {
    if (options_.free.empty()) Mark(settings().lock, false, "the layout's [calibration] lock");
    Mark(options_.lock, false, "lock");
  }

  void Mark(const std::vector<std::string>& patterns, bool value, std::string_view where) {
    for (const std::string& pattern : patterns) {
      for (const int index : Matching(pattern, where)) {
        chosen_[static_cast<std::size_t>(index)] = value;
      }
    }
  }

  std::vector<int> Matching(const std::string& pattern, std::string_view where) {
    std::vector<int> matching;
    for (std::size_t i = 0; i < machine_.parameters().size(); ++i) {
      if (MatchesPattern(pattern, machine_.parameters()[i].name)) {
        matching.push_back(static_cast<int>(i));
      }
    }
    if (matching.empty()) complaints_.push_back(UnknownPattern(machine_, pattern, where));
    return matching;
  }

  /// Calls `give` for every free parameter that a pattern of the layout and then of the options
  /// matches.
  template <class Value, class Give>
  void ForEach(const std::map<std::string, Value>& of_layout,
               const std::map<std::string, Value>& of_options,
               std::string_view what,
               const Selection& selection,
               const Give& give) {
    for (const auto* source : {&of_layout, &of_options}) {
      for (const auto& [pattern, value] : *source) {
        for (const int index : Matching(pattern, what)) {
          const auto found = std::lower_bound(selection.free.begin(), selection.free.end(), index);
          if (found == selection.free.end() || *found != index) continue;
          give(static_cast<std::size_t>(found - selection.free.begin()), value);
        }
      }
    }
  }

  void GivePriors(Selection* selection) {
    selection->prior.resize(selection->free.size());
    ForEach(settings().prior_sigma,
            options_.prior_sigma,
            "prior_sigma",
            *selection,
            [this, selection](std::size_t i, double sigma) {
              if (!(sigma > 0.0)) {
                Complain("E0433",
                         fmt::format("the prior deviation of {} must be greater than 0",
                                     At(selection->free[i]).name));
              }
              selection->prior[i] = sigma;
            });
  }

  void GiveBounds(Selection* selection) {
    selection->bounds.resize(selection->free.size());
    ForEach(settings().bounds,
            options_.bounds,
            "bounds",
            *selection,
            [this, selection](std::size_t i, const std::array<double, 2>& bounds) {
              if (!(bounds[0] < bounds[1])) {
                Complain("E0433",
                         fmt::format("the bounds of {} leave no room between {:g} and {:g}",
                                     At(selection->free[i]).name,
                                     bounds[0],
                                     bounds[1]));
              }
              selection->bounds[i] = bounds;
            });
  }

  void Complain(std::string code, std::string message) {
    complaints_.push_back({.code = std::move(code),
                           .file = machine_.layout().file.string(),
                           .message = std::move(message)});
  }

  const kinematics::Machine& machine_;
  const MeasurementSet& set_;
  const IdentifyOptions& options_;
  std::vector<bool> chosen_;
  Diagnostics complaints_;
};

}  // namespace

bool MatchesPattern(std::string_view pattern, std::string_view name) {
  if (MatchesGlob(pattern, name)) return true;
  return name.size() > pattern.size() && name.starts_with(pattern) &&
         (name[pattern.size()] == '.' || name[pattern.size()] == '[');
}

Eigen::VectorXd Selection::Theta(const double* u) const {
  Eigen::VectorXd theta = nominal;
  for (Eigen::Index i = 0; i < size(); ++i) {
    theta[free[static_cast<std::size_t>(i)]] += scale[i] * u[i];
  }
  return theta;
}

Eigen::VectorXd Selection::Unknowns(const Eigen::VectorXd& theta) const {
  Eigen::VectorXd u(size());
  for (Eigen::Index i = 0; i < size(); ++i) {
    const int index = free[static_cast<std::size_t>(i)];
    u[i] = (theta[index] - nominal[index]) / scale[i];
  }
  return u;
}

Diagnostic UnknownPattern(const kinematics::Machine& machine,
                          std::string_view pattern,
                          std::string_view where) {
  std::set<std::string> known;
  for (const kinematics::Parameter& parameter : machine.parameters()) {
    known.insert(parameter.name);
    for (std::size_t i = 0; i < parameter.name.size(); ++i) {
      if (parameter.name[i] == '.' || parameter.name[i] == '[') {
        known.insert(parameter.name.substr(0, i));
      }
    }
  }
  const std::vector<std::string> names(known.begin(), known.end());
  return {.code = "E0431",
          .file = machine.layout().file.string(),
          .message = fmt::format("no parameter is called '{}' ({})", pattern, where),
          .help = DidYouMean(pattern, names)};
}

Parsed<Selection> SelectUnknowns(const kinematics::Machine& machine,
                                 const MeasurementSet& set,
                                 const IdentifyOptions& options) {
  return Selector(machine, set, options).Select();
}

}  // namespace kompono::calibration
