// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

namespace kompono::cli_test {
namespace {

namespace fs = std::filesystem;

std::string Bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

fs::path NewFolder() {
  std::string name = (fs::temp_directory_path() / "kompono-cli-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  return name;
}

void Redirect(const fs::path& file, int flags, int descriptor) {
  const int opened = ::open(file.c_str(), flags, 0600);
  if (opened < 0 || ::dup2(opened, descriptor) < 0) ::_exit(126);
}

}  // namespace

Program::Program() : folder_(NewFolder()) {
  // The streams' files stand outside the folder in which the program works.
  fs::create_directory(folder_ / "work");
  variables_ = {{"PATH", std::getenv("PATH") == nullptr ? "/usr/bin:/bin" : std::getenv("PATH")},
                {"HOME", folder_.string()},
                {"LC_ALL", "C.UTF-8"},
                {"K", KOMPONO_PROGRAM}};
  for (const char* kept : {"ASAN_OPTIONS", "UBSAN_OPTIONS", "LSAN_OPTIONS", "TSAN_OPTIONS"}) {
    if (std::getenv(kept) != nullptr) variables_[kept] = std::getenv(kept);
  }
}

Program::~Program() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

Outcome Program::Execute(const std::vector<std::string>& words, const std::string& input) const {
  {
    std::ofstream out(folder_ / "stdin", std::ios::binary);
    out << input;
  }
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    Redirect(folder_ / "stdin", O_RDONLY, STDIN_FILENO);
    Redirect(folder_ / "stdout", O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
    Redirect(folder_ / "stderr", O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
    if (::chdir((folder_ / "work").c_str()) != 0) ::_exit(126);
    std::vector<std::string> settings;
    settings.reserve(variables_.size());
    for (const auto& [name, value] : variables_)
      settings.push_back(std::string(name).append("=").append(value));
    std::vector<char*> environment;
    environment.reserve(settings.size() + 1);
    for (std::string& setting : settings) environment.push_back(setting.data());
    environment.push_back(nullptr);
    std::vector<std::string> copies = words;
    std::vector<char*> arguments;
    arguments.reserve(copies.size() + 1);
    for (std::string& word : copies) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    ::execve(arguments.front(), arguments.data(), environment.data());
    ::_exit(127);
  }
  int status = 0;
  if (::waitpid(child, &status, 0) != child) throw std::runtime_error("waitpid failed");
  return {.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          .out = Bytes(folder_ / "stdout"),
          .err = Bytes(folder_ / "stderr")};
}

Outcome Program::Run(const std::vector<std::string>& arguments, const std::string& input) const {
  std::vector<std::string> words{KOMPONO_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return Execute(words, input);
}

Outcome Program::Shell(const std::string& command) const {
  return Execute({"/bin/bash", "-c", command}, "");
}

nlohmann::json Program::Json(std::vector<std::string> arguments, int code) const {
  arguments.emplace_back("--json");
  const Outcome outcome = Run(arguments);
  EXPECT_EQ(outcome.code, code) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.err, "");
  nlohmann::json document = nlohmann::json::parse(outcome.out, nullptr, false);
  EXPECT_FALSE(document.is_discarded()) << outcome.out;
  return document;
}

void Program::Write(const std::string& file, const std::string& text) const {
  std::ofstream out(folder_ / "work" / file, std::ios::binary);
  out << text;
  if (!out) throw std::runtime_error("cannot write " + file);
}

std::string Program::Read(const std::string& file) const {
  return Bytes(folder_ / "work" / file);
}

std::vector<std::string> Program::Files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_ / "work"))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string Program::Machine(const std::string& name) {
  return Source("layouts/machines/" + name + ".toml");
}

std::string Program::Source(const std::string& path) {
  return (fs::path(KOMPONO_SOURCE_DIR) / path).string();
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::map<std::string, std::string>> Csv(const std::string& text) {
  std::vector<std::map<std::string, std::string>> rows;
  std::vector<std::string> headings;
  for (const std::string& line : Lines(text)) {
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (const char c : line) {
      if (c == '"') {
        quoted = !quoted;
      } else if (c == ',' && !quoted) {
        fields.emplace_back();
      } else {
        fields.back() += c;
      }
    }
    if (headings.empty()) {
      headings = fields;
      continue;
    }
    EXPECT_EQ(fields.size(), headings.size()) << line;
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < std::min(fields.size(), headings.size()); ++i)
      row[headings[i]] = fields[i];
    rows.push_back(row);
  }
  return rows;
}

}  // namespace kompono::cli_test
