// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_SDK_MECHANISM_HPP_
#define KOMPONO_SDK_MECHANISM_HPP_

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "kompono/geometry/pose.hpp"
#include "kompono/plugin/interfaces.hpp"
#include "kompono/scalar/jet.hpp"
#include "kompono/scalar/pack.hpp"
#include "kompono/scalar/select.hpp"
#include "kompono/scalar/symbol.hpp"
#include "kompono/sdk/arguments.hpp"
#include "kompono/sdk/forward_batch.hpp"
#include "kompono/sdk/plugin.hpp"

/// The base of a mechanism plugin. The author writes the geometry once, as templates over the
/// scalar:
///
///     class BiGlide final : public kompono::sdk::AutodiffMechanism<BiGlide> {
///      public:
///       static constexpr kompono::sdk::MechanismSpec kSpec{
///           .letters = "XY", .drives = 2, .parameters = 2, .modes = 2, .closures = 2, .points =
///           3};
///       template <class T> void Drives(const Arguments<T>& in, DriveValues<T> out) const;
///       template <class T> void Closure(const Arguments<T>& in, std::span<T> g) const;
///       template <class T> void Skeleton(const Arguments<T>& in, std::span<kompono::Vector3<T>>
///       point) const;
///     };
///     KOMPONO_PLUGIN("org.example.biglide", "1.0.0", KOMPONO_MODULE("biglide", BiGlide))
///
/// and may add, each a template over T,
///     Pose<T> Platform(in) const;            the default is the product of the letters
///     void Coordinates(in, span<T> x) const; closed-form forward kinematics
///     void Home(in, span<T> x) const;        a pose inside the work zone
///     void Linearise(in, span<T> g, span<T> A) const;
///                                            the closure with its derivatives by x, row-major,
///                                            where they are worth writing out for speed
///
/// T is double, Pack, Jet over double, Symbol or Jet over Symbol: no `if` on a T, write
/// Select(Less(a, b), x, y); math functions unqualified after `using std::sqrt;`. Law tests check
/// Closure(x, Drives(x)) = 0 for every such module.
namespace kompono::sdk {

template <class Derived>
class AutodiffMechanism : public plugin::Mechanism {
 public:
  template <class T>
  using Arguments = sdk::Arguments<T>;
  template <class T>
  using DriveValues = sdk::DriveValues<T>;

  /// Default platform: the product of the letters' motions in their order.
  template <class T>
  [[nodiscard]] Pose<T> Platform(const Arguments<T>& in) const {
    Pose<T> X_BP;
    for (std::size_t i = 0; i < Derived::kSpec.letters.size(); ++i) {
      X_BP = X_BP * LetterMotion(Derived::kSpec.letters[i], in.x[i]);
    }
    return X_BP;
  }

  [[nodiscard]] plugin::MechanismShape Shape() const noexcept final { return ShapeOfSpec(); }

  [[nodiscard]] plugin::Status Evaluate(plugin::Quantity quantity,
                                        const plugin::MechanismState& state,
                                        const plugin::MechanismValues& out) const noexcept final {
    try {
      return EvaluateChecked(quantity, state, out);
    } catch (...) {
      return plugin::Status::kException;
    }
  }

  [[nodiscard]] plugin::Status EvaluateBatch(
      plugin::Quantity quantity, const plugin::MechanismBatch& batch) const noexcept final {
    try {
      return EvaluateBatchChecked(quantity, batch);
    } catch (...) {
      return plugin::Status::kException;
    }
  }

  [[nodiscard]] plugin::Status Forward(const plugin::MechanismForward& batch) const noexcept final {
    try {
      if constexpr (Derived::kSpec.closures == Nx()) return ForwardBatch(derived(), batch);
      return plugin::Status::kUnsupported;
    } catch (...) {
      return plugin::Status::kException;
    }
  }

  [[nodiscard]] plugin::Status Record(
      plugin::Quantity quantity,
      bool with_derivatives,
      const plugin::FormulaReceiver& receiver) const noexcept final {
    try {
      return with_derivatives ? RecordWithDerivatives(quantity, receiver)
                              : RecordValues(quantity, receiver);
    } catch (...) {
      return plugin::Status::kException;
    }
  }

