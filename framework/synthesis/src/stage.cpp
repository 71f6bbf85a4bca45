// SPDX-License-Identifier: Apache-2.0
#include "kompono/synthesis/stage.hpp"

#include "budget.hpp"
#include "required_zone.hpp"
#include "shared_results.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>

#include <Eigen/QR>

#include "kompono/analysis/abilities.hpp"
#include "kompono/analysis/mobility.hpp"
#include "kompono/formula/equivalence.hpp"
#include "kompono/plugin/capability_words.hpp"
#include "kompono/synthesis/sizing.hpp"

namespace kompono::synthesis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using kinematics::Machine;

constexpr double kRadian_mm = 100.0;  ///< what a radian counts in the rank of twists
constexpr double kRankThreshold = 1e-6;

/// What an item or a chain's end adds to the structural metrics.
struct Counts {
  int drives = 0, parts = 0, passive_joints = 0;
  void Add(const Counts& other) {
    drives += other.drives;
    parts += other.parts;
    passive_joints += other.passive_joints;
  }
};

Counts CountsOfModule(const plugin::ModuleDescription& module) {
  Counts out{.drives = static_cast<int>(module.drives.size()),
             .parts = static_cast<int>(module.drives.size()) + 1};
  if (!module.structure) return out;
  out.parts = module.structure->links - 1;
  for (const auto& [letter, count] : module.structure->pairs) out.passive_joints += count;
  out.passive_joints -= out.drives;
  return out;
}

/// Of an end's own chain; mechanisms in it count by their letters.
Counts CountsOfChain(const formula::Chain& chain) {
  Counts out;
  for (const formula::Item& item : chain) {
    if (const auto* axis = std::get_if<formula::Axis>(&item)) {
      if (axis->orientation == formula::Orientation::kNone) out.Add({1, 1, 0});
    } else if (const auto* group = std::get_if<formula::Group>(&item)) {
      const int n = static_cast<int>(group->axes.size());
      out.Add({n, n, 0});
    } else if (const auto* fork = std::get_if<formula::Fork>(&item)) {
      for (const formula::Chain& branch : fork->branches) {
        for (int i = 0; i < fork->count; ++i) out.Add(CountsOfChain(branch));
      }
    }
  }
  return out;
}

bool Names(const plugin::ModuleDescription& module, std::string_view capability) {
  return std::find(module.capabilities.begin(), module.capabilities.end(), capability) !=
         module.capabilities.end();
}

/// A spindle turns the tool about its own axis, and so does a jet without one: another turn about
/// it is no use.
bool TurnsItsTool(const EndChoice& end, const plugin::Registry& registry) {
  const bool by_unit = std::any_of(end.units.begin(), end.units.end(), [&](const auto& unit) {
    const plugin::ModuleDescription* module = registry.Find(unit);
    return module != nullptr && Names(*module, plugin::words::kMainMotion);
  });
  const formula::Chain& chain = end.chain;
  return by_unit || std::any_of(chain.begin(), chain.end(), [](const formula::Item& item) {
           const auto* axis = std::get_if<formula::Axis>(&item);
           const auto* leaf = std::get_if<formula::Leaf>(&item);
           return (axis != nullptr && axis->orientation != formula::Orientation::kNone) ||
                  (leaf != nullptr && leaf->kind == formula::LeafKind::kProcess);
         });
}

struct MobilityResult {
  int mobility = 0;  ///< rank of the tool's twists
  int used = 0;      ///< less a turn about the tool's own axis
  int passive_constraints = 0;
};

/// Somewhere beside home, where nothing is aligned by chance.
VectorXd BesideHome(const Machine& machine) {
  VectorXd z = machine.home();
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const bool rotary = machine.coordinates()[static_cast<std::size_t>(i)].rotary;
    z[i] += (rotary ? 0.31 : 7.0) * (1.0 + 0.37 * static_cast<double>(i));
  }
  return z;
}

