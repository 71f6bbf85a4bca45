// SPDX-License-Identifier: Apache-2.0
// kompono catalog: layouts and what is known about them, in one SQLite file.
#include "calibration_files.hpp"
#include "catalog_record.hpp"
#include "codes.hpp"
#include "files.hpp"
#include "session.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>

#include "kompono/catalog/query.hpp"
#include "kompono/catalog/store.hpp"

namespace kompono::cli {
namespace {

using catalog::OpenMode;
using catalog::Store;
using nlohmann::ordered_json;

constexpr const char* kExamples =
    "  kompono catalog add machines.db layouts/machines/*.toml\n"
    "  kompono catalog query machines.db \"drives <= 3 and base = 'open'\" --sort name\n"
    "  kompono catalog show machines.db 'Knee mill'\n"
    "  kompono catalog export machines.db 3fa9c1 -o lambda.toml";
constexpr const char* kAddExamples =
    "  kompono catalog add machines.db layouts/machines/*.toml\n"
    "  kompono catalog add machines.db calibrated.toml --report report.json";
constexpr const char* kQueryExamples =
    "  kompono catalog query machines.db                                      all layouts\n"
    "  kompono catalog query machines.db \"rms_after_um < 100 and formula like '%(XY)%'\"\n"
    "  kompono catalog query machines.db \"drives > 3\" --sort 'name desc' --limit 5 --csv\n"
    "  kompono catalog query machines.db \"base = 'open'\" --columns 'name, drives' --json\n"
    "  kompono catalog query machines.db \"metric.singularity_margin > 0.1 and drives < 6\"";
constexpr const char* kShowExamples =
    "  kompono catalog show machines.db 'Knee mill'     by name\n"
    "  kompono catalog show machines.db 3fa9c1          by hash, or by number";
constexpr const char* kExportExamples =
    "  kompono catalog export machines.db 3fa9c1 -o lambda.toml     the layout file as it was "
    "added\n"
    "  kompono catalog export machines.db --as json -o all.json     everything, in a fixed order\n"
    "  kompono catalog export machines.db --as csv -o tables        one table per file\n"
    "  kompono catalog export machines.db --as toml -o layouts      one layout per file";
constexpr const char* kSearchExamples =
    "  kompono catalog search machines.db 'water jet'   layouts and studies with both words\n"
    "  kompono catalog search machines.db 'hexa*'       and with all that begin so";
constexpr const char* kSimilarExamples =
    "  kompono catalog similar machines.db 'Knee mill'  structures like this one";
constexpr const char* kStatsExamples =
    "  kompono catalog stats machines.db                how many of what";
constexpr const char* kVerifyExamples =
    "  kompono catalog verify machines.db               damage, changes by hand, wrong hashes";
constexpr const char* kMergeExamples =
    "  kompono catalog merge all.db mine.db yours.db    layouts and studies of several into one";

struct Options {
  std::string db, key, out, where, sort, columns, report, as;
  std::vector<std::string> files;
  std::int64_t most = 20;
  std::int64_t limit = 1000;
  bool csv = false;
  bool force = false;
};

std::string_view Word(catalog::AddStatus status) {
  switch (status) {
    case catalog::AddStatus::kAdded:
      return "added";
    case catalog::AddStatus::kUpdated:
      return "updated";
    case catalog::AddStatus::kUnchanged:
      return "unchanged";
  }
  return "";
}

std::optional<Store> Open(Session& session, const std::string& db, OpenMode mode, ExitCode& code) {
  Parsed<Store> store = Store::Open(db, {.mode = mode});
  if (!store) {
    code = session.Refuse(store.error());
    return std::nullopt;
  }
  session.console.Report(store->Notes());
  return std::move(*store);
}

/// A catalog from elsewhere must not steer the terminal or break the table.
std::string OneLine(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7F) {
      line += c;
    } else if (!line.empty() && line.back() != ' ') {
      line += ' ';
    }
  }
  return line;
}

