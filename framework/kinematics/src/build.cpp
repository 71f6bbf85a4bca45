// SPDX-License-Identifier: Apache-2.0
// Layout + registry -> Machine: modules are created, every number gets its place in θ, and the
// formula's path from the workpiece to the tool becomes a list of factors.
#include "geometry_check.hpp"
#include "machine_impl.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::kinematics {
namespace {

/// Six numbers of a frame: "mount.x" … "mount.c"; an axis has "position.x" … "rotation.c".
constexpr std::array<const char*, 6> kFrameNames{"x", "y", "z", "a", "b", "c"};
constexpr std::array<const char*, 6> kAxisFrameNames{
    "position.x", "position.y", "position.z", "rotation.a", "rotation.b", "rotation.c"};

Diagnostic Complaint(const layout::Layout& layout,
                     std::string code,
                     std::string message,
                     std::string help) {
  return {.severity = Severity::kError,
          .code = std::move(code),
          .file = layout.file.string(),
          .span = {},
          .message = std::move(message),
          .help = std::move(help)};
}

class ModelBuilder {
 public:
  ModelBuilder(layout::Layout layout, const plugin::Registry& registry) : registry_(registry) {
    model_ = std::make_shared<Model>();
    model_->layout = std::move(layout);
  }

  std::shared_ptr<const Model> Build(Diagnostics* complaints) {
    // Descriptions first: mechanisms keep pointers to them.
    for (const layout::Block& block : model_->layout.blocks) {
      const plugin::ModuleDescription* description = registry_.Find(block.module);
      model_->descriptions.push_back(description != nullptr ? *description
                                                            : plugin::ModuleDescription{});
    }
    for (std::size_t i = 0; i < model_->layout.blocks.size(); ++i) AddBlock(i, complaints);
    for (std::size_t i = 0; i < model_->layout.axes.size(); ++i) AddAxis(i);
    if (model_->layout.formula.open_base) {
      model_->theta_open_base = AddPlacement("open_base", model_->layout.open_base, true);
    }
    for (std::size_t i = 0; i < model_->layout.ends.size(); ++i) AddEnd(i, complaints);
    return model_;
  }

 private:
  int AddPlacement(const std::string& name,
                   const layout::Placement& placement,
                   bool identifiable,
                   const std::array<const char*, 6>& numbers = kFrameNames) {
    const int first = static_cast<int>(model_->parameters.size());
    for (std::size_t i = 0; i < 6; ++i) {
      model_->parameters.push_back(
          {.name = name + "." + numbers[i],
           .nominal = i < 3 ? placement.position_mm[i] : placement.rotation_rad[i - 3],
           .tolerance = 0.0,
           .angle = i >= 3,
           .identifiable = identifiable});
    }
    return first;
  }

  int AddModuleParameters(const std::string& name,
                          const plugin::ModuleDescription& description,
                          const std::vector<double>& values) {
    const int first = static_cast<int>(model_->parameters.size());
    std::size_t at = 0;
    for (const plugin::ParameterDescription& parameter : description.parameters) {
      for (const std::string& number : parameter.NumberNames()) {
        model_->parameters.push_back(
            {.name = fmt::format("{}.{}", name, number),
             .nominal = values.at(at++),
             .tolerance = parameter.tolerance.value_or(0.0) * parameter.ToInternal(),
             .angle = parameter.angle(),
             .identifiable = parameter.identifiable && !parameter.fixed});
      }
    }
    return first;
  }

  int AddZero(const std::string& name, const layout::Drive& drive, bool rotary, bool identifiable) {
    model_->parameters.push_back({.name = name + ".zero",
                                  .nominal = drive.zero,
                                  .tolerance = 0.0,
                                  .angle = rotary,
                                  .identifiable = identifiable});
    return static_cast<int>(model_->parameters.size()) - 1;
  }