int RankOf(const MatrixXd& columns) {
  if (columns.cols() == 0) return 0;
  Eigen::ColPivHouseholderQR<MatrixXd> qr(columns);
  qr.setThreshold(kRankThreshold);
  return static_cast<int>(qr.rank());
}

MobilityResult MobilityOf(const Machine& machine, char process_direction) {
  kinematics::PoseDerivatives derivatives;
  const Pose<double> X_WT = machine.ToolPose(BesideHome(machine), machine.nominal(), &derivatives);
  const Eigen::Vector3d axis = X_WT.R.col(process_direction == 'x'   ? 0
                                          : process_direction == 'y' ? 1
                                                                     : 2);
  MatrixXd twists = derivatives.by_coordinates;
  MobilityResult out;
  twists.bottomRows<3>() *= kRadian_mm;
  out.mobility = RankOf(twists);
  for (Eigen::Index i = 0; i < twists.cols(); ++i) {
    const Eigen::Vector3d omega = twists.col(i).tail<3>();
    twists.col(i).tail<3>() = omega.cross(axis);
  }
  out.used = RankOf(twists);
  for (const analysis::BlockMobility& block : analysis::Mobility(machine))
    out.passive_constraints += block.passive;
  return out;
}

/// A problem's sentence with its code, for a row.
std::string ReasonOf(const Diagnostics& problems) {
  if (problems.empty()) return "the layout cannot be built";
  return fmt::format("{} [{}]", problems.front().message, problems.front().code);
}

/// A row that ends here.
struct Rejection {
  EvaluationStatus status = EvaluationStatus::kRejected;
  std::string reason;
};
using Verdict = std::optional<Rejection>;

std::string WithUnit(double value, const MetricDescription& metric) {
  return metric.unit == "1" ? fmt::format("{:g}", value)
                            : fmt::format("{:g} {}", value, metric.unit);
}

Verdict Reject(std::string reason) {
  return Rejection{.reason = std::move(reason)};
}

}  // namespace

struct Evaluator::State {
  State(const StudySpace& of, const EvaluationSettings& with) : space(&of), settings(with) {
    const Study& study = space->study();
    for (const Item& item : space->items()) {
      const plugin::ModuleDescription* module =
          item.module < 0
              ? nullptr
              : space->registry().Find(study.modules[static_cast<std::size_t>(item.module)].module);
      items.push_back(module == nullptr ? Counts{1, 1, 0} : CountsOfModule(*module));
    }
    for (const EndChoice& end : study.ends) {
      ends.push_back(CountsOfChain(end.chain));
      turns_its_tool.push_back(!end.part && TurnsItsTool(end, space->registry()));
    }
    const auto wants = [](MetricId id, const auto& list) {
      return std::any_of(list.begin(), list.end(), [id](const auto& entry) {
        return entry.metric == DescriptionOf(id).name;
      });
    };
    wants_abilities =
        wants(MetricId::kAbilities, study.objectives) || wants(MetricId::kAbilities, study.limits);
  }

  void SetStructure(const Candidate& candidate, Evaluation& row) const;
  Verdict PassMobility(const Candidate& candidate,
                       const formula::Formula& formula,
                       std::optional<Machine>& machine,
                       Evaluation& row) const;
  Verdict PassSizing(const Candidate& candidate,
                     std::optional<Machine>& machine,
                     std::vector<Size>& sizes,
                     Evaluation& row) const;
  Verdict PassZone(const Machine& machine, const RequiredZone& zone, Evaluation& row) const;
  Verdict PassBudget(const Machine& machine, const RequiredZone& zone, Evaluation& row) const;
  Verdict PassAll(const Candidate& candidate, Evaluation& row) const;