 private:
  static constexpr int Nx() { return static_cast<int>(Derived::kSpec.letters.size()); }
  static constexpr int Nq() { return Derived::kSpec.drives; }
  static constexpr int Np() { return Derived::kSpec.parameters; }
  static constexpr int Nm() { return Derived::kSpec.modes; }
  static constexpr plugin::MechanismShape ShapeOfSpec() {
    return {.coordinates = Nx(),
            .drives = Nq(),
            .parameters = Np(),
            .modes = Nm(),
            .closures = Derived::kSpec.closures,
            .points = Derived::kSpec.points};
  }
  static constexpr int kChunk = 8;  ///< derivatives carried in one pass when many are asked for

  [[nodiscard]] const Derived& derived() const { return static_cast<const Derived&>(*this); }

  static constexpr std::size_t Rows(plugin::Quantity quantity) {
    return plugin::RowsOf(ShapeOfSpec(), quantity);
  }
  static constexpr bool ReadsCoordinates(plugin::Quantity quantity) {
    return quantity != plugin::Quantity::kCoordinates && quantity != plugin::Quantity::kHome;
  }
  static constexpr bool ReadsDrives(plugin::Quantity quantity) {
    return quantity == plugin::Quantity::kClosure || quantity == plugin::Quantity::kSkeleton ||
           quantity == plugin::Quantity::kCoordinates;
  }

  /// Storage for one evaluation with scalar T: x, then q, then parameters, then modes, numbered as
  /// the variables of a recorded formula are. Unread inputs stay zero.
  template <class T>
  struct Workspace {
    std::array<T, static_cast<std::size_t>(Nx() + Nq() + Np() + Nm())> variable{};

    [[nodiscard]] Arguments<T> View() const {
      const std::span<const T> all(variable);
      return {.x = all.subspan(0, Count(Nx())),
              .q = all.subspan(Count(Nx()), Count(Nq())),
              .parameter = all.subspan(Count(Nx() + Nq()), Count(Np())),
              .mode = all.subspan(Count(Nx() + Nq() + Np()), Count(Nm()))};
    }
  };
  static constexpr std::size_t Count(int number) { return static_cast<std::size_t>(number); }

  [[nodiscard]] static Arguments<double> In(const plugin::MechanismState& state) {
    return {.x = state.coordinates,
            .q = state.drives,
            .parameter = state.parameters,
            .mode = state.modes};
  }

  template <class T>
  static void Load(const plugin::MechanismState& state, Workspace<T>& workspace) {
    const auto copy = [&workspace](std::span<const double> from, int first) {
      std::transform(
          from.begin(), from.end(), workspace.variable.begin() + first, [](double number) {
            return T(number);
          });
    };
    copy(state.coordinates, 0);
    copy(state.drives, Nx());
    copy(state.parameters, Nx() + Nq());
    copy(state.modes, Nx() + Nq() + Np());
  }

  /// Calls the author's template.
  template <class T>
  [[nodiscard]] plugin::Status Run(plugin::Quantity quantity,
                                   const Arguments<T>& in,
                                   std::span<T> out) const {
    // NOLINTNEXTLINE(bugprone-branch-clone): what a module leaves out is alike
    switch (quantity) {
      case plugin::Quantity::kPlatform:
        derived().Platform(in).Write(out);
        return plugin::Status::kOk;
      case plugin::Quantity::kDrives: {
        std::array<T, static_cast<std::size_t>(Nq())> reach{};
        derived().Drives(in, DriveValues<T>{out, reach});
        return plugin::Status::kOk;
      }
      case plugin::Quantity::kReach: {
        std::array<T, static_cast<std::size_t>(Nq())> q{};
        derived().Drives(in, DriveValues<T>{q, out});
        return plugin::Status::kOk;
      }
      case plugin::Quantity::kClosure:
        derived().Closure(in, out);
        return plugin::Status::kOk;
      case plugin::Quantity::kSkeleton: {
        std::array<Vector3<T>, static_cast<std::size_t>(Derived::kSpec.points)> point;
        derived().Skeleton(in, std::span<Vector3<T>>(point));
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = point[i / 3][static_cast<int>(i % 3)];
        return plugin::Status::kOk;
      }
      case plugin::Quantity::kCoordinates:  // NOLINT(bugprone-branch-clone): with neither hook
        if constexpr (requires { derived().Coordinates(in, out); }) {
          derived().Coordinates(in, out);
          return plugin::Status::kOk;
        }
        return plugin::Status::kUnsupported;
      case plugin::Quantity::kHome:
        if constexpr (requires { derived().Home(in, out); }) {
          derived().Home(in, out);
          return plugin::Status::kOk;
        }
        return plugin::Status::kUnsupported;
    }
    return plugin::Status::kUnsupported;
  }