ExitCode Found(Session& session, const char* name, ordered_json list, const TextTable& table) {
  const bool nothing = list.empty();
  if (session.json) {
    session.console.Json({{name, std::move(list)}});
  } else if (!nothing) {
    session.console.Out(table.Render());
  }
  if (!nothing) return ExitCode::kOk;
  session.console.Say("nothing found");
  return ExitCode::kNegative;
}

struct Named {
  std::string from;
  catalog::LayoutRecord record;
};

ExitCode AddRecords(Session& session, const std::string& db, const std::vector<Named>& named) {
  ExitCode code = ExitCode::kOk;
  std::optional<Store> store = Open(session, db, OpenMode::kCreate, code);
  if (!store) return code;
  std::vector<catalog::LayoutRecord> records;
  records.reserve(named.size());
  for (const Named& entry : named) records.push_back(entry.record);
  const auto results = store->AddAll(records);
  if (!results) return session.Refuse(results.error());
  ordered_json list = ordered_json::array();
  TextTable table({{"id", true}, {"status"}, {"name"}, {"from"}});
  for (std::size_t i = 0; i < named.size(); ++i) {
    const catalog::AddResult& result = (*results)[i];
    list.push_back({{"id", result.id},
                    {"status", Word(result.status)},
                    {"name", named[i].record.name},
                    {"from", named[i].from}});
    table.Row({std::to_string(result.id),
               std::string(Word(result.status)),
               named[i].record.name,
               named[i].from});
  }
  if (session.json) {
    session.console.Json({{"added", std::move(list)}});
  } else {
    session.console.Out(table.Render());
  }
  return ExitCode::kOk;
}

ExitCode Add(Session& session, const Options& options) {
  if (!options.report.empty() && options.files.size() != 1) {
    return session.Refuse({.code = std::string(codes::kUsage.code),
                           .message = "--report belongs to one layout file",
                           .help = "add the calibrated layout alone"});
  }
  std::vector<Named> named;
  ExitCode worst = ExitCode::kOk;
  for (const std::string& file : options.files) {
    session.console.Progress(file);
    ExitCode code = ExitCode::kOk;
    const auto machine = session.ReadMachine(file, code);
    worst = std::max(worst, code);
    if (machine)
      named.push_back({.from = file, .record = RecordOf(*machine, session.registry(), file)});
  }
  // All or nothing: a catalog of half the files would have to be sorted out by hand.
  if (worst != ExitCode::kOk) return worst;
  if (!options.report.empty()) {
    const Parsed<std::string> text = ReadWhole(options.report);
    if (!text) return session.Refuse(text.error());
    const auto calibration = CalibrationOfReport(*text, options.report);
    if (!calibration) return session.Refuse(calibration.error());
    named.front().record.calibrations = {*calibration};
  }
  return AddRecords(session, options.db, named);
}

ExitCode Merge(Session& session, const Options& options) {
  ExitCode code = ExitCode::kOk;
  std::optional<Store> store = Open(session, options.db, OpenMode::kCreate, code);
  if (!store) return code;
  ordered_json list = ordered_json::array();
  TextTable table({{"from"},
                   {"added", true},
                   {"updated", true},
                   {"unchanged", true},
                   {"studies", true},
                   {"evaluations", true},
                   {"known", true}});
  for (const std::string& file : options.files) {
    session.console.Progress(file);
    const auto other = Open(session, file, OpenMode::kReadOnly, code);
    if (!other) return code;
    const auto merged = store->Merge(*other);
    if (!merged) return session.Refuse(merged.error());
    list.push_back({{"from", file},
                    {"layouts_added", merged->layouts_added},
                    {"layouts_updated", merged->layouts_updated},
                    {"layouts_unchanged", merged->layouts_unchanged},
                    {"studies_added", merged->studies_added},
                    {"evaluations_written", merged->evaluations_written},
                    {"evaluations_skipped", merged->evaluations_skipped}});
    table.Row({file,
               std::to_string(merged->layouts_added),
               std::to_string(merged->layouts_updated),
               std::to_string(merged->layouts_unchanged),
               std::to_string(merged->studies_added),
               std::to_string(merged->evaluations_written),
               std::to_string(merged->evaluations_skipped)});
  }
  if (session.json) {
    session.console.Json({{"merged", std::move(list)}});
  } else {
    session.console.Out(table.Render());
  }
  return ExitCode::kOk;
}