  /// The first limit on a metric of the row's stage that is not kept.
  [[nodiscard]] Verdict CheckLimits(const Evaluation& row) const;
  Verdict Build(const Candidate& candidate,
                const std::vector<Size>& sizes,
                std::optional<Machine>& machine) const;
  [[nodiscard]] std::string MobilityKey(const Candidate& candidate,
                                        const formula::Formula& formula) const;
  [[nodiscard]] std::vector<FreeNumber> FreeNumbers(const Candidate::Block& block,
                                                    const Machine::BlockView& view) const;
  void SizeBlock(const Candidate& candidate,
                 const Candidate::Block& block,
                 const Machine& machine,
                 const RequiredZone& zone,
                 std::vector<Size>& sizes) const;

  const StudySpace* space;
  EvaluationSettings settings;
  std::vector<Counts> items, ends;
  std::vector<bool> turns_its_tool;
  bool wants_abilities = false;
  mutable SharedResults<MobilityResult> mobility;
  mutable SharedResults<SizingResult> sizing;
};

void Evaluator::State::SetStructure(const Candidate& candidate, Evaluation& row) const {
  Counts counts = ends[static_cast<std::size_t>(candidate.part_end)];
  counts.Add(ends[static_cast<std::size_t>(candidate.tool_end)]);
  int on_part = 0;
  int on_tool = 0;
  int part_motions = 0;
  for (const Candidate::Placed& placed : candidate.chain) {
    const auto item = static_cast<std::size_t>(placed.item);
    counts.Add(items[item]);
    ++(placed.part_side ? on_part : on_tool);
    if (placed.part_side) part_motions += static_cast<int>(space->items()[item].motions.size());
  }
  row.metrics.Set(MetricId::kDriveCount, counts.drives);
  row.metrics.Set(MetricId::kPartCount, counts.parts);
  row.metrics.Set(MetricId::kPassiveJoints, counts.passive_joints);
  row.metrics.Set(MetricId::kStack, std::max(on_part, on_tool));
  row.metrics.Set(MetricId::kPartMotions, part_motions);
  row.metrics.Set(MetricId::kFoundations, candidate.open_base ? 2.0 : 1.0);
}

Verdict Evaluator::State::CheckLimits(const Evaluation& row) const {
  for (const Limit& limit : space->study().limits) {
    const MetricDescription* metric = FindMetric(limit.metric);
    if (metric == nullptr || metric->stage != row.stage || !row.metrics.Has(metric->id)) continue;
    const double value = row.metrics[metric->id];
    if (limit.lower && value < *limit.lower)
      return Reject(fmt::format("{} below {}", metric->name, WithUnit(*limit.lower, *metric)));
    if (limit.upper && value > *limit.upper)
      return Reject(fmt::format("{} above {}", metric->name, WithUnit(*limit.upper, *metric)));
  }
  return std::nullopt;
}

Verdict Evaluator::State::Build(const Candidate& candidate,
                                const std::vector<Size>& sizes,
                                std::optional<Machine>& machine) const {
  const Parsed<layout::Layout> layout =
      layout::ParseLayout(LayoutText(*space, candidate, sizes), "candidate", space->registry());
  if (!layout)
    return Rejection{.status = EvaluationStatus::kFailed, .reason = ReasonOf(layout.error())};
  Parsed<Machine> built = Machine::Build(*layout, space->registry());
  if (!built)
    return Rejection{.status = EvaluationStatus::kFailed, .reason = ReasonOf(built.error())};
  machine = std::move(*built);
  return std::nullopt;
}

std::string Evaluator::State::MobilityKey(const Candidate& candidate,
                                          const formula::Formula& formula) const {
  std::string key = formula::RelativeMotionKey(formula);
  key += fmt::format("|{}|{}", candidate.part_end, candidate.tool_end);
  for (const Candidate::Block& block : candidate.blocks)
    key += fmt::format("|{} {} {} {}", block.module, block.item, block.mount, block.mode);
  return key;
}