  static bool SizesAgree(plugin::Quantity quantity,
                         const plugin::MechanismState& state,
                         const plugin::MechanismValues& out) {
    const auto is = [](std::size_t size, int expected) {
      return size == static_cast<std::size_t>(expected);
    };
    const std::size_t rows = Rows(quantity);
    const auto derivative = [rows](std::span<double> span, int columns) {
      return span.empty() || span.size() == rows * static_cast<std::size_t>(columns);
    };
    // What a quantity does not read may be left out, but not have a wrong length: all of it is
    // loaded.
    return (is(state.coordinates.size(), Nx()) ||
            (!ReadsCoordinates(quantity) && state.coordinates.empty())) &&
           (is(state.drives.size(), Nq()) || (!ReadsDrives(quantity) && state.drives.empty())) &&
           is(state.parameters.size(), Np()) && is(state.modes.size(), Nm()) &&
           out.values.size() == rows && derivative(out.by_coordinates, Nx()) &&
           derivative(out.by_drives, Nq()) && derivative(out.by_parameters, Np());
  }

  [[nodiscard]] plugin::Status EvaluateChecked(plugin::Quantity quantity,
                                               const plugin::MechanismState& state,
                                               const plugin::MechanismValues& out) const {
    if (!SizesAgree(quantity, state, out)) return plugin::Status::kBadSize;
    const bool by_others = !out.by_drives.empty() || !out.by_parameters.empty();
    if (!by_others && out.by_coordinates.empty()) {
      return Run<double>(quantity, In(state), out.values);
    }
    if (!by_others) {
      if constexpr (kHasLinearise<Derived>) {
        if (quantity == plugin::Quantity::kClosure) {
          derived().Linearise(In(state), out.values, out.by_coordinates);
          return plugin::Status::kOk;
        }
      }
      return Differentiate<Nx()>(quantity, state, out, 0, Nx());
    }
    plugin::Status status = plugin::Status::kOk;
    const auto pass = [&](bool wanted, int first, int count) {
      for (int i = 0; wanted && i < count && status == plugin::Status::kOk; i += kChunk) {
        status =
            Differentiate<kChunk>(quantity, state, out, first + i, std::min(kChunk, count - i));
      }
    };
    pass(!out.by_coordinates.empty(), 0, Nx());
    pass(!out.by_drives.empty(), Nx(), Nq());
    pass(!out.by_parameters.empty(), Nx() + Nq(), Np());
    return status;
  }

  /// Values and the derivatives by `count` variables from number `first` on, which lie in one group
  /// (x, q or θ).
  template <int N>
  [[nodiscard]] plugin::Status Differentiate(plugin::Quantity quantity,
                                             const plugin::MechanismState& state,
                                             const plugin::MechanismValues& out,
                                             int first,
                                             int count) const {
    using J = Jet<double, N>;
    Workspace<J> workspace;
    Load(state, workspace);
    for (int i = 0; i < count; ++i) workspace.variable[Count(first + i)].v[i] = 1.0;
    std::array<J, MaximalRows()> values{};
    const std::size_t rows = Rows(quantity);
    const plugin::Status status =
        Run<J>(quantity, workspace.View(), std::span<J>(values.data(), rows));
    if (status != plugin::Status::kOk) return status;
    std::span<double> table = out.by_coordinates;
    int columns = Nx();
    int offset = first;
    if (first >= Nx() + Nq()) {
      table = out.by_parameters;
      columns = Np();
      offset = first - Nx() - Nq();
    } else if (first >= Nx()) {
      table = out.by_drives;
      columns = Nq();
      offset = first - Nx();
    }
    for (std::size_t row = 0; row < rows; ++row) {
      out.values[row] = values[row].a;
      for (int i = 0; i < count; ++i) {
        table[row * static_cast<std::size_t>(columns) + static_cast<std::size_t>(offset + i)] =
            values[row].v[i];
      }
    }
    return status;
  }

  static constexpr std::size_t MaximalRows() {
    return std::max({std::size_t{12},
                     static_cast<std::size_t>(Nq()),
                     static_cast<std::size_t>(Nx()),
                     static_cast<std::size_t>(Derived::kSpec.closures),
                     3U * static_cast<std::size_t>(Derived::kSpec.points)});
  }