ExitCode Query(Session& session, const Options& options) {
  ExitCode code = ExitCode::kOk;
  const auto store = Open(session, options.db, OpenMode::kReadOnly, code);
  if (!store) return code;
  const auto table = store->Query({.where = options.where,
                                   .columns = options.columns,
                                   .sort = options.sort,
                                   .limit = options.limit});
  if (!table) return session.Refuse(table.error());
  if (session.json) {
    session.console.Json(catalog::ToJson(*table));
  } else {
    session.console.Out(options.csv ? catalog::RenderCsv(*table) : catalog::RenderText(*table));
    if (table->more)
      session.console.Say(
          fmt::format("more than {}; see --limit", Counted(table->rows.size(), "row")));
  }
  if (!table->rows.empty()) return ExitCode::kOk;
  session.console.Say("nothing found");
  return ExitCode::kNegative;
}

std::string LayoutText(const catalog::StoredLayout& layout) {
  const catalog::LayoutRecord& record = layout.record;
  TextTable facts({{""}, {""}});
  facts.Row({"formula", record.formula});
  facts.Row({"distribution", record.distribution});
  facts.Row({"relative motion", record.relative_motion});
  facts.Row({"base", record.open_base ? "open" : "closed"});
  facts.Row({"coordinates", std::to_string(record.coordinates)});
  facts.Row({"drives", std::to_string(record.drives)});
  for (const catalog::Block& block : record.blocks)
    facts.Row({"block " + block.name, fmt::format("{} of {}", block.module, block.plugin)});
  for (const catalog::PluginVersion& plugin : record.provenance.plugins)
    facts.Row({"plugin " + plugin.id, plugin.version});
  facts.Row({"source", record.provenance.source_path});
  facts.Row({"hash", layout.hash});
  facts.Row({"added", fmt::format("{} by {}", layout.added_at, record.provenance.program_version)});
  for (const catalog::Calibration& calibration : record.calibrations) {
    const auto um = [](const std::optional<double>& value) {
      return value ? fmt::format("{:.4g} µm", *value) : std::string("?");
    };
    facts.Row({"calibration",
               fmt::format("{}: {}, RMS {} -> {}",
                           calibration.measurements,
                           calibration.status,
                           um(calibration.rms_before_um),
                           um(calibration.rms_after_um))});
  }
  for (const catalog::Capability& capability : record.capabilities)
    facts.Row({"capability", fmt::format("{} ({})", capability.name, capability.detail)});
  TextTable metrics({{"metric"}, {"", true}, {"unit"}, {"method"}});
  for (const catalog::Metric& metric : record.metrics) {
    metrics.Row({metric.name,
                 metric.value ? Brief(*metric.value) : "- " + metric.failure,
                 metric.unit,
                 metric.method});
  }
  TextTable parameters({{"parameter"}, {"", true}, {"unit"}});
  for (const catalog::Parameter& parameter : record.parameters)
    parameters.Row({parameter.name, Brief(parameter.value), parameter.unit});
  return fmt::format("{} (id {})\n{}\n{}\n{}",
                     record.name,
                     layout.id,
                     facts.Render(),
                     metrics.Render(),
                     parameters.Render());
}