Verdict Evaluator::State::PassMobility(const Candidate& candidate,
                                       const formula::Formula& formula,
                                       std::optional<Machine>& machine,
                                       Evaluation& row) const {
  row.stage = Stage::kMobility;
  const Study& study = space->study();
  const std::string key = MobilityKey(candidate, formula);
  auto shared = mobility.Find(key);
  if (!shared) {
    if (Verdict failure = Build(candidate, {}, machine)) return failure;
    shared = mobility.Put(key, MobilityOf(*machine, study.process_direction));
  }
  row.metrics.Set(MetricId::kMobility, shared->mobility);
  row.metrics.Set(MetricId::kPassiveConstraints, shared->passive_constraints);
  const int required = static_cast<int>(study.motions.size());
  if (shared->mobility < required) return Reject("the required motions depend on one another");
  if (turns_its_tool[static_cast<std::size_t>(candidate.tool_end)] &&
      shared->used < std::min(required, 5))
    return Reject("a turn about the tool's own axis does nothing");
  return CheckLimits(row);
}

std::vector<FreeNumber> Evaluator::State::FreeNumbers(const Candidate::Block& block,
                                                      const Machine::BlockView& view) const {
  std::vector<FreeNumber> out;
  const StudyModule& module = space->study().modules[static_cast<std::size_t>(block.module)];
  for (const StudyParameter& parameter : module.parameters) {
    if (!parameter.levels.empty() || !parameter.range) continue;
    FreeNumber free{
        .lower = parameter.range->lower, .upper = parameter.range->upper, .start = parameter.start};
    if (parameter.coordinate >= 0) {
      const auto local = static_cast<std::size_t>(parameter.coordinate);
      free.coordinate = view.coordinates[local];
      free.sign = view.block->letters[local].sign;
    }
    for (int i = 0; parameter.coordinate < 0 && i < parameter.count; ++i)
      free.numbers.push_back(view.first_parameter + parameter.offset + i);
    out.push_back(std::move(free));
  }
  return out;
}

void Evaluator::State::SizeBlock(const Candidate& candidate,
                                 const Candidate::Block& block,
                                 const Machine& machine,
                                 const RequiredZone& zone,
                                 std::vector<Size>& sizes) const {
  const StudyModule& module = space->study().modules[static_cast<std::size_t>(block.module)];
  const std::vector<Machine::BlockView> views = machine.blocks();
  const auto view = std::find_if(views.begin(), views.end(), [&module](const auto& v) {
    return v.block->name == module.name;
  });
  if (view == views.end()) return;
  const std::vector<FreeNumber> free = FreeNumbers(block, *view);
  if (free.empty()) return;
  // Only its own coordinates: with the others the same mechanism would be sized again and again.
  analysis::Region region{.z = zone.region.z};
  std::string key;
  for (const Candidate::Block& other : candidate.blocks) {
    key += fmt::format("{} {} {}:", other.module, other.item, other.mode);
    for (const int level : other.levels) key += fmt::format("{},", level);
  }
  key += fmt::format("|{}", block.module);
  for (std::size_t i = 0; i < zone.region.varied.size(); ++i) {
    const int coordinate = zone.region.varied[i];
    if (std::find(view->coordinates.begin(), view->coordinates.end(), coordinate) ==
        view->coordinates.end())
      continue;
    const auto rounded = [](double value) { return std::round(value * 1e6) * 1e-6; };
    region.varied.push_back(coordinate);
    region.lower.push_back(rounded(zone.region.lower[i]));
    region.upper.push_back(rounded(zone.region.upper[i]));
    const auto local = std::find(view->coordinates.begin(), view->coordinates.end(), coordinate) -
                       view->coordinates.begin();
    key += fmt::format("|{} {} {:.6f} {:.6f}",
                       local,
                       view->block->letters[static_cast<std::size_t>(local)].sign,
                       region.lower.back(),
                       region.upper.back());
  }
  auto shared = sizing.Find(key);
  if (!shared) {
    const SizingTask task{.machine = &machine,
                          .mechanism = static_cast<std::size_t>(view - views.begin()),
                          .region = &region,
                          .free = free};
    shared = sizing.Put(key, SizeMechanism(task, settings));
  }
  std::size_t next = 0;
  for (std::size_t i = 0; i < module.parameters.size(); ++i) {
    if (!module.parameters[i].levels.empty() || !module.parameters[i].range) continue;
    sizes.push_back({.module = block.module,
                     .parameter = static_cast<int>(i),
                     .value = shared->values[next++]});
  }
}

