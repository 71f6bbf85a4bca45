// SPDX-License-Identifier: Apache-2.0
#include "geometry_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/SVD>

#include "kompono/layout/places.hpp"

namespace kompono::kinematics {
namespace {

constexpr double kNothing = 1e-10;  ///< of the mechanism's size, or of a direction
constexpr int kProbes = 60;
constexpr int kFarProbes = 2000;  ///< when home is not given and not reached

/// One element of a parameter: a number, or a point of three numbers.
struct Element {
  const plugin::ParameterDescription* parameter = nullptr;
  int index = 0;           ///< in the list
  Eigen::Index first = 0;  ///< in the module's numbers
  int numbers = 1;

  [[nodiscard]] std::string Name() const {
    return parameter->count > 1 ? fmt::format("{}[{}]", parameter->name, index + 1)
                                : parameter->name;
  }
};

std::vector<Element> ElementsOf(const plugin::ModuleDescription& description) {
  std::vector<Element> elements;
  for (const plugin::ParameterDescription& parameter : description.parameters) {
    const bool points = parameter.shape == plugin::ParameterShape::kPoint ||
                        parameter.shape == plugin::ParameterShape::kPoints;
    const int numbers = points ? 3 : 1;
    for (int i = 0; i < parameter.Numbers() / numbers; ++i) {
      elements.push_back({&parameter, i, parameter.offset + i * numbers, numbers});
    }
  }
  return elements;
}

std::string Joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += fmt::format("'{}'", names[i]);
  }
  return text;
}

