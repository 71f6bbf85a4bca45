// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_CLI_PROGRAM_HPP_
#define KOMPONO_TESTS_CLI_PROGRAM_HPP_

#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kompono::cli_test {

struct Outcome {
  int code = -1;  ///< exit code; 128 + number if a signal ended it
  std::string out, err;
};

/// Every test runs the program in a folder of its own, without colours or plugins from outside.
class Program : public testing::Test {
 protected:
  Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() override;

  /// The program with these arguments, standard input from `input`.
  [[nodiscard]] Outcome Run(const std::vector<std::string>& arguments,
                            const std::string& input = "") const;
  /// The same through `sh -c`, where "$K" is the program.
  [[nodiscard]] Outcome Shell(const std::string& command) const;
  /// A run with --json that must give one document on stdout and nothing on stderr.
  [[nodiscard]] nlohmann::json Json(std::vector<std::string> arguments, int code = 0) const;

  /// For the next runs.
  void Set(const std::string& variable, const std::string& value) { variables_[variable] = value; }

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  void Write(const std::string& file, const std::string& text) const;
  [[nodiscard]] std::string Read(const std::string& file) const;
  [[nodiscard]] std::vector<std::string> Files() const;

  /// A file of layouts/machines.
  [[nodiscard]] static std::string Machine(const std::string& name);
  [[nodiscard]] static std::string Source(const std::string& path);

 private:
  [[nodiscard]] Outcome Execute(const std::vector<std::string>& words,
                                const std::string& input) const;

  std::filesystem::path folder_;
  std::map<std::string, std::string> variables_;
};

/// The lines of `text`, without their ends.
[[nodiscard]] std::vector<std::string> Lines(const std::string& text);

/// A CSV table by column name.
[[nodiscard]] std::vector<std::map<std::string, std::string>> Csv(const std::string& text);

}  // namespace kompono::cli_test

#endif  // KOMPONO_TESTS_CLI_PROGRAM_HPP_