Verdict Evaluator::State::PassSizing(const Candidate& candidate,
                                     std::optional<Machine>& machine,
                                     std::vector<Size>& sizes,
                                     Evaluation& row) const {
  row.stage = Stage::kSizing;
  if (!machine) {
    if (Verdict failure = Build(candidate, {}, machine)) return failure;
  }
  const Study& study = space->study();
  const RequiredZone zone = FindRequiredZone(*machine, study.motions);
  if (!zone.found) return Reject("the motions cannot place the tool all over the required zone");
  for (const Candidate::Block& block : candidate.blocks)
    SizeBlock(candidate, block, *machine, zone, sizes);
  for (const Size& size : sizes) {
    const StudyModule& module = study.modules[static_cast<std::size_t>(size.module)];
    const StudyParameter& parameter = module.parameters[static_cast<std::size_t>(size.parameter)];
    row.sizes.push_back({.name = module.name + "." + parameter.name,
                         .value = size.value,
                         .angle = parameter.angle});
  }
  if (!sizes.empty()) {
    if (Verdict failure = Build(candidate, sizes, machine)) return failure;
  }
  return CheckLimits(row);
}

Verdict Evaluator::State::PassZone(const Machine& machine,
                                   const RequiredZone& zone,
                                   Evaluation& row) const {
  row.stage = Stage::kZone;
  const auto judge = analysis::PoseJudge::Make(machine, machine.nominal(), {});
  std::vector<double> lengths;
  for (std::size_t m = 0; m < judge->mechanisms().size(); ++m) {
    const double length = analysis::CharacteristicLength(*judge, m);
    lengths.push_back(std::isfinite(length) ? length : 1.0);
  }
  const ZoneMap map = MapZone(*judge, lengths, zone.region, PoseGrid(zone.region, settings.poses));
  row.metrics.Set(MetricId::kZoneShare, map.Share());
  if (map.Share() < settings.zone_share) {
    return Reject(map.beyond > 0 ? "the required zone lies beyond a singularity"
                                 : "the required zone is not reached");
  }
  double travel = 0.0;
  for (std::size_t i = 0; i < map.drives.size(); ++i) {
    if (!machine.drives()[i].rotary) travel += map.drives[i].width();
  }
  row.metrics.Set(MetricId::kTravel, travel);
  row.metrics.Set(MetricId::kDexterityMean, map.dexterity_mean);
  row.metrics.Set(MetricId::kDexterityWorst, map.dexterity_worst);
  if (wants_abilities) {
    const std::vector<analysis::Ability> abilities =
        analysis::Abilities(machine, space->registry());
    row.metrics.Set(MetricId::kAbilities,
                    static_cast<double>(
                        std::count_if(abilities.begin(), abilities.end(), [](const auto& ability) {
                          return ability.possible;
                        })));
  }
  return CheckLimits(row);
}

Verdict Evaluator::State::PassBudget(const Machine& machine,
                                     const RequiredZone& zone,
                                     Evaluation& row) const {
  row.stage = Stage::kBudget;
  const Study& study = space->study();
  const MovedMasses masses = MassesOf(machine, study.part_mass_kg, settings);
  const ToolBudget budget =
      BudgetOf(machine, zone.poses, masses, study.process_direction, settings);
  if (budget.poses == 0)
    return Rejection{.status = EvaluationStatus::kFailed,
                     .reason = "no pose of the zone could be evaluated"};
  const SpaceBox box = BoxOf(machine, zone.poses, study);
  constexpr double kUmPerMm = 1000.0;
  row.metrics.Set(MetricId::kStiffness, budget.stiffness_n_per_mm / kUmPerMm);
  row.metrics.Set(MetricId::kErrorBudget, budget.error_mm * kUmPerMm);
  row.metrics.Set(MetricId::kDynamicError, budget.dynamic_mm * kUmPerMm);
  row.metrics.Set(MetricId::kOrientationMargin, budget.orientation_margin);
  row.metrics.Set(MetricId::kSingularityMargin, budget.singularity_margin);
  row.metrics.Set(MetricId::kMovingMass, masses.sum);
  row.metrics.Set(MetricId::kFootprint, box.FloorMm2() * 1e-6);
  row.metrics.Set(MetricId::kFrame,
                  machine.layout().formula.open_base ? 0.0 : box.PortalMm() * 1e-3);
  const double content = box.Content(zone.lengths);
  if (zone.lengths > 0 && content > 0.0)
    row.metrics.Set(MetricId::kSpaceEfficiency, zone.content / content);
  return CheckLimits(row);
}

