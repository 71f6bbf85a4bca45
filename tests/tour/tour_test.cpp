// SPDX-License-Identifier: Apache-2.0
// Does what README.md shows: every console block, in the order of the document, with the program
// just built first on the PATH, in a fresh folder that has the repository's layouts/ and docs/.
//
// With KOMPONO_UPDATE_TOUR=1 in the environment README.md is rewritten with what really came out.
#include "console.hpp"
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace kompono::tour {
namespace {

namespace fs = std::filesystem;

std::string Bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string Joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// A folder for one walk through a document; removed afterwards.
class Playground {
 public:
  Playground()
      : folder_(fs::temp_directory_path() / ("kompono-tour-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    for (const char* name : {"layouts", "docs"}) {
      fs::create_directory_symlink(fs::path(KOMPONO_SOURCE_DIR) / name, folder_ / name);
    }
  }
  Playground(const Playground&) = delete;
  Playground& operator=(const Playground&) = delete;
  ~Playground() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  struct Outcome {
    std::vector<std::string> output;
    std::string talk;  ///< standard error
    int status = -1;
  };

  [[nodiscard]] Outcome Run(const std::string& command) const {
    const std::string script = "cd '" + folder_.string() +
                               "' || exit 99\n"
                               "export PATH='" KOMPONO_BINARY_DIR
                               "/bin':/usr/bin:/bin HOME=. NO_COLOR=1 LC_ALL=C.UTF-8\n"
                               "unset KOMPONO_PLUGIN_PATH\n" +
                               command + "\n";
    std::ofstream(folder_ / ".script") << script;
    const std::string base = folder_.string() + "/.";
    const int raw = std::system(
        ("bash '" + base + "script' </dev/null >'" + base + "out' 2>'" + base + "err'").c_str());
    return {.output = Lines(Bytes(base + "out")),
            .talk = Bytes(base + "err"),
            .status = WIFEXITED(raw) ? WEXITSTATUS(raw) : -1};
  }

 private:
  fs::path folder_;
};

void Rewrite(const fs::path& file,
             Document document,
             const std::vector<std::vector<std::string>>& outputs) {
  for (std::size_t i = document.steps.size(); i-- > 0;) {
    const Step& step = document.steps[i];
    if (Matches(step.expected, outputs[i])) continue;
    const auto at = document.lines.begin();
    const auto place = document.lines.erase(at + static_cast<std::ptrdiff_t>(step.first_expected),
                                            at + static_cast<std::ptrdiff_t>(step.end_expected));
    document.lines.insert(place, outputs[i].begin(), outputs[i].end());
  }
  std::ofstream(file) << Joined(document.lines);
}

TEST(Tour, ReadmeShowsWhatTheProgramDoes) {
  const fs::path file = fs::path(KOMPONO_SOURCE_DIR) / "README.md";
  const Document document = ReadDocument(Bytes(file));
  ASSERT_GE(document.steps.size(), 5U) << "the tour has lost its commands";
  const bool update = std::getenv("KOMPONO_UPDATE_TOUR") != nullptr;
  const Playground playground;
  std::vector<std::vector<std::string>> outputs;
  for (const Step& step : document.steps) {
    const Playground::Outcome outcome = playground.Run(step.command);
    outputs.push_back(outcome.output);
    if (update) continue;
    EXPECT_TRUE(Matches(step.expected, outcome.output))
        << "README.md:" << step.line << ": $ " << step.command << "\n--- shown\n"
        << Joined(step.expected) << "--- came out (exit status " << outcome.status << ")\n"
        << Joined(outcome.output) << "--- on standard error\n"
        << outcome.talk;
  }
  if (update) Rewrite(file, document, outputs);
}

/// The targets of [text](target) and ![text](target) that are files of the repository.
std::vector<std::string> LocalLinks(const std::string& text) {
  static const std::regex link(R"(\]\(([^)#:\s]+)(#[^)]*)?\))");
  std::vector<std::string> targets;
  for (std::sregex_iterator i(text.begin(), text.end(), link); i != std::sregex_iterator(); ++i) {
    targets.push_back((*i)[1]);
  }
  return targets;
}

TEST(Links, AreFoundInText) {
  EXPECT_EQ(LocalLinks("see [a](docs/a.md#part), ![b](b.svg) and [c](https://example.org/c)"),
            (std::vector<std::string>{"docs/a.md", "b.svg"}));
}

TEST(Links, LeadToFiles) {
  const fs::path root = KOMPONO_SOURCE_DIR;
  std::vector<fs::path> documents{root / "README.md", root / "CONTRIBUTING.md"};
  for (const auto& entry : fs::directory_iterator(root / "docs")) {
    if (entry.path().extension() == ".md") documents.push_back(entry.path());
  }
  for (const fs::path& document : documents) {
    for (const std::string& target : LocalLinks(Bytes(document))) {
      EXPECT_TRUE(fs::exists(document.parent_path() / target))
          << document << " links to " << target;
    }
  }
}

}  // namespace
}  // namespace kompono::tour
