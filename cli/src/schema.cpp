// SPDX-License-Identifier: Apache-2.0
// kompono schema: JSON Schema of layout files, for editors.
#include "session.hpp"

#include "kompono/layout/layout.hpp"

namespace kompono::cli {
namespace {

constexpr const char* kExamples =
    "  kompono schema > layout.schema.json      then name it in the editor's TOML settings";

}  // namespace

void AddSchema(CLI::App& root, Session& session) {
  const CLI::App* command =
      session.Command(root, "schema", "JSON Schema of layout files, for editors", kExamples);
  session.OnRun(command, [&session] {
    std::string schema = layout::LayoutSchema(session.registry());
    if (!schema.ends_with('\n')) schema += '\n';
    session.console.Out(schema);
    return ExitCode::kOk;
  });
}

}  // namespace kompono::cli