  void AddBlock(std::size_t index, Diagnostics* complaints) {
    const layout::Block& block = model_->layout.blocks[index];
    const plugin::ModuleDescription& description = model_->descriptions[index];
    auto code = registry_.CreateMechanism(block.module);
    if (!code) {
      complaints->push_back(code.error());
      return;
    }
    MechanismModel mechanism;
    mechanism.code = *code;
    mechanism.description = &description;
    mechanism.block = static_cast<int>(index);
    mechanism.modes.assign(block.modes.begin(), block.modes.end());
    mechanism.theta_module = AddModuleParameters(block.name, description, block.parameters);
    mechanism.theta_mount = AddPlacement(block.name + ".mount", block.mount, false);
    mechanism.theta_zero = static_cast<int>(model_->parameters.size());
    for (std::size_t i = 0; i < block.drives.size(); ++i) {
      AddZero(block.name + "." + description.drives[i].name,
              block.drives[i],
              description.drives[i].rotary,
              true);
    }
    model_->mechanisms.push_back(std::move(mechanism));
  }

  void AddAxis(std::size_t index) {
    const layout::Axis& axis = model_->layout.axes[index];
    AxisModel out;
    out.axis = static_cast<int>(index);
    out.theta_frame = AddPlacement(axis.name, axis.frame, false, kAxisFrameNames);
    out.theta_zero = AddZero(axis.name, axis.drive, IsRotaryLetter(axis.letter), false);
    model_->axes.push_back(out);
  }

  void AddEnd(std::size_t index, Diagnostics* complaints) {
    const layout::End& end = model_->layout.ends[index];
    EndModel out;
    out.end = static_cast<int>(index);
    if (!end.module.empty()) {
      const plugin::ModuleDescription* description = registry_.Find(end.module);
      auto code = registry_.CreateUnit(end.module);
      if (!code || description == nullptr) {
        complaints->push_back(
            code ? Complaint(model_->layout, "E0701", "unknown unit '" + end.module + "'", "")
                 : code.error());
        return;
      }
      out.code = *code;
      out.parameter_count = static_cast<int>(end.parameters.size());
      out.theta_module = AddModuleParameters(end.name, *description, end.parameters);
      const auto station =
          std::find(description->stations.begin(), description->stations.end(), end.station);
      out.station = station == description->stations.end()
                        ? 0
                        : static_cast<int>(station - description->stations.begin());
    }
    out.theta_mount = AddPlacement(end.name + ".mount", end.mount, false);
    model_->ends.push_back(std::move(out));
  }

  std::shared_ptr<Model> model_;
  const plugin::Registry& registry_;
};

using Path = std::vector<const formula::Item*>;

/// The items on the way between the base and the leaf called `name` (empty: the first leaf), in the
/// order of the text.
bool FindPath(const formula::Chain& chain, std::string_view name, Path* path) {
  bool found = false;
  for (const formula::Item& item : chain) {
    if (const auto* fork = std::get_if<formula::Fork>(&item)) {
      for (const formula::Chain& branch : fork->branches) {
        Path inner;
        if (!found && FindPath(branch, name, &inner)) {
          path->insert(path->end(), inner.begin(), inner.end());
          found = true;
        }
      }
    } else if (const auto* leaf = std::get_if<formula::Leaf>(&item)) {
      if (!found && (name.empty() || leaf->Name() == name)) {
        path->push_back(&item);
        found = true;
      }
    } else {
      path->push_back(&item);
    }
  }
  return found;
}

void LeafNames(const formula::Chain& chain, std::vector<std::string>* names) {
  for (const formula::Item& item : chain) {
    if (const auto* leaf = std::get_if<formula::Leaf>(&item)) names->push_back(leaf->Name());
    if (const auto* fork = std::get_if<formula::Fork>(&item)) {
      for (const formula::Chain& branch : fork->branches) LeafNames(branch, names);
    }
  }
}

class ChainBuilder {
 public:
  explicit ChainBuilder(std::shared_ptr<const Model> model) {
    impl_ = std::make_shared<Machine::Impl>();
    impl_->model = std::move(model);
    impl_->mechanisms = impl_->model->mechanisms;
    impl_->axes = impl_->model->axes;
  }