Verdict Evaluator::State::PassAll(const Candidate& candidate, Evaluation& row) const {
  SetStructure(candidate, row);
  if (Verdict limit = CheckLimits(row)) return limit;
  const formula::Formula formula = space->FormulaOf(candidate);
  row.formula = formula::Canonical(formula);
  std::optional<Machine> machine;
  if (Verdict end = PassMobility(candidate, formula, machine, row)) return end;
  std::vector<Size> sizes;
  if (Verdict end = PassSizing(candidate, machine, sizes, row)) return end;
  const RequiredZone zone = FindRequiredZone(*machine, space->study().motions);
  if (!zone.found) return Reject("the motions cannot place the tool all over the required zone");
  if (Verdict end = PassZone(*machine, zone, row)) return end;
  return PassBudget(*machine, zone, row);
}

Evaluator::Evaluator(const StudySpace& space, const EvaluationSettings& settings)
    : state_(std::make_unique<State>(space, settings)) {}
Evaluator::Evaluator(Evaluator&&) noexcept = default;
Evaluator& Evaluator::operator=(Evaluator&&) noexcept = default;
Evaluator::~Evaluator() = default;

Evaluation Evaluator::Structure(const Candidate& candidate) const {
  Evaluation row{.index = candidate.index};
  state_->SetStructure(candidate, row);
  if (Verdict limit = state_->CheckLimits(row)) {
    row.status = limit->status;
    row.reason = std::move(limit->reason);
  }
  return row;
}

Evaluation Evaluator::Evaluate(const Candidate& candidate) const {
  Evaluation row{.index = candidate.index};
  try {
    if (Verdict end = state_->PassAll(candidate, row)) {
      row.status = end->status;
      row.reason = std::move(end->reason);
    }
  } catch (const std::exception& error) {
    row.status = EvaluationStatus::kFailed;
    row.reason = error.what();
  }
  if (row.formula.empty()) row.formula = formula::Canonical(state_->space->FormulaOf(candidate));
  return row;
}

std::string Evaluator::LayoutFile(const Candidate& candidate) const {
  std::optional<Machine> machine;
  std::vector<Size> sizes;
  Evaluation row;
  (void)state_->PassSizing(candidate, machine, sizes, row);
  return LayoutText(*state_->space, candidate, sizes);
}

const StudySpace& Evaluator::space() const {
  return *state_->space;
}
const EvaluationSettings& Evaluator::settings() const {
  return state_->settings;
}
Evaluator::Sharing Evaluator::mobility_sharing() const {
  return {state_->mobility.computed(), state_->mobility.found()};
}
Evaluator::Sharing Evaluator::sizing_sharing() const {
  return {state_->sizing.computed(), state_->sizing.found()};
}

void Tally(const Evaluation& row, Funnel& funnel) {
  const auto last = static_cast<std::size_t>(row.stage);
  for (std::size_t i = 0; i <= last; ++i) ++funnel[i].entered;
  if (row.status == EvaluationStatus::kRejected) ++funnel[last].rejected;
  if (row.status == EvaluationStatus::kFailed) ++funnel[last].failed;
}

}  // namespace kompono::synthesis