ExitCode Show(Session& session, const Options& options) {
  ExitCode code = ExitCode::kOk;
  const auto store = Open(session, options.db, OpenMode::kReadOnly, code);
  if (!store) return code;
  const auto layout = store->Show(options.key);
  if (!layout) return session.Refuse(layout.error());
  if (session.json) {
    session.console.Json(catalog::ToJson(*layout));
  } else {
    session.console.Out(LayoutText(*layout));
  }
  return ExitCode::kOk;
}

ExitCode ExportOne(Session& session, const Options& options) {
  if (const auto exists = RefuseToOverwrite(options.out, options.force))
    return session.Refuse(*exists);
  ExitCode code = ExitCode::kOk;
  const auto store = Open(session, options.db, OpenMode::kReadOnly, code);
  if (!store) return code;
  const auto text = store->Export(options.key);
  if (!text) return session.Refuse(text.error());
  if (!options.out.empty()) {
    if (const auto failure = WriteFileAside(options.out, *text, options.force))
      return session.Refuse(*failure);
    session.console.Say(options.out + " written");
  }
  if (session.json) {
    session.console.Json(options.out.empty() ? ordered_json{{"text", *text}}
                                             : ordered_json{{"file", options.out}});
  } else if (options.out.empty()) {
    session.console.Out(*text);
  }
  return ExitCode::kOk;
}

ExitCode ExportAll(Session& session, const Options& options) {
  if (options.out.empty()) {
    return session.Refuse({.code = std::string(codes::kUsage.code),
                           .message = "--as needs a place to write to",
                           .help = "json: --out FILE; csv and toml: --out FOLDER"});
  }
  if (const auto exists = RefuseToOverwrite(options.out, options.force))
    return session.Refuse(*exists);
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(options.out, ignored);
  if (folder && !options.force && !std::filesystem::is_empty(options.out, ignored)) {
    return session.Refuse({.code = std::string(codes::kFileExists.code),
                           .file = options.out,
                           .message = "the folder is not empty",
                           .help = "give another folder, or --force to write into this one"});
  }
  ExitCode code = ExitCode::kOk;
  const auto store = Open(session, options.db, OpenMode::kReadOnly, code);
  if (!store) return code;
  const auto format = options.as == "json"  ? catalog::ExportFormat::kJson
                      : options.as == "csv" ? catalog::ExportFormat::kCsv
                                            : catalog::ExportFormat::kToml;
  const auto written = store->ExportAll(format, options.out);
  if (!written) return session.Refuse(written.error());
  if (session.json) {
    session.console.Json({{"out", options.out},
                          {"layouts", written->layouts},
                          {"evaluations", written->evaluations},
                          {"files", written->files}});
  } else {
    session.console.Say(
        fmt::format("{}: {}, {}, {} written",
                    options.out,
                    Counted(static_cast<std::size_t>(written->layouts), "layout"),
                    Counted(static_cast<std::size_t>(written->evaluations), "evaluation"),
                    Counted(static_cast<std::size_t>(written->files), "file")));
  }
  return ExitCode::kOk;
}

ExitCode Export(Session& session, const Options& options) {
  if (options.as.empty() != options.key.empty())
    return options.as.empty() ? ExportOne(session, options) : ExportAll(session, options);
  return session.Refuse({.code = std::string(codes::kUsage.code),
                         .message = options.as.empty() ? "what is to be exported?"
                                                       : "--as exports everything, not one layout",
                         .help = "give a layout, or --as json, csv or toml for all"});
}

ExitCode Search(Session& session, const Options& options) {
  ExitCode code = ExitCode::kOk;
  const auto store = Open(session, options.db, OpenMode::kReadOnly, code);
  if (!store) return code;
  const auto hits = store->Search(options.where, options.most);
  if (!hits) return session.Refuse(hits.error());
  ordered_json list = ordered_json::array();
  TextTable table({{"id", true}, {""}, {"name"}, {"where"}});
  for (const catalog::SearchHit& hit : *hits) {
    const bool layout = hit.kind == catalog::SearchHit::Kind::kLayout;
    const char* kind = layout ? "layout" : "study";
    list.push_back({{"kind", kind},
                    {"id", hit.id},
                    {"name", hit.name},
                    {"formula", layout ? ordered_json(hit.formula) : ordered_json(nullptr)},
                    {"snippet", hit.snippet}});
    table.Row({std::to_string(hit.id), kind, OneLine(hit.name), OneLine(hit.snippet)});
  }
  return Found(session, "found", std::move(list), table);
}

