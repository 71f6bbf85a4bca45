// SPDX-License-Identifier: Apache-2.0
// kompono plugins: what is installed, what a module's parameters mean, why a plugin is disabled.
#include "codes.hpp"
#include "module_sheet.hpp"
#include "session.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::cli {
namespace {

using nlohmann::ordered_json;

constexpr const char* kExamples =
    "  kompono plugins                      everything that is installed\n"
    "  kompono plugins lambda               a module's parameters, assembly modes, drives\n"
    "  kompono plugins --load               load every library and check what it says of itself";

struct Options {
  std::string id;
  bool load = false;
  bool names = false;
};

std::vector<std::string> ModuleIds(const plugin::PluginRecord& record) {
  std::vector<std::string> ids;
  for (const plugin::ModuleDescription& module : record.description.modules)
    ids.push_back(module.id);
  return ids;
}

ordered_json RecordJson(const plugin::PluginRecord& record) {
  const plugin::PluginDescription& description = record.description;
  ordered_json out{
      {"id", description.id},
      {"version", description.version},
      {"contract", fmt::format("{}.{}", description.contract_major, description.contract_minor)},
      {"library", description.library},
      {"sidecar", description.sidecar.string()},
      {"enabled", record.enabled},
      {"modules", ModuleIds(record)},
      {"reasons", ToJson(record.reasons)}};
  if (!record.compiler.empty()) out["compiler"] = record.compiler;
  return out;
}

std::string RecordName(const plugin::PluginRecord& record) {
  // A sidecar that cannot be read has no id; its place tells which one it is.
  return record.description.id.empty() ? record.description.sidecar.string()
                                       : record.description.id;
}

void PrintList(Console& console, const plugin::Registry& registry) {
  TextTable table({{"plugin"}, {"version"}, {"state"}, {"modules"}});
  for (const plugin::PluginRecord& record : registry.plugins()) {
    table.Row({RecordName(record),
               record.description.version,
               record.enabled ? "enabled" : "disabled",
               Joined(ModuleIds(record))});
    for (const Diagnostic& reason : record.reasons) {
      table.Line(fmt::format("      {} [{}]", reason.message, reason.code));
      if (!reason.help.empty()) table.Line("      help: " + reason.help);
    }
  }
  console.Out(table.Render());
}

void PrintPlugin(Console& console, const plugin::PluginRecord& record) {
  const plugin::PluginDescription& plugin = record.description;
  console.Out(fmt::format("{} {} ({})\n",
                          console.Paint(plugin.id, Hue::kBold),
                          plugin.version,
                          record.enabled ? "enabled" : "disabled"));
  console.Out(fmt::format("  contract {}.{}, {}, {}\n",
                          plugin.contract_major,
                          plugin.contract_minor,
                          plugin.library.empty() ? "presets only" : plugin.library,
                          plugin.sidecar.string()));
  if (!record.compiler.empty()) console.Out(fmt::format("  compiler {}\n", record.compiler));
  for (const Diagnostic& reason : record.reasons) {
    console.Out(Render(reason, {.color = false}));
  }
  for (const plugin::ModuleDescription& module : plugin.modules) {
    console.Out("\n" + ModuleText(module));
  }
}

ExitCode Unknown(Session& session, const std::string& id) {
  const plugin::Registry& registry = session.registry();
  std::vector<std::string> known;
  for (const plugin::ModuleDescription& module : registry.modules()) known.push_back(module.id);
  for (const plugin::PluginRecord& record : registry.plugins())
    known.push_back(record.description.id);
  session.console.Report({{.code = std::string(codes::kUnknownModule.code),
                           .message = fmt::format("no plugin or module is called '{}'", id),
                           .help = DidYouMean(id, known, 40)}});
  return ExitCode::kNegative;
}

ExitCode ShowOne(Session& session, const std::string& id) {
  Console& console = session.console;
  const plugin::Registry& registry = session.registry();
  if (const plugin::ModuleDescription* module = registry.Find(id)) {
    if (session.json) {
      console.Json(ModuleJson(*module));
    } else {
      console.Out(ModuleText(*module));
    }
    return ExitCode::kOk;
  }
  for (const plugin::PluginRecord& record : registry.plugins()) {
    if (record.description.id != id) continue;
    if (session.json) {
      ordered_json out = RecordJson(record);
      out["modules"] = ordered_json::array();
      for (const plugin::ModuleDescription& module : record.description.modules)
        out["modules"].push_back(ModuleJson(module));
      console.Json(std::move(out));
    } else {
      PrintPlugin(console, record);
    }
    return ExitCode::kOk;
  }
  return Unknown(session, id);
}

ExitCode Run(Session& session, const Options& options) {
  plugin::Registry& registry = session.registry();
  if (options.load) registry.LoadAll();
  if (options.names) {
    for (const plugin::ModuleDescription& module : registry.modules())
      session.console.Out(module.id + "\n");
    return ExitCode::kOk;
  }
  if (!options.id.empty()) return ShowOne(session, options.id);
  if (session.json) {
    ordered_json list = ordered_json::array();
    for (const plugin::PluginRecord& record : registry.plugins())
      list.push_back(RecordJson(record));
    session.console.Json({{"plugins", std::move(list)}});
  } else {
    PrintList(session.console, registry);
  }
  if (registry.plugins().empty()) {
    session.console.Say("no plugins found; give --plugin-dir or set KOMPONO_PLUGIN_PATH");
    return ExitCode::kNegative;
  }
  return ExitCode::kOk;
}

}  // namespace

void AddPlugins(CLI::App& root, Session& session) {
  CLI::App* command =
      session.Command(root, "plugins", "What is installed, and what a module expects", kExamples);
  const auto options = std::make_shared<Options>();
  session.Hint(command->add_option("ID", options->id, "A plugin's or module's id"),
               ValueHint::Kind::kModule);
  command->add_flag("--load", options->load, "Load every library and check it against its sidecar");
  command->add_flag("--names", options->names, "Ids of the modules only, one a line");
  session.OnRun(command, [&session, options] { return Run(session, *options); });
}

}  // namespace kompono::cli
