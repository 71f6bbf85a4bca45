// SPDX-License-Identifier: Apache-2.0
// kompono schema: JSON Schema of layout and study files, for editors.
#include "session.hpp"

#include <memory>
#include <string>

#include "kompono/layout/layout.hpp"
#include "kompono/synthesis/evaluation.hpp"
#include "kompono/synthesis/study.hpp"

namespace kompono::cli {
namespace {

constexpr const char* kExamples =
    "  kompono schema > layout.schema.json      then name it in the editor's TOML settings\n"
    "  kompono schema study > study.schema.json";

}  // namespace

void AddSchema(CLI::App& root, Session& session) {
  CLI::App* command =
      session.Command(root, "schema", "JSON Schema of layout and study files", kExamples);
  const auto kind = std::make_shared<std::string>("layout");
  session.Choices(command->add_option("KIND", *kind, "layout (if not given) or study"),
                  {"layout", "study"});
  session.OnRun(command, [&session, kind] {
    std::string schema = *kind == "study"
                             ? synthesis::StudySchema(session.registry(), synthesis::MetricNames())
                             : layout::LayoutSchema(session.registry());
    if (!schema.ends_with('\n')) schema += '\n';
    session.console.Out(schema);
    return ExitCode::kOk;
  });
}

}  // namespace kompono::cli
