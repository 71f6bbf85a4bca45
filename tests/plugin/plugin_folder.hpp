// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_PLUGIN_PLUGIN_FOLDER_HPP_
#define KOMPONO_TESTS_PLUGIN_PLUGIN_FOLDER_HPP_

#include <stdlib.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "kompono/plugin/registry.hpp"

namespace kompono::plugin {

inline std::filesystem::path Fixture(std::string_view library) {
  return std::filesystem::path(KOMPONO_FIXTURES) / library;
}

/// The sidecar that fits fixtures/manifest.c.
inline constexpr std::string_view kDummySidecar = R"(kompono = 1
id = "org.example.dummy"
version = "0.1.0"
contract = "1.0"
library = "libdummy.so"
[[module]]
id = "dummy"
kind = "mechanism"
title = "Dummy"
letters = "X"
drives = [{ name = "q", kind = "linear" }]
)";

/// The sidecar that fits fixtures/slide.cpp; the first module alone fits most of the others.
inline constexpr std::string_view kSlideSidecar = R"(kompono = 1
id = "org.example.slide"
version = "0.1.0"
contract = "1.0"
library = "libslide.so"
[[module]]
id = "slide"
kind = "mechanism"
title = "Slide"
letters = "X"
drives = [{ name = "q", kind = "linear" }]
[[module.parameter]]
name = "offset"
unit = "mm"
default = 0.0
range = [-100.0, 100.0]
meaning = "x where the drive reads 0"
)";
inline constexpr std::string_view kNoseModule = R"([[module]]
id = "nose"
kind = "unit"
title = "Nose"
stations = ["nose"]
)";

/// A folder of plugins of its own for one test, removed at the end.
class PluginFolder {
 public:
  PluginFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "kompono_plugins_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder");
    root_ = std::filesystem::canonical(name);
  }
  PluginFolder(const PluginFolder&) = delete;
  PluginFolder& operator=(const PluginFolder&) = delete;
  ~PluginFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(root_, ignored);
  }

  [[nodiscard]] const std::filesystem::path& root() const { return root_; }

  std::filesystem::path Add(std::string_view name, std::string_view sidecar) const {
    const std::filesystem::path folder = root_ / name;
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "plugin.toml") << sidecar;
    OnlyOwnerWrites(folder);
    OnlyOwnerWrites(folder / "plugin.toml");
    return folder;
  }
  /// With fixtures/`library` beside the sidecar as `as`.
  std::filesystem::path Add(std::string_view name,
                            std::string_view sidecar,
                            std::string_view library,
                            std::string_view as) const {
    const std::filesystem::path folder = Add(name, sidecar);
    std::filesystem::copy_file(Fixture(library), folder / as);
    OnlyOwnerWrites(folder / as);
    return folder;
  }

  [[nodiscard]] Registry Discover() const {
    return Registry::Discover(std::array<std::filesystem::path, 1>{root_});
  }

  /// The text without the folder's random name.
  [[nodiscard]] std::string Plain(std::string text) const {
    const std::string name = root_.string();
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name))
      text.replace(at, name.size(), "<plugins>");
    return text;
  }
  [[nodiscard]] std::string Plain(const Diagnostic& diagnostic) const {
    return Plain(Render(diagnostic, {}));
  }
  [[nodiscard]] std::string Plain(const Diagnostics& diagnostics) const {
    return Plain(RenderAll(diagnostics, {}));
  }

 private:
  /// Whatever the umask of the machine that runs the tests.
  static void OnlyOwnerWrites(const std::filesystem::path& path) {
    std::filesystem::permissions(
        path, std::filesystem::perms::others_write, std::filesystem::perm_options::remove);
  }

  std::filesystem::path root_;
};

}  // namespace kompono::plugin

#endif  // KOMPONO_TESTS_PLUGIN_PLUGIN_FOLDER_HPP_
