// SPDX-License-Identifier: Apache-2.0
// kompono calibrate: the real geometry from measurements.
#include "calibration_files.hpp"
#include "campaign.hpp"
#include "codes.hpp"
#include "files.hpp"
#include "patterns.hpp"
#include "session.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <memory>

#include "kompono/calibration/codes.hpp"
#include "kompono/calibration/cross_validation.hpp"
#include "kompono/calibration/html_report.hpp"
#include "kompono/calibration/identification.hpp"
#include "kompono/calibration/iso_figures.hpp"
#include "kompono/calibration/klipper_delta.hpp"
#include "kompono/calibration/report.hpp"
#include "kompono/calibration/residual_map.hpp"
#include "kompono/calibration/zone_accuracy.hpp"

namespace kompono::cli {
namespace {

using calibration::CalibrationReport;
using calibration::IdentifyOptions;
using calibration::MeasurementSet;
using calibration::ParameterGroup;
using kinematics::Machine;
using nlohmann::ordered_json;

constexpr const char* kExamples =
    "  kompono calibrate machine.toml points.csv -o calibrated.toml\n"
    "  kompono calibrate machine.toml points.csv --free 'drive.*,open_base' --held-out 0.3\n"
    "  kompono calibrate machine.toml points.csv --prior 'drive.L1=0.05' --report report.json\n"
    "  kompono calibrate machine.toml points.csv --group offsets --prior-tolerances 3\n"
    "  kompono calibrate campaign.toml --map known.csv         files and layout stand in it\n"
    "  kompono calibrate delta.toml run.csv --published run.json        against Klipper's own fit";

struct Options {
  std::string file, out, published, report;
  std::vector<std::string> measurements;
  std::vector<std::string> free, lock, prior, bounds, groups;
  double prior_tolerances = 0.0;
  double held_out = 0.0;
  std::uint64_t seed = 1;
  double sigma_mm = IdentifyOptions{}.default_sigma_mm;
  double sigma_deg = IdentifyOptions{}.default_sigma_rad * kDegPerRad;
  int max_iterations = IdentifyOptions{}.max_iterations;
  std::string outliers = "auto";
  double drive_sigma_mm = 0.0;
  double drive_sigma_deg = 0.0;
  std::string gauge = "minimum";
  std::string html, map, residual_map;
  int map_steps = 5;
  std::vector<MeasurementSource> sources;  ///< the measurements, or those of a description
  int folds = 0;
  bool residuals = false;
  bool force = false;
};

std::vector<ParameterGroup> GroupsOf(const std::vector<std::string>& words, Diagnostics& problems) {
  constexpr std::array kGroups{ParameterGroup::kOffsets,
                               ParameterGroup::kFrames,
                               ParameterGroup::kGeometry,
                               ParameterGroup::kAll};
  std::vector<ParameterGroup> out;
  for (const std::string& word : SplitWords(words)) {
    const auto* const found = std::find_if(kGroups.begin(), kGroups.end(), [&word](auto group) {
      return calibration::Name(group) == word;
    });
    if (found != kGroups.end()) {
      out.push_back(*found);
      continue;
    }
    problems.push_back({.code = std::string(codes::kUsage.code),
                        .message = fmt::format("--group: no group of numbers is called '{}'", word),
                        .help = "offsets, frames, geometry or all, or several with commas"});
  }
  return out;
}

IdentifyOptions IdentifyOptionsOf(const Machine& machine,
                                  const plugin::Registry& registry,
                                  const Options& options,
                                  Diagnostics& problems) {
  IdentifyOptions out;
  out.free = SplitWords(options.free);
  out.lock = SplitWords(options.lock);
  out.groups = GroupsOf(options.groups, problems);
  out.prior_tolerances = options.prior_tolerances;
  const GeometryForms forms = FormsOf(machine, registry);
  if (!options.prior.empty())
    out.prior_sigma =
        ReadPatternNumbers(Argument("--prior", options.prior), machine, forms, problems);
  if (!options.bounds.empty())
    out.bounds = ReadPatternRanges(Argument("--bounds", options.bounds), machine, forms, problems);
  out.default_sigma_mm = options.sigma_mm;
  out.default_sigma_rad = options.sigma_deg / kDegPerRad;
  out.held_out_fraction = options.held_out;
  out.seed = options.seed;
  out.max_iterations = options.max_iterations;
  out.drive_sigma_mm = options.drive_sigma_mm;
  out.drive_sigma_rad = options.drive_sigma_deg / kDegPerRad;
  if (options.gauge == "freeze") out.gauge = calibration::Gauge::kFreeze;
  if (options.gauge == "prior") out.gauge = calibration::Gauge::kPrior;
  if (options.outliers == "reject") out.outliers = calibration::Outliers::kReject;
  if (options.outliers == "keep") out.outliers = calibration::Outliers::kKeep;
  return out;
}

/// Klipper's own words for what was found, beside what Klipper found itself.
struct KlipperComparison {
  calibration::KlipperGeometry nominal, identified, published;
  double cost_nominal = 0.0, cost_identified = 0.0, cost_published = 0.0;
};

Parsed<KlipperComparison> Compare(const Machine& machine,
                                  const MeasurementSet& set,
                                  const CalibrationReport& report,
                                  const IdentifyOptions& options,
                                  const std::string& json_file) {
  const Parsed<calibration::KlipperRun> run = calibration::ReadKlipperRun(json_file);
  if (!run) return tl::unexpected(run.error());
  const auto nominal = calibration::KlipperGeometryOf(machine, report.theta_before);
  const auto identified = calibration::KlipperGeometryOf(machine, report.theta_after);
  const auto published = calibration::ThetaOfKlipper(machine, run->published_fit);
  for (const Diagnostics& failure : {nominal ? Diagnostics{} : nominal.error(),
                                     identified ? Diagnostics{} : identified.error(),
                                     published ? Diagnostics{} : published.error()}) {
    if (!failure.empty()) return tl::unexpected(failure);
  }
  const auto cost = [&](const Eigen::VectorXd& theta) {
    return calibration::WeightedSquares(machine, set, theta, options);
  };
  return KlipperComparison{.nominal = *nominal,
                           .identified = *identified,
                           .published = run->published_fit,
                           .cost_nominal = cost(report.theta_before),
                           .cost_identified = cost(report.theta_after),
                           .cost_published = cost(*published)};
}

ordered_json GeometryJson(const calibration::KlipperGeometry& geometry) {
  ordered_json out{{"delta_radius", geometry.delta_radius}};
  for (std::size_t i = 0; i < 3; ++i) {
    const char tower = "abc"[i];
    out[fmt::format("angle_{}", tower)] = geometry.angle_deg[i];
    out[fmt::format("arm_{}", tower)] = geometry.arm[i];
    out[fmt::format("endstop_{}", tower)] = geometry.endstop[i];
  }
  return out;
}

ordered_json ComparisonJson(const KlipperComparison& comparison) {
  return {{"nominal", GeometryJson(comparison.nominal)},
          {"identified", GeometryJson(comparison.identified)},
          {"published", GeometryJson(comparison.published)},
          {"cost_nominal", comparison.cost_nominal},
          {"cost_identified", comparison.cost_identified},
          {"cost_published", comparison.cost_published}};
}

std::string ComparisonText(const KlipperComparison& comparison) {
  return "\nin Klipper's numbers\n" +
         calibration::CompareKlipper(
             comparison.nominal, comparison.identified, comparison.published) +
         fmt::format(
             "  weighted sum of squares: nominal {:.9g}, identified {:.9g}, published {:.9g}\n",
             comparison.cost_nominal,
             comparison.cost_identified,
             comparison.cost_published);
}

ExitCode ExitOf(const CalibrationReport& report) {
  switch (report.status) {
    case calibration::IdentifyStatus::kConverged:
    case calibration::IdentifyStatus::kRankDeficient:
      return ExitCode::kOk;
    case calibration::IdentifyStatus::kIterationLimit:
    case calibration::IdentifyStatus::kForwardFailed:
      return ExitCode::kNoSolution;
    case calibration::IdentifyStatus::kTooFewMeasurements:
      return ExitCode::kBadInput;
    case calibration::IdentifyStatus::kBadInput:
      return ExitCodeOf(report.diagnostics);
  }
  return ExitCode::kInternal;
}

std::string FoldsText(const std::vector<calibration::FoldedError>& folded, int folds) {
  if (folded.empty()) return "\na fold could not be fitted: too few rows\n";
  std::string text = fmt::format("\n{} folds: each row judged by a fit without it\n", folds);
  for (const calibration::FoldedError& e : folded) {
    const double factor = e.angle ? kDegPerRad : 1.0;
    text += fmt::format("  {}: {:.4g} {} in sample, {:.4g} {} held out\n",
                        e.quantity,
                        e.rms_fitted * factor,
                        UnitOf(e.angle),
                        e.rms_held_out * factor,
                        UnitOf(e.angle));
  }
  return text;
}

ordered_json FoldsJson(const std::vector<calibration::FoldedError>& folded) {
  ordered_json out = ordered_json::array();
  for (const calibration::FoldedError& e : folded) {
    const std::string unit(UnitOf(e.angle));
    out.push_back({{"quantity", e.quantity},
                   {"count", e.count},
                   {"rms_fitted_" + unit, Outward(e.rms_fitted, e.angle)},
                   {"rms_held_out_" + unit, Outward(e.rms_held_out, e.angle)}});
  }
  return out;
}

/// Keys with the unit in their names.
ordered_json PositioningJson(const calibration::PositioningFigures& figures, bool rotary) {
  const std::string unit = rotary ? "_deg" : "_mm";
  ordered_json out;
  if (const auto& f = figures.bidirectional) {
    out["bidirectional"] = {{"a" + unit, Outward(f->accuracy, rotary)},
                            {"r" + unit, Outward(f->repeatability, rotary)},
                            {"b" + unit, Outward(f->reversal, rotary)},
                            {"mean_b" + unit, Outward(f->mean_reversal, rotary)},
                            {"e" + unit, Outward(f->systematic, rotary)},
                            {"m" + unit, Outward(f->mean_deviation, rotary)}};
  }
  for (const auto& [name, side] :
       {std::pair{"positive", &figures.positive}, std::pair{"negative", &figures.negative}}) {
    if (!*side) continue;
    out[name] = {{"a" + unit, Outward((*side)->accuracy, rotary)},
                 {"r" + unit, Outward((*side)->repeatability, rotary)},
                 {"e" + unit, Outward((*side)->systematic, rotary)}};
  }
  return out;
}

ordered_json AxisTestJson(const calibration::AxisTest& test) {
  const std::string unit = test.rotary() ? "_deg" : "_mm";
  ordered_json out{{"axis", std::string(1, test.axis)},
                   {"at", test.line},
                   {"from" + unit, Outward(test.from, test.rotary())},
                   {"to" + unit, Outward(test.to, test.rotary())},
                   {"targets", test.targets},
                   {"rows", test.rows},
                   {"first_row", test.first_row},
                   {"missing", test.missing}};
  if (!test.missing.empty()) return out;
  out["before"] = PositioningJson(test.before, test.rotary());
  out["after"] = PositioningJson(test.after, test.rotary());
  return out;
}

ordered_json IsoJson(const calibration::IsoFigures& figures) {
  ordered_json out{{"iso_230_2", ordered_json::array()},
                   {"iso_9283", ordered_json::array()},
                   {"iso_230_4", ordered_json::array()}};
  for (const calibration::AxisTest& test : figures.axes) {
    out["iso_230_2"].push_back(AxisTestJson(test));
  }
  for (const calibration::RepeatedPose& p : figures.poses) {
    out["iso_9283"].push_back({{"first_row", p.first_row},
                               {"repeats", p.repeats},
                               {"ap_before_mm", p.accuracy_before_mm},
                               {"ap_after_mm", p.accuracy_after_mm},
                               {"rp_mm", p.repeatability_mm}});
  }
  for (const calibration::CircularRun& r : figures.runs) {
    out["iso_230_4"].push_back({{"centre", r.centre},
                                {"rows", r.rows},
                                {"g_before_mm", r.deviation_before_mm},
                                {"g_after_mm", r.deviation_after_mm},
                                {"fmax_before_mm", r.radial_most_before_mm},
                                {"fmin_before_mm", r.radial_least_before_mm}});
  }
  return out;
}

/// The files asked for; with what to leave if one cannot be written.
std::optional<ExitCode> WriteFiles(Session& session,
                                   const Machine& machine,
                                   const CalibrationReport& report,
                                   const MeasurementFiles& files,
                                   const ordered_json& document,
                                   const std::vector<calibration::PageSection>& sections,
                                   const Options& options) {
  if (!report.ok()) return std::nullopt;  // stdout has said why
  if (!options.report.empty()) {
    if (const auto failure = WriteFileAside(options.report, document.dump(2) + "\n", options.force))
      return session.Refuse(*failure);
    session.console.Say(options.report + " written");
  }
  if (!options.html.empty()) {
    const std::string page = calibration::RenderHtml(
        report, fmt::format("{}: {}", options.file, files.set.file), sections);
    if (const auto failure = WriteFileAside(options.html, page, options.force))
      return session.Refuse(*failure);
    session.console.Say(options.html + " written");
  }
  if (options.out.empty()) return std::nullopt;
  const Parsed<std::string> layout =
      calibration::CalibratedLayout(machine, session.registry(), report, SourceText(files));
  if (!layout) return session.Refuse(layout.error());
  if (const auto failure = WriteFileAside(options.out, *layout, options.force))
    return session.Refuse(*failure);
  session.console.Say(options.out + " written");
  return std::nullopt;
}

/// The zone's map as a file, and its figures.
std::optional<ExitCode> WriteMap(Session& session,
                                 const Machine& machine,
                                 const CalibrationReport& report,
                                 const MeasurementFiles& files,
                                 const Options& options,
                                 ordered_json* document) {
  if (options.map.empty() || !report.ok()) return std::nullopt;
  const Parsed<calibration::ZoneAccuracy> zone =
      calibration::ToolOverZone(machine, files.set, report, options.map_steps);
  if (!zone) return session.Refuse(zone.error());
  (*document)["zone"] = {{"points", zone->points.size()},
                         {"out_of_reach", zone->out_of_reach},
                         {"tool_sigma_rms_mm", zone->rms_mm},
                         {"tool_sigma_max_mm", zone->max_mm},
                         {"tool_sigma_max_deg", zone->max_rad * kDegPerRad}};
  if (const auto failure =
          WriteFileAside(options.map, calibration::ZoneCsv(machine, *zone), options.force))
    return session.Refuse(*failure);
  session.console.Say(
      fmt::format("{} written: over {} of the work zone the tool point is known to {:.4f} mm RMS, "
                  "{:.4f} mm at worst",
                  options.map,
                  Counted(zone->points.size(), "point"),
                  zone->rms_mm,
                  zone->max_mm));
  return std::nullopt;
}

ordered_json GainJson(const calibration::MapGain& gain) {
  return {{"rows", gain.rows}, {"without_mm", gain.without_mm}, {"with_mm", gain.with_mm}};
}

/// The map of what the geometry leaves: its figures, and the file if it helps.
std::optional<ExitCode> WriteResidualMap(Session& session,
                                         const Machine& machine,
                                         const CalibrationReport& report,
                                         const MeasurementFiles& files,
                                         const IdentifyOptions& identify,
                                         const Options& options,
                                         ordered_json* document,
                                         std::vector<calibration::PageSection>* sections) {
  if (options.residual_map.empty() || !report.ok()) return std::nullopt;
  const Parsed<calibration::MappedResiduals> mapped =
      calibration::MapResiduals(machine, files.set, report, identify, {.seed = options.seed});
  if (!mapped) return session.Refuse(mapped.error());
  const calibration::MapJudgement& judged = mapped->judged;
  ordered_json& out = (*document)["residual_map"];
  out = {{"kept", judged.kept},
         {"verdict", judged.verdict},
         {"fitted", GainJson(judged.fitted)},
         {"validated", GainJson(judged.validated)}};
  if (judged.held_out) out["held_out"] = GainJson(*judged.held_out);
  if (!session.json) session.console.Out(calibration::RenderText(judged));
  sections->push_back({"Residual map", calibration::RenderText(judged)});
  if (!judged.kept) {
    session.console.Report({{.severity = Severity::kWarning,
                             .code = calibration::codes::kMapRefused.code,
                             .file = options.residual_map,
                             .message = "the residual map is " + judged.verdict,
                             .help = "the calibrated layout alone is the better model"}});
    return std::nullopt;
  }
  const std::string text = calibration::WriteResidualMap(machine, *mapped, SourceText(files));
  if (const auto failure = WriteFileAside(options.residual_map, text, options.force))
    return session.Refuse(*failure);
  session.console.Say(options.residual_map + " written");
  return std::nullopt;
}

ExitCode Identify(Session& session,
                  const Machine& machine,
                  const MeasurementFiles& files,
                  const IdentifyOptions& identify,
                  const Options& options) {
  const CalibrationReport report = calibration::Identify(machine, files.set, identify);
  ordered_json document = calibration::ToJson(report);
  document["layout"] = options.file;
  document["measurements"] = ordered_json::array();
  for (const MeasurementFile& file : files.files)
    document["measurements"].push_back({{"file", file.name}, {"sha256", file.sha256}});
  if (!options.out.empty() && report.ok()) document["calibrated_layout"] = options.out;
  std::optional<KlipperComparison> comparison;
  std::vector<calibration::FoldedError> folded;
  if (options.folds > 1 && report.ok()) {
    folded = calibration::CrossValidate(machine, files.set, identify, options.folds);
    document["folds"] = FoldsJson(folded);
  }
  if (!options.published.empty() && report.ok()) {
    const auto compared = Compare(machine, files.set, report, identify, options.published);
    if (!compared) return session.Refuse(compared.error());
    comparison = *compared;
    document["klipper"] = ComparisonJson(*comparison);
  }
  calibration::IsoFigures iso;
  std::vector<calibration::PageSection> sections;
  if (report.ok()) {
    iso = calibration::IsoFiguresOf(machine, files.set, report.theta_after);
    if (!iso.empty()) {
      document["iso"] = IsoJson(iso);
      sections.push_back({"Figures of the standards", calibration::RenderIso(iso)});
    }
  }
  if (!session.json) {
    session.console.Out(calibration::RenderText(report, {.residuals = options.residuals}));
    if (options.folds > 1 && report.ok()) {
      session.console.Out(FoldsText(folded, options.folds));
    }
    if (!iso.empty()) session.console.Out(calibration::RenderIso(iso));
    if (comparison) session.console.Out(ComparisonText(*comparison));
    session.console.Report(report.diagnostics);  // under --json they stand in the document
  }
  if (const auto failed = WriteMap(session, machine, report, files, options, &document))
    return *failed;
  if (const auto failed = WriteResidualMap(
          session, machine, report, files, identify, options, &document, &sections))
    return *failed;
  const auto failed = WriteFiles(session, machine, report, files, document, sections, options);
  if (failed) return *failed;
  if (session.json) session.console.Json(std::move(document));
  return ExitOf(report);
}

/// What a measurement description says goes where the command line says nothing.
Parsed<Options> WithCampaign(Options options) {
  for (const std::string& name : options.measurements) options.sources.push_back({.name = name});
  if (!options.measurements.empty() || !options.file.ends_with(".toml")) return options;
  const Parsed<std::string> text = ReadWhole(options.file);
  if (!text) return tl::unexpected(text.error());
  if (!IsCampaign(*text)) return options;
  Parsed<Campaign> campaign = ReadCampaign(*text, options.file);
  if (!campaign) return tl::unexpected(std::move(campaign.error()));
  options.file = campaign->layout;
  options.sources = std::move(campaign->files);
  if (options.free.empty() && options.groups.empty()) {
    options.free = std::move(campaign->free);
    options.groups = std::move(campaign->groups);
  }
  if (options.lock.empty()) options.lock = std::move(campaign->lock);
  if (options.prior.empty()) options.prior = std::move(campaign->prior);
  return options;
}

ExitCode Run(Session& session, const Options& given) {
  const Parsed<Options> completed = WithCampaign(given);
  if (!completed) return session.Refuse(completed.error());
  const Options& options = *completed;
  if (options.file.empty() || options.sources.empty()) {
    return session.Refuse(Diagnostic{
        .code = std::string(codes::kUsage.code),
        .message = options.file.empty() ? "LAYOUT is required" : "MEASUREMENTS is required",
        .help = "kompono calibrate LAYOUT MEASUREMENTS..., or kompono calibrate plan LAYOUT"});
  }
  for (const std::string& file :
       {options.out, options.report, options.html, options.map, options.residual_map}) {
    if (const auto exists = RefuseToOverwrite(file, options.force)) return session.Refuse(*exists);
  }
  ExitCode code = ExitCode::kOk;
  const std::optional<Machine> machine = session.ReadMachine(options.file, code);
  if (!machine) return code;
  Diagnostics problems;
  const IdentifyOptions identify =
      IdentifyOptionsOf(*machine, session.registry(), options, problems);
  if (!problems.empty()) return session.Refuse(problems);
  Diagnostics notes;
  const Parsed<MeasurementFiles> files = ReadMeasurementFiles(
      options.sources, *machine, {.keep_slips = options.outliers != "auto"}, notes);
  if (!files) {
    notes.insert(notes.end(), files.error().begin(), files.error().end());
    return session.Refuse(notes);
  }
  session.console.Report(notes);
  return Identify(session, *machine, *files, identify, options);
}

void AddFitOptions(CLI::App& command, Session& session, Options& options) {
  const auto patterns =
      [&command](
          const char* name, std::vector<std::string>& value, const char* form, const char* text) {
        command.add_option(name, value, text)->type_name(form)->allow_extra_args(false);
      };
  patterns("--free", options.free, "PATTERN,..", "What may change; else as the layout says");
  patterns("--group",
           options.groups,
           "GROUP,..",
           "What may change, by kind: offsets, frames, geometry or all");
  patterns("--lock", options.lock, "PATTERN,..", "What may not change");
  patterns(
      "--prior", options.prior, "PATTERN=SIGMA,", "Expected deviation from nominal, mm or deg");
  command
      .add_option("--prior-tolerances",
                  options.prior_tolerances,
                  "Expect numbers within so many manufacturing tolerances (0: no matter)")
      ->type_name("FACTOR")
      ->check(CLI::NonNegativeNumber);
  patterns("--bounds", options.bounds, "PATTERN=LO:HI,", "Limits, mm or deg");
  command.add_option("--held-out", options.held_out, "Share of the rows kept to judge the fit (0)")
      ->type_name("FRACTION")
      ->check(CLI::Range(0.0, 0.99));
  command.add_option("--seed", options.seed, "Of the choice of held-out rows (1)")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
  command
      .add_option(
          "--sigma-mm", options.sigma_mm, "Deviation of lengths whose row gives none (0.01)")
      ->type_name("MM")
      ->check(CLI::PositiveNumber);
  command
      .add_option(
          "--sigma-deg", options.sigma_deg, "Deviation of angles whose row gives none (0.00057)")
      ->type_name("DEG")
      ->check(CLI::PositiveNumber);
  command
      .add_option("--drive-sigma-mm", options.drive_sigma_mm, "Deviation of linear readings (0)")
      ->type_name("MM")
      ->check(CLI::NonNegativeNumber);
  command
      .add_option("--drive-sigma-deg", options.drive_sigma_deg, "Deviation of rotary readings (0)")
      ->type_name("DEG")
      ->check(CLI::NonNegativeNumber);
  session.Choices(
      command
          .add_option(
              "--outliers", options.outliers, "Rows that stand out: reject, keep or auto (auto)")
          ->type_name("WHAT"),
      {"auto", "reject", "keep"});
  command.add_option("--max-iterations", options.max_iterations, "Then it has not converged (100)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000));
}

}  // namespace

void AddCalibrate(CLI::App& root, Session& session) {
  CLI::App* command =
      session.Command(root, "calibrate", "Real geometry of a machine from measurements", kExamples);
  const auto options = std::make_shared<Options>();
  const auto file = [&](const char* name, std::string& value, const char* text) {
    session.Hint(command->add_option(name, value, text)->type_name("FILE"), ValueHint::Kind::kFile);
  };
  session.Hint(
      command->add_option("LAYOUT",
                          options->file,
                          "Layout with the nominal geometry, or a description of measurements"),
      ValueHint::Kind::kFile);
  session.Hint(
      command->add_option("MEASUREMENTS",
                          options->measurements,
                          "CSV files; runs of Klipper's deltas are known by their heading"),
      ValueHint::Kind::kFile);
  file("-o,--out", options->out, "Calibrated layout to write");
  AddFitOptions(*command, session, *options);
  file("--published", options->published, "A delta run's description: compare with Klipper's fit");
  file("--report", options->report, "The whole report as JSON, for kompono catalog add --report");
  file("--html", options->html, "The report as one HTML page with its diagrams");
  file("--map", options->map, "CSV of how well the tool point is known over the work zone");
  file("--residual-map", options->residual_map, "Map of what the geometry leaves, if it helps");
  command->add_option("--map-steps", options->map_steps, "Values of each linear coordinate (5)")
      ->type_name("N")
      ->check(CLI::Range(1, 100));
  command->add_option("--folds", options->folds, "Judge each row by a fit without it, in N parts")
      ->type_name("N")
      ->check(CLI::Range(2, 1000));
  session.Choices(command
                      ->add_option("--gauge",
                                   options->gauge,
                                   "What settles unseen combinations: minimum, freeze or prior "
                                   "(minimum)")
                      ->type_name("HOW"),
                  {"minimum", "freeze", "prior"});
  command->add_flag("--residuals", options->residuals, "A line for every row");
  command->add_flag("--force", options->force, "Replace files that exist");
  AddCalibratePlan(*command, session);
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
