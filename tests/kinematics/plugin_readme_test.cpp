// SPDX-License-Identifier: Apache-2.0
// Every mechanism's folder explains itself: a README with equations, modes, singularities and
// sources, and a drawing that the program made of one of the shipped machines.
#include "shipped_machines.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

namespace kompono {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = KOMPONO_SOURCE_DIR;

std::string Bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

constexpr std::array<const char*, 10> kPlugins{"biglide",
                                               "lambda",
                                               "tripod",
                                               "pyramid",
                                               "hexapod",
                                               "hexaglide",
                                               "pentapod",
                                               "rotary_delta",
                                               "four_strut_lathe",
                                               "six_strut_lathe"};

TEST(PluginReadme, HasEquationsModesSingularitiesSourcesAndADrawing) {
  for (const std::string plugin : kPlugins) {
    SCOPED_TRACE(plugin);
    const std::string readme = Bytes(kSource / "plugins" / plugin / "README.md");
    ASSERT_FALSE(readme.empty());
    for (const char* word : {"ingular", "mode", "ource", "    "})
      EXPECT_NE(readme.find(word), std::string::npos) << word;
    const std::regex picture(R"(!\[[^\]]+\]\(\.\./\.\./docs/pictures/([a-z0-9_]+)\.svg\))");
    int pictures = 0;
    for (std::sregex_iterator i(readme.begin(), readme.end(), picture), end; i != end; ++i) {
      ++pictures;
      const std::string machine_name = (*i)[1];
      const std::string drawing = Bytes(kSource / "docs/pictures" / (machine_name + ".svg"));
      const kinematics::Machine machine = tests::LoadMachine(machine_name);
      bool of_this_plugin = false;
      for (const auto& view : machine.blocks())
        of_this_plugin |= view.description->plugin_id.ends_with("." + plugin);
      EXPECT_TRUE(of_this_plugin) << machine_name;
      // Drawn from the skeleton: one line for each of its links, in the machine's present number.
      std::size_t lines = 0;
      for (std::size_t at = drawing.find("<line"); at != std::string::npos;
           at = drawing.find("<line", at + 1))
        ++lines;
      const auto skeleton = machine.Skeleton(machine.home(), machine.nominal());
      EXPECT_GE(lines, skeleton.links.size()) << machine_name;
    }
    EXPECT_GE(pictures, 1);
  }
}

}  // namespace
}  // namespace kompono