/// One mechanism of the layout, at home and around it.
class BlockCheck {
 public:
  BlockCheck(const Model& model, const MechanismModel& mechanism, Diagnostics* complaints)
      : model_(model),
        mechanism_(mechanism),
        block_(model.layout.blocks[static_cast<std::size_t>(mechanism.block)]),
        elements_(ElementsOf(*mechanism.description)),
        theta_(static_cast<Eigen::Index>(model.parameters.size())),
        complaints_(complaints) {
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
      theta_[static_cast<Eigen::Index>(i)] = model.parameters[i].nominal;
    }
    size_ = Size();
    home_ = Home();
  }

  void Run() {
    const std::vector<VectorXd> probes = Probes(kProbes, 0.3);
    if (FindUndefined(probes)) return;
    std::vector<VectorXd> reached = Reached(probes);
    const bool home_reached = !Reached({home_}).empty();
    if (!home_reached && !home_given_ && reached.empty())
      reached = Reached(Probes(kFarProbes, 1.5));
    if (!home_reached && (home_given_ || reached.empty())) return ComplainOfReach();
    if (FindLegWithoutLength()) return;
    FindSingularEverywhere(reached);
  }

 private:
  [[nodiscard]] Evaluation At(plugin::Quantity quantity,
                              const VectorXd& x,
                              const VectorXd& q,
                              const VectorXd& theta,
                              Wanted wanted = {}) const {
    return Evaluate(mechanism_, quantity, x, q, theta, wanted);
  }
  [[nodiscard]] VectorXd Numbers(const Element& element) const {
    return theta_.segment(mechanism_.theta_module + element.first, element.numbers);
  }
  [[nodiscard]] const std::string& DriveName(Eigen::Index i) const {
    return mechanism_.description->drives[static_cast<std::size_t>(i)].name;
  }

  /// The greatest length among the numbers, or distance between points of one list.
  [[nodiscard]] double Size() const {
    double size = 0.0;
    for (const Element& a : elements_) {
      if (a.parameter->angle()) continue;
      if (a.numbers == 1) size = std::max(size, std::abs(Numbers(a)[0]));
      for (const Element& b : elements_) {
        if (a.numbers == 3 && b.parameter == a.parameter)
          size = std::max(size, (Numbers(a) - Numbers(b)).norm());
      }
    }
    return size > 0.0 ? size : 1.0;
  }

  VectorXd Home() {
    const Evaluation own = At(plugin::Quantity::kHome, VectorXd(), VectorXd(), theta_);
    VectorXd home(static_cast<Eigen::Index>(block_.letters.size()));
    for (std::size_t i = 0; i < block_.letters.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const bool known = own.status == plugin::Status::kOk && std::isfinite(own.values[k]);
      home[k] = known ? own.values[k] : 0.0;
      if (block_.home[i]) home[k] = block_.letters[i].sign * *block_.home[i];
      home_given_ = home_given_ || block_.home[i].has_value();
    }
    return home;
  }

  /// Home and poses round it, always the same ones.
  [[nodiscard]] std::vector<VectorXd> Probes(int count, double spread) const {
    std::mt19937 random(7);  // the same answer in every run
    std::vector<VectorXd> probes{home_};
    for (int k = 0; k < count; ++k) {
      VectorXd x = home_;
      for (Eigen::Index i = 0; i < x.size(); ++i) {
        const double uniform = static_cast<double>(random()) / 2147483648.0 - 1.0;
        const bool rotary =
            IsRotaryLetter(mechanism_.description->letters[static_cast<std::size_t>(i)]);
        x[i] += uniform * (rotary ? 0.3 : spread * size_);
      }
      probes.push_back(std::move(x));
    }
    return probes;
  }

  [[nodiscard]] std::vector<VectorXd> Reached(const std::vector<VectorXd>& probes) const {
    std::vector<VectorXd> reached;
    for (const VectorXd& x : probes) {
      const VectorXd q = At(plugin::Quantity::kDrives, x, VectorXd(), theta_).values;
      const VectorXd reach = At(plugin::Quantity::kReach, x, VectorXd(), theta_).values;
      if (q.allFinite() && (reach.array() >= 0.0).all()) reached.push_back(x);
    }
    return reached;
  }

  void Complain(const std::string& code,
                const std::vector<std::string>& keys,
                std::optional<std::size_t> element,
                std::string message,
                std::string help) {
    std::vector<std::string> path{"block", block_.name};
    path.insert(path.end(), keys.begin(), keys.end());
    complaints_->push_back({.severity = Severity::kError,
                            .code = code,
                            .file = model_.layout.file.string(),
                            .span = layout::PlaceOf(model_.layout, path, element),
                            .message = std::move(message),
                            .help = std::move(help)});
  }
  void ComplainAt(const Element& element,
                  const std::string& code,
                  std::string message,
                  std::string help) {
    Complain(code,
             {"parameters", element.parameter->name},
             static_cast<std::size_t>(element.index),
             std::move(message),
             std::move(help));
  }

  /// A drive whose reach is no number at any pose: a direction made of nothing, or numbers so large
  /// that their squares overflow.
  bool FindUndefined(const std::vector<VectorXd>& probes) {
    bool found = false;
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(block_.drives.size()); ++i) {
      const bool undefined = std::none_of(probes.begin(), probes.end(), [&](const VectorXd& x) {
        return std::isfinite(At(plugin::Quantity::kReach, x, VectorXd(), theta_).values[i]);
      });
      if (!undefined) continue;
      found = true;
      std::vector<const Element*> causes;
      causes.reserve(elements_.size());
      for (const Element& element : elements_) {
        VectorXd moved = theta_;
        for (int k = 0; k < element.numbers; ++k) {
          moved[mechanism_.theta_module + element.first + k] += 1e-3 * size_ * (k + 1);
        }
        if (std::isfinite(At(plugin::Quantity::kReach, home_, VectorXd(), moved).values[i]))
          causes.push_back(&element);
      }
      ComplainOfUndefined(i, causes);
    }
    return found;
  }

  void ComplainOfUndefined(Eigen::Index drive, const std::vector<const Element*>& causes) {
    std::vector<std::string> names;
    names.reserve(causes.size());
    for (const Element* cause : causes) names.push_back(cause->Name());
    const bool coincide =
        causes.size() > 1 && std::all_of(causes.begin(), causes.end(), [&](const Element* cause) {
          return cause->numbers == causes.front()->numbers &&
                 Numbers(*cause) == Numbers(*causes.front());
        });
    std::string message =
        coincide ? fmt::format("{} of '{}' coincide, so that its drive {} has no direction",
                               Joined(names),
                               block_.name,
                               DriveName(drive))
                 : fmt::format("the drive {} of '{}' cannot be computed at any pose",
                               DriveName(drive),
                               block_.name);
    const std::string help = coincide ? "give two different points"
                                      : "look for numbers that are too large or contradict another";
    if (causes.empty()) return Complain("E0703", {"parameters"}, {}, message, help);
    ComplainAt(*causes.back(), "E0703", message, help);
  }

  /// Home, or everything, is out of reach; says which length would do, where one alone can.
  void ComplainOfReach() {
    const Evaluation reach =
        At(plugin::Quantity::kReach, home_, VectorXd(), theta_, {.by_parameters = true});
    Eigen::Index drive = 0;
    reach.values.minCoeff(&drive);
    const std::string where = home_given_ ? "its home" : "any pose near the middle";
    const Element* length = nullptr;
    double best = 0.0;
    for (const Element& element : elements_) {
      if (element.numbers != 1 || element.parameter->angle()) continue;
      const double gain = reach.by_parameters(drive, element.first) * Numbers(element)[0];
      if (gain > best) {
        best = gain;
        length = &element;
      }
    }
    const double needed = length != nullptr ? LengthNeeded(drive, *length) : 0.0;
    std::string message = fmt::format(
        "'{}' does not reach {}: the leg of {} is too short", block_.name, where, DriveName(drive));
    if (!(needed > 0.0)) {
      return Complain("E0704",
                      {home_given_ ? "home" : "parameters"},
                      {},
                      std::move(message),
                      "bring home and the points of the geometry nearer to one another");
    }
    ComplainAt(
        *length,
        "E0704",
        std::move(message),
        fmt::format("home needs '{}' of at least {:.6g} mm instead of {:.6g} mm; or move home "
                    "and the points of the geometry nearer to one another",
                    length->Name(),
                    needed,
                    Numbers(*length)[0]));
  }

  /// The least length with which home is within the drive's reach; 0 if there is none.
  [[nodiscard]] double LengthNeeded(Eigen::Index drive, const Element& length) const {
    const Eigen::Index at = mechanism_.theta_module + length.first;
    const auto reach_with = [&](double value) {
      VectorXd longer = theta_;
      longer[at] = value;
      return At(plugin::Quantity::kReach, home_, VectorXd(), longer).values[drive];
    };
    double low = theta_[at];
    double high = low;
    for (int i = 0; i < 60 && !(reach_with(high) >= 0.0); ++i) high *= 1.5;
    if (!(reach_with(high) >= 0.0)) return 0.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (reach_with(middle) >= 0.0 ? high : low) = middle;
    }
    return high;
  }

  [[nodiscard]] MatrixXd ClosureByCoordinates(const VectorXd& x,
                                              MatrixXd* by_parameters = nullptr) const {
    const VectorXd q = At(plugin::Quantity::kDrives, x, VectorXd(), theta_).values;
    const Evaluation g = At(plugin::Quantity::kClosure,
                            x,
                            q,
                            theta_,
                            {.by_coordinates = true, .by_parameters = by_parameters != nullptr});
    if (by_parameters != nullptr) *by_parameters = g.by_parameters;
    return g.by_coordinates;
  }

  /// The elements that the closure of each of the legs holds, where both legs have the same value.
  [[nodiscard]] std::vector<const Element*> Shared(const MatrixXd& by_parameters,
                                                   Eigen::Index leg,
                                                   Eigen::Index other) const {
    const auto held = [&](const Element& element, Eigen::Index row) {
      return by_parameters.row(row).segment(element.first, element.numbers).norm() > 0.0;
    };
    std::vector<const Element*> shared;
    for (const Element& a : elements_) {
      for (const Element& b : elements_) {
        if (a.parameter == b.parameter && a.index < b.index && held(a, leg) && !held(a, other) &&
            held(b, other) && (Numbers(a) - Numbers(b)).norm() <= kNothing * size_) {
          shared.push_back(&a);
          shared.push_back(&b);
        }
      }
    }
    return shared;
  }

  /// A pod whose two joints coincide at home: its closure does not notice the platform.
  bool FindLegWithoutLength() {
    const MatrixXd A = ClosureByCoordinates(home_);
    bool found = false;
    for (Eigen::Index i = 0; i < A.rows() && home_given_; ++i) {
      if (!(A.row(i).norm() <= kNothing * size_)) continue;
      found = true;
      Complain(
          "E0705",
          {"home"},
          {},
          fmt::format("the leg of {} of '{}' has no length at home", DriveName(i), block_.name),
          "move home away from the joint on the base");
    }
    return found;
  }

  /// A with scaled rows at each pose; empty if that cannot be judged.
  [[nodiscard]] std::vector<MatrixXd> ScaledAt(const std::vector<VectorXd>& poses) const {
    std::vector<MatrixXd> scaled;
    for (const VectorXd& x : poses) {
      const MatrixXd A = ClosureByCoordinates(x);
      if (!A.allFinite() || A.rows() != A.cols()) return {};
      scaled.push_back(ScaleJacobians(mechanism_, A, MatrixXd()).A);
    }
    return scaled;
  }

  [[nodiscard]] static bool AllSingular(const std::vector<MatrixXd>& scaled) {
    return scaled.size() >= 4 && std::all_of(scaled.begin(), scaled.end(), [](const MatrixXd& A) {
             return A.jacobiSvd().singularValues().minCoeff() <= kNothing;
           });
  }

  [[nodiscard]] static bool RowsAgree(const std::vector<MatrixXd>& scaled,
                                      Eigen::Index i,
                                      Eigen::Index j) {
    return std::all_of(scaled.begin(), scaled.end(), [i, j](const MatrixXd& A) {
      return std::min((A.row(i) - A.row(j)).norm(), (A.row(i) + A.row(j)).norm()) <= kNothing;
    });
  }

  void FindSingularEverywhere(const std::vector<VectorXd>& reached) {
    const std::vector<MatrixXd> scaled = ScaledAt(reached);
    if (!AllSingular(scaled)) return;
    bool named = false;
    for (Eigen::Index i = 0; i < scaled.front().rows(); ++i) {
      for (Eigen::Index j = i + 1; j < scaled.front().rows(); ++j) {
        if (RowsAgree(scaled, i, j)) named = ComplainOfTwins(i, j, reached.back()) || named;
      }
    }
    if (named || IsMatterOfMode()) return;
    Complain("E0707",
             {"parameters"},
             {},
             fmt::format("'{}' is singular at every pose: its drives do not hold the platform",
                         block_.name),
             "look for joints on one line, or equal shapes of base and platform");
  }

  /// Whether another assembly mode of the same geometry is regular somewhere, as of a lambda whose
  /// equal links lie on each other in one mode only. Such numbers are a mechanism.
  [[nodiscard]] bool IsMatterOfMode() const {
    for (std::size_t i = 0; i < mechanism_.modes.size(); ++i) {
      MechanismModel other = mechanism_;
      other.modes[i] = -other.modes[i];
      const BlockCheck turned(model_, other, nullptr);
      const std::vector<VectorXd> reached = turned.Reached(turned.Probes(kProbes, 0.3));
      if (reached.size() >= 4 && !AllSingular(turned.ScaledAt(reached))) return true;
    }
    return false;
  }

  [[nodiscard]] bool AllAlike(const Element& element) const {
    return std::all_of(elements_.begin(), elements_.end(), [&](const Element& other) {
      return other.parameter != element.parameter || Numbers(other) == Numbers(element);
    });
  }

  /// False if no numbers of the two legs coincide, so that it is not they that are to blame. At x
  /// away from home, where symmetry hides what a leg depends on.
  bool ComplainOfTwins(Eigen::Index leg, Eigen::Index other, const VectorXd& x) {
    MatrixXd by_parameters;
    static_cast<void>(ClosureByCoordinates(x, &by_parameters));
    std::vector<const Element*> shared = Shared(by_parameters, leg, other);
    if (shared.empty()) return false;
    // What all legs have alike, such as the length of their struts, is seldom the reason.
    const auto telling =
        std::stable_partition(shared.begin(), shared.end(), [this](const Element* element) {
          return !AllAlike(*element);
        });
    if (telling != shared.begin()) shared.erase(telling, shared.end());
    std::vector<std::string> names;
    names.reserve(shared.size());
    for (const Element* element : shared) names.push_back(element->Name());
    ComplainAt(*shared[1],
               "E0706",
               fmt::format("the legs of {} and {} of '{}' are one and the same: {} coincide",
                           DriveName(leg),
                           DriveName(other),
                           block_.name,
                           Joined(names)),
               "put one of their joints elsewhere");
    return true;
  }

  const Model& model_;
  const MechanismModel& mechanism_;
  const layout::Block& block_;
  std::vector<Element> elements_;
  VectorXd theta_;
  Diagnostics* complaints_;
  double size_ = 1.0;
  bool home_given_ = false;
  VectorXd home_;
};

}  // namespace

void CheckGeometry(const Model& model, Diagnostics* complaints) {
  for (const MechanismModel& mechanism : model.mechanisms) {
    BlockCheck(model, mechanism, complaints).Run();
  }
}

}  // namespace kompono::kinematics