  std::shared_ptr<const Machine::Impl> Build(const Path& left, const Path& right) {
    for (const formula::Item* item : left) Add(*item, true);
    if (layout().formula.open_base) impl_->factors.push_back({Factor::Kind::kOpenBase, 0, false});
    for (const formula::Item* item : right) Add(*item, false);
    return impl_;
  }

 private:
  [[nodiscard]] const layout::Layout& layout() const { return impl_->model->layout; }

  void Add(const formula::Item& item, bool inverse) {
    if (const auto* axis = std::get_if<formula::Axis>(&item)) {
      if (axis->block.empty()) {
        AddAxis(*axis, inverse);
      } else {  // "B:table": a mechanism of one letter
        AddGroup({.axes = {*axis}, .orientation = {}, .block = axis->block}, inverse);
      }
    }
    if (const auto* group = std::get_if<formula::Group>(&item)) AddGroup(*group, inverse);
    if (const auto* leaf = std::get_if<formula::Leaf>(&item)) AddLeaf(*leaf, inverse);
  }

  void AddAxis(const formula::Axis& item, bool inverse) {
    for (std::size_t i = 0; i < impl_->axes.size(); ++i) {
      AxisModel& axis = impl_->axes[i];
      const layout::Axis& of = layout().axes[static_cast<std::size_t>(axis.axis)];
      if (of.name != item.Name()) continue;
      impl_->factors.push_back({Factor::Kind::kAxis, static_cast<int>(i), inverse});
      if (of.main_motion) return;  // turns, but is not positioned
      const bool rotary = IsRotaryLetter(of.letter);
      axis.coordinate = static_cast<int>(impl_->coordinates.size());
      axis.drive = static_cast<int>(impl_->drives.size());
      Coordinate coordinate{
          .name = of.name, .letter = of.letter, .rotary = rotary, .home = of.home};
      const auto at = [&of](const std::optional<double>& reading) {
        return reading ? std::optional(of.drive.zero + of.drive.sign * *reading) : std::nullopt;
      };
      coordinate.lower = of.drive.sign > 0 ? at(of.drive.lower) : at(of.drive.upper);
      coordinate.upper = of.drive.sign > 0 ? at(of.drive.upper) : at(of.drive.lower);
      impl_->coordinates.push_back(coordinate);
      impl_->drives.push_back(DriveOf(of.name, rotary, of.drive));
      return;
    }
  }

  void AddGroup(const formula::Group& group, bool inverse) {
    for (std::size_t i = 0; i < impl_->mechanisms.size(); ++i) {
      MechanismModel& mechanism = impl_->mechanisms[i];
      const layout::Block& block = layout().blocks[static_cast<std::size_t>(mechanism.block)];
      if (!Realises(block, group)) continue;
      impl_->factors.push_back({Factor::Kind::kMechanism, static_cast<int>(i), inverse});
      mechanism.coordinate.assign(block.letters.size(), -1);
      const std::vector<double> home = HomeOf(mechanism, block);
      for (const formula::Axis& axis : group.axes) {
        for (std::size_t local = 0; local < block.letters.size(); ++local) {
          if (block.letters[local].axis != axis.Name()) continue;
          mechanism.coordinate[local] = static_cast<int>(impl_->coordinates.size());
          impl_->coordinates.push_back({.name = block.name + "." + axis.Name(),
                                        .letter = axis.letter,
                                        .rotary = axis.rotary(),
                                        .home = home[local],
                                        .lower = block.lower[local],
                                        .upper = block.upper[local]});
        }
      }
      mechanism.first_drive = static_cast<int>(impl_->drives.size());
      for (std::size_t k = 0; k < block.drives.size(); ++k) {
        const plugin::DriveDescription& drive = mechanism.description->drives[k];
        impl_->drives.push_back(
            DriveOf(block.name + "." + drive.name, drive.rotary, block.drives[k]));
      }
      return;
    }
  }

