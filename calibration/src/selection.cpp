// SPDX-License-Identifier: Apache-2.0
#include "selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kompono/calibration/codes.hpp"
#include "kompono/diagnostics/suggestion.hpp"
#include "kompono/layout/numbers.hpp"

namespace kompono::calibration {
namespace {

/// Other forms of a parameter's name that layouts accept: "open_base.position.x" of "open_base.x"
/// and the reverse, "tool.length" of "P_z.length" if the table is called [tool].
std::vector<std::string> NamesOf(const layout::Layout& layout, const std::string& name) {
  std::vector<std::string> names{name};
  const std::size_t dot = name.rfind('.');
  const std::size_t letter =
      dot + 2 == name.size() ? std::string_view("xyzabc").find(name.back()) : std::string::npos;
  if (letter != std::string::npos) {
    const std::string_view key = letter < 3 ? ".position" : ".rotation";
    const std::string owner = name.substr(0, dot);
    names.push_back(owner.ends_with(key)
                        ? owner.substr(0, owner.size() - key.size()) + name.substr(dot)
                        : owner + std::string(key) + name.substr(dot));
  }
  for (const layout::End& end : layout.ends) {
    if (end.table == end.name || !name.starts_with(end.name + ".")) continue;
    const std::size_t count = names.size();
    for (std::size_t i = 0; i < count; ++i) {
      names.push_back(end.table + names[i].substr(end.name.size()));
    }
  }
  return names;
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
      : machine_(machine),
        set_(set),
        options_(options),
        parameters_(AllParameters(machine, set)),
        chosen_(parameters_.size()) {}

  Parsed<Selection> Select() {
    ChooseFree();
    // What is not known of the instrument has to be found whatever of the machine is asked for.
    for (std::size_t i = machine_.parameters().size(); i < chosen_.size(); ++i) {
      chosen_[i] = chosen_[i] || parameters_[i].identifiable;
    }
    ChooseLocked();
    Selection selection;
    selection.nominal = AllNominal(machine_, set_);
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      if (chosen_[i]) selection.free.push_back(static_cast<int>(i));
    }
    if (selection.free.empty() && complaints_.empty()) {
      Complain(codes::kNothingFree.code,
               "no parameter is free, so that there is nothing to identify");
    }
    selection.scale.resize(selection.size());
    for (std::size_t i = 0; i < selection.free.size(); ++i) {
      selection.scale[static_cast<Eigen::Index>(i)] = ScaleOf(At(selection.free[i]));
    }
    GivePriors(&selection);
    GiveBounds(&selection);
    selection.parameters = parameters_;
    if (!complaints_.empty()) return tl::unexpected(std::move(complaints_));
    return selection;
  }

 private:
  [[nodiscard]] const kinematics::Parameter& At(int index) const {
    return parameters_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] const layout::CalibrationSettings& settings() const {
    return machine_.layout().calibration;
  }

  void ChooseFree() {
    Mark(options_.free, true, "free");
    for (const ParameterGroup group : options_.groups) MarkGroup(group);
    if (!options_.free.empty() || !options_.groups.empty()) return;
    if (!settings().free.empty()) {
      Mark(settings().free, true, "the layout's [calibration] free");
    } else if (!set_.suggested_free.empty()) {
      Mark(set_.suggested_free, true, set_.origin);
    } else {
      for (std::size_t i = 0; i < chosen_.size(); ++i) {
        chosen_[i] = parameters_[i].identifiable;
      }
    }
    KeepSuggested();
  }

  void MarkGroup(ParameterGroup group) {
    for (std::size_t i = 0; i < machine_.parameters().size(); ++i) {
      const ParameterGroup of = GroupOf(parameters_[i].name);
      if (group != ParameterGroup::kAll && group != of) continue;
      chosen_[i] = chosen_[i] || parameters_[i].identifiable || of == ParameterGroup::kFrames;
    }
  }

  /// What a format knows not to be visible in its files is not fitted for being in the layout.
  void KeepSuggested() {
    if (set_.suggested_free.empty()) return;
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      const std::string& name = parameters_[i].name;
      chosen_[i] = chosen_[i] && std::any_of(set_.suggested_free.begin(),
                                             set_.suggested_free.end(),
                                             [&name](const std::string& pattern) {
                                               return layout::MatchesPattern(pattern, name);
                                             });
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
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      if (NamesParameter(machine_, pattern, parameters_[i].name)) {
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
                Complain(codes::kBadPrior.code,
                         fmt::format("the prior deviation of {} must be greater than 0",
                                     At(selection->free[i]).name));
              }
              selection->prior[i] = sigma;
            });
    if (options_.prior_tolerances < 0.0) {
      Complain(codes::kBadPrior.code, "priors of a negative number of tolerances make no sense");
    }
    if (options_.prior_tolerances <= 0.0) return;
    for (std::size_t i = 0; i < selection->free.size(); ++i) {
      const double tolerance = At(selection->free[i]).tolerance;
      if (selection->prior[i] || tolerance <= 0.0) continue;
      selection->prior[i] = options_.prior_tolerances * tolerance;
    }
  }

  void GiveBounds(Selection* selection) {
    selection->bounds.resize(selection->free.size());
    ForEach(settings().bounds,
            options_.bounds,
            "bounds",
            *selection,
            [this, selection](std::size_t i, const std::array<double, 2>& bounds) {
              if (!(bounds[0] < bounds[1])) {
                Complain(codes::kBadPrior.code,
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
  std::vector<kinematics::Parameter> parameters_;
  std::vector<bool> chosen_;
  Diagnostics complaints_;
};

}  // namespace

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

std::string_view Name(ParameterGroup group) {
  switch (group) {
    case ParameterGroup::kOffsets:
      return "offsets";
    case ParameterGroup::kFrames:
      return "frames";
    case ParameterGroup::kGeometry:
      return "geometry";
    case ParameterGroup::kAll:
      break;
  }
  return "all";
}

ParameterGroup GroupOf(std::string_view parameter) {
  if (parameter.ends_with(".zero")) return ParameterGroup::kOffsets;
  for (const std::string_view frame : {".mount.", ".position.", ".rotation.", "open_base."}) {
    if (parameter.find(frame) != std::string_view::npos) return ParameterGroup::kFrames;
  }
  return ParameterGroup::kGeometry;
}

bool NamesParameter(const kinematics::Machine& machine,
                    std::string_view pattern,
                    const std::string& name) {
  const std::vector<std::string> names = NamesOf(machine.layout(), name);
  return std::any_of(names.begin(), names.end(), [pattern](const std::string& form) {
    return layout::MatchesPattern(pattern, form);
  });
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
  return {.code = codes::kUnknownParameter.code,
          .file = machine.layout().file.string(),
          .message = fmt::format("no parameter is called '{}' ({})", pattern, where),
          .help = DidYouMean(pattern, names)};
}

Parsed<Selection> SelectUnknowns(const kinematics::Machine& machine,
                                 const MeasurementSet& set,
                                 const IdentifyOptions& options) {
  return Selector(machine, set, options).Select();
}

Diagnostics JudgeOptions(const kinematics::Machine& machine,
                         const MeasurementSet& set,
                         const IdentifyOptions& options) {
  Parsed<Selection> selection = SelectUnknowns(machine, set, options);
  return selection ? Diagnostics{} : std::move(selection.error());
}

}  // namespace kompono::calibration