ExitCode Similar(Session& session, const Options& options) {
  ExitCode code = ExitCode::kOk;
  const auto store = Open(session, options.db, OpenMode::kReadOnly, code);
  if (!store) return code;
  const auto similar = store->Similar(options.key, options.most);
  if (!similar) return session.Refuse(similar.error());
  ordered_json list = ordered_json::array();
  TextTable table({{"id", true}, {"similarity", true}, {"name"}, {"formula"}});
  for (const catalog::SimilarLayout& layout : *similar) {
    list.push_back({{"id", layout.id},
                    {"similarity", layout.similarity},
                    {"name", layout.name},
                    {"formula", layout.formula},
                    {"hash", layout.hash}});
    table.Row({std::to_string(layout.id),
               fmt::format("{:.3f}", layout.similarity),
               OneLine(layout.name),
               OneLine(layout.formula)});
  }
  return Found(session, "similar", std::move(list), table);
}

ExitCode Stats(Session& session, const Options& options) {
  ExitCode code = ExitCode::kOk;
  const auto store = Open(session, options.db, OpenMode::kReadOnly, code);
  if (!store) return code;
  const auto statistics = store->Stats();
  if (!statistics) return session.Refuse(statistics.error());
  const ordered_json json = catalog::ToJson(*statistics);
  if (session.json) {
    session.console.Json(json);
    return ExitCode::kOk;
  }
  // The counts have the same names here and for programs.
  TextTable table({{""}, {"", true}});
  for (const auto& [name, value] : json.items()) {
    if (value.is_number()) {
      table.Row({name, value.dump()});
      continue;
    }
    const auto& counts = name == "studies"    ? statistics->studies
                         : name == "rejected" ? statistics->rejected
                         : name == "modules"  ? statistics->modules
                         : name == "plugins"  ? statistics->plugins
                                              : statistics->programs;
    for (const auto& [what, count] : counts)
      table.Row({fmt::format("{}: {}", name, what), std::to_string(count)});
  }
  session.console.Out(table.Render());
  return ExitCode::kOk;
}

ExitCode Verify(Session& session, const Options& options) {
  ExitCode code = ExitCode::kOk;
  const auto store = Open(session, options.db, OpenMode::kReadOnly, code);
  if (!store) return code;
  const auto report = store->Verify();
  if (!report) return session.Refuse(report.error());
  session.console.Report(report->findings);
  if (session.json) {
    session.console.Json({{"ok", report->Ok()},
                          {"layouts", report->layouts},
                          {"calibrations", report->calibrations},
                          {"evaluations", report->evaluations}});
  } else {
    const auto evaluations = static_cast<std::size_t>(report->evaluations);
    session.console.Out(
        fmt::format("{}: {}, {}{}, {}\n",
                    options.db,
                    Counted(static_cast<std::size_t>(report->layouts), "layout"),
                    Counted(static_cast<std::size_t>(report->calibrations), "calibration"),
                    evaluations == 0 ? "" : ", " + Counted(evaluations, "evaluation"),
                    report->Ok() ? "ok" : Counted(report->findings.size(), "fault")));
  }
  return report->Ok() ? ExitCode::kOk : ExitCode::kNegative;
}

/// The subcommands, all with the catalog's file as first argument.
class Builder {
 public:
  Builder(CLI::App& catalog, Session& session) : catalog_(catalog), session_(session) {}