  void AddLeaf(const formula::Leaf& leaf, bool inverse) {
    for (std::size_t i = 0; i < impl_->model->ends.size(); ++i) {
      const layout::End& end = layout().ends[static_cast<std::size_t>(impl_->model->ends[i].end)];
      if (end.name == EndName(leaf)) {
        impl_->factors.push_back({Factor::Kind::kEnd, static_cast<int>(i), inverse});
        return;
      }
    }
  }

  /// Ends are named without the plane: "part_xy" is "part".
  static std::string EndName(const formula::Leaf& leaf) {
    formula::Leaf bare = leaf;
    bare.plane.clear();
    return bare.Name();
  }

  static bool Realises(const layout::Block& block, const formula::Group& group) {
    if (!group.block.empty()) return block.name == group.block;
    return block.letters.size() == group.axes.size() &&
           std::all_of(group.axes.begin(), group.axes.end(), [&block](const formula::Axis& axis) {
             return std::any_of(block.letters.begin(),
                                block.letters.end(),
                                [&axis](const auto& letter) { return letter.axis == axis.Name(); });
           });
  }

  static Drive DriveOf(std::string name, bool rotary, const layout::Drive& drive) {
    return {.name = std::move(name),
            .rotary = rotary,
            .lower = drive.lower,
            .upper = drive.upper,
            .speed = drive.speed,
            .acceleration = drive.acceleration,
            .stiffness = drive.stiffness};
  }

  /// The layout's home, else the module's own, else zero; in the sense of the formula's letters.
  [[nodiscard]] std::vector<double> HomeOf(const MechanismModel& mechanism,
                                           const layout::Block& block) const {
    VectorXd theta(static_cast<Eigen::Index>(impl_->model->parameters.size()));
    for (std::size_t i = 0; i < impl_->model->parameters.size(); ++i) {
      theta[static_cast<Eigen::Index>(i)] = impl_->model->parameters[i].nominal;
    }
    const Evaluation own =
        Evaluate(mechanism, plugin::Quantity::kHome, VectorXd(), VectorXd(), theta, {});
    std::vector<double> home(block.letters.size(), 0.0);
    for (std::size_t i = 0; i < home.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const bool known = own.status == plugin::Status::kOk && std::isfinite(own.values[k]);
      home[i] = block.home[i].value_or(known ? block.letters[i].sign * own.values[k] : 0.0);
    }
    return home;
  }

  std::shared_ptr<Machine::Impl> impl_;
};

Parsed<std::shared_ptr<const Machine::Impl>> BuildChain(const std::shared_ptr<const Model>& model,
                                                        std::string_view part,
                                                        std::string_view tool) {
  const auto path_to =
      [&model](const formula::Chain& chain, std::string_view name, Path* path, Diagnostics* bad) {
        if (FindPath(chain, name, path)) return;
        std::vector<std::string> names;
        LeafNames(chain, &names);
        bad->push_back(Complaint(model->layout,
                                 "E0702",
                                 fmt::format("the formula has no '{}' on that side", name),
                                 DidYouMean(name, names)));
      };
  Path left;
  Path right;
  Diagnostics complaints;
  path_to(model->layout.formula.left, part, &left, &complaints);
  path_to(model->layout.formula.right, tool, &right, &complaints);
  if (!complaints.empty()) return tl::unexpected(std::move(complaints));
  return ChainBuilder(model).Build(left, right);
}

}  // namespace

Parsed<Machine> Machine::Build(layout::Layout layout, const plugin::Registry& registry) {
  Diagnostics complaints;
  ModelBuilder builder(std::move(layout), registry);
  const std::shared_ptr<const Model> model = builder.Build(&complaints);
  if (complaints.empty()) CheckGeometry(*model, &complaints);
  if (!complaints.empty()) return tl::unexpected(std::move(complaints));
  auto impl = BuildChain(model, "", "");
  if (!impl) return tl::unexpected(std::move(impl.error()));
  return Machine(std::move(*impl));
}

Parsed<Machine> Machine::Between(std::string_view part, std::string_view tool) const {
  auto impl = BuildChain(impl_->model, part, tool);
  if (!impl) return tl::unexpected(std::move(impl.error()));
  return Machine(std::move(*impl));
}

}  // namespace kompono::kinematics