  [[nodiscard]] plugin::Status EvaluateBatchChecked(plugin::Quantity quantity,
                                                    const plugin::MechanismBatch& batch) const {
    if (batch.parameters.size() != static_cast<std::size_t>(Np()) ||
        batch.modes.size() != static_cast<std::size_t>(Nm()) || batch.values == nullptr ||
        (ReadsCoordinates(quantity) && batch.coordinates == nullptr) ||
        (ReadsDrives(quantity) && batch.drives == nullptr)) {
      return plugin::Status::kBadSize;
    }
    Workspace<Pack> workspace;
    Load({.coordinates = {}, .drives = {}, .parameters = batch.parameters, .modes = batch.modes},
         workspace);
    const std::size_t rows = Rows(quantity);
    std::array<Pack, MaximalRows()> values{};
    for (std::size_t begin = 0; begin < batch.count; begin += kPackLanes) {
      const std::size_t lanes = std::min(kPackLanes, batch.count - begin);
      if (ReadsCoordinates(quantity))
        LoadColumns(batch.coordinates, Nx(), begin, lanes, workspace.variable.data());
      if (ReadsDrives(quantity))
        LoadColumns(batch.drives, Nq(), begin, lanes, workspace.variable.data() + Nx());
      const plugin::Status status =
          Run<Pack>(quantity, workspace.View(), std::span<Pack>(values.data(), rows));
      if (status != plugin::Status::kOk) return status;
      for (std::size_t row = 0; row < rows; ++row) {
        if (lanes == kPackLanes) {
          values[row].Store(batch.values[row] + begin);
        } else {
          for (std::size_t lane = 0; lane < lanes; ++lane) {
            batch.values[row][begin + lane] = values[row][lane];
          }
        }
      }
    }
    return plugin::Status::kOk;
  }

  /// An unfilled pack at the end repeats the last pose.
  static void LoadColumns(
      const double* const* columns, int count, std::size_t begin, std::size_t lanes, Pack* to) {
    for (int i = 0; i < count; ++i) {
      const double* column = columns[i] + begin;
      if (lanes == kPackLanes) {
        to[i] = Pack::Load(column);
      } else {
        std::array<double, kPackLanes> filled{};
        for (std::size_t lane = 0; lane < kPackLanes; ++lane) {
          filled[lane] = column[std::min(lane, lanes - 1)];
        }
        to[i] = Pack::Load(filled.data());
      }
    }
  }

  [[nodiscard]] plugin::Status RecordValues(plugin::Quantity quantity,
                                            const plugin::FormulaReceiver& receiver) const {
    Recording recording;
    Workspace<Symbol> workspace;
    for (int i = 0; i < Nx() + Nq() + Np() + Nm(); ++i)
      workspace.variable[Count(i)] = Recording::Variable(i);
    std::vector<Symbol> values(Rows(quantity));
    const plugin::Status status =
        Run<Symbol>(quantity, workspace.View(), std::span<Symbol>(values));
    if (status == plugin::Status::kOk) Send(recording, values, receiver);
    return status;
  }

  [[nodiscard]] plugin::Status RecordWithDerivatives(
      plugin::Quantity quantity, const plugin::FormulaReceiver& receiver) const {
    using J = Jet<Symbol, Nx()>;
    Recording recording;
    Workspace<J> workspace;
    for (int i = 0; i < Nx() + Nq() + Np() + Nm(); ++i)
      workspace.variable[Count(i)] = J(Recording::Variable(i));
    for (int i = 0; i < Nx(); ++i) workspace.variable[Count(i)].v[i] = Symbol(1.0);
    std::vector<J> values(Rows(quantity));
    const plugin::Status status = Run<J>(quantity, workspace.View(), std::span<J>(values));
    if (status != plugin::Status::kOk) return status;
    std::vector<Symbol> roots;
    roots.reserve(values.size() * (1 + Count(Nx())));
    for (const J& value : values) roots.push_back(value.a);
    for (const J& value : values) {
      for (int i = 0; i < Nx(); ++i) roots.push_back(value.v[i]);
    }
    Send(recording, roots, receiver);
    return status;
  }

  static void Send(Recording& recording,
                   const std::vector<Symbol>& symbols,
                   const plugin::FormulaReceiver& receiver) {
    std::vector<std::int32_t> roots;
    roots.reserve(symbols.size());
    for (const Symbol& symbol : symbols) roots.push_back(recording.Index(symbol));
    const std::span<const KomponoExpressionNode> nodes = recording.nodes();
    receiver.take(receiver.context, nodes.data(), nodes.size(), roots.data(), roots.size());
  }
};

}  // namespace kompono::sdk

#endif  // KOMPONO_SDK_MECHANISM_HPP_