  CLI::App* Add(const char* name,
                const char* title,
                const char* examples,
                ExitCode (*run)(Session&, const Options&)) {
    options_ = std::make_shared<Options>();
    CLI::App* command = session_.Command(catalog_, name, title, examples);
    File(command->add_option("DB", options_->db, "The catalog's file")->required());
    session_.OnRun(
        command, [&session = session_, options = options_, run] { return run(session, *options); });
    return command;
  }
  void File(const CLI::Option* option) { session_.Hint(option, ValueHint::Kind::kFile); }
  /// Of the subcommand added last.
  [[nodiscard]] Options& options() { return *options_; }

 private:
  CLI::App& catalog_;
  Session& session_;
  std::shared_ptr<Options> options_;
};

void AddQuery(Builder& builder) {
  CLI::App* query = builder.Add("query", "Which layouts are so", kQueryExamples, Query);
  Options& options = builder.options();
  query->add_option("EXPRESSION", options.where, "A condition on the columns of layouts; else all");
  query->add_option("--sort", options.sort, "Columns or expressions, each with desc if wanted")
      ->type_name("EXPRESSION");
  query->add_option("--columns", options.columns, "What to print; * is everything")
      ->type_name("LIST");
  query->add_option("--limit", options.limit, "Most rows (1000); 0 is all")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 40U));
  query->add_flag("--csv", options.csv, "As CSV");
}

void AddFinders(Builder& builder, const char* key) {
  const auto limit = [&builder](CLI::App* command) {
    command->add_option("--limit", builder.options().most, "Most answers (20)")
        ->type_name("N")
        ->check(CLI::Range(std::int64_t{1}, std::int64_t{100'000}));
  };
  CLI::App* search =
      builder.Add("search", "Which layouts and studies have these words", kSearchExamples, Search);
  search->add_option("TEXT", builder.options().where, "Words; one that ends in * stands for many")
      ->required();
  limit(search);
  CLI::App* similar =
      builder.Add("similar", "Which layouts are built like this one", kSimilarExamples, Similar);
  similar->add_option("KEY", builder.options().key, key)->required();
  limit(similar);
}

void AddWriters(Builder& builder) {
  CLI::App* add = builder.Add("add", "Put layouts into the catalog", kAddExamples, Add);
  builder.File(add->add_option("FILE", builder.options().files, "Layouts")->required());
  builder.File(add->add_option("--report",
                               builder.options().report,
                               "Report of the calibration that made this layout")
                   ->type_name("JSON"));
  CLI::App* merge =
      builder.Add("merge", "Put other catalogs' layouts into this one", kMergeExamples, Merge);
  builder.File(merge->add_option("OTHER", builder.options().files, "Catalogs")->required());
}

}  // namespace

void AddCatalog(CLI::App& root, Session& session) {
  CLI::App* catalog = session.Command(
      root, "catalog", "Layouts and what is known about them, in one file", kExamples);
  catalog->require_subcommand(0, 1);
  Builder builder(*catalog, session);
  AddWriters(builder);
  AddQuery(builder);
  constexpr const char* kKey = "Name, number, or at least four digits of the hash";
  builder.Add("show", "Everything about one layout", kShowExamples, Show)
      ->add_option("KEY", builder.options().key, kKey)
      ->required();
  CLI::App* out = builder.Add(
      "export", "A layout's file as it was added, or all of it", kExportExamples, Export);
  out->add_option("KEY", builder.options().key, kKey);
  out->add_option("--as", builder.options().as, "Everything as json, csv or toml")
      ->type_name("FORMAT")
      ->check(CLI::IsMember({"json", "csv", "toml"}));
  builder.File(
      out->add_option("-o,--out", builder.options().out, "File or folder to write; else stdout")
          ->type_name("FILE"));
  out->add_flag("--force", builder.options().force, "Replace what exists");
  AddFinders(builder, kKey);
  builder.Add("stats", "How many of what", kStatsExamples, Stats);
  builder.Add("verify", "Look for damage", kVerifyExamples, Verify);
}

}  // namespace kompono::cli
