// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_TOUR_CONSOLE_HPP_
#define KOMPONO_TESTS_TOUR_CONSOLE_HPP_

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Console blocks of a Markdown document: what is typed and what is shown to come out.
///
///     ```console
///     $ kompono formula XYZOC_v
///     part X Y Z O C_v tool
///     ...
///     ```
///
/// A line that starts with "$ " is a command (a backslash at its end continues it); the lines up to
/// the next command are its standard output. A line "..." stands for any number of lines, also
/// none. Blanks at the end of a line do not count. A duration, a number followed by " s" or " ms",
/// equals any other duration. Everything else must be the same to the letter.
namespace kompono::tour {

struct Step {
  std::string command;
  std::vector<std::string> expected;
  std::size_t line = 0;  ///< of the command in the document, counted from 1
  std::size_t first_expected = 0, end_expected = 0;  ///< index range in Document::lines
};

struct Document {
  std::vector<std::string> lines;
  std::vector<Step> steps;
};

[[nodiscard]] std::vector<std::string> Lines(std::string_view text);

/// @throws std::runtime_error if a block is not closed or shows output before any command.
[[nodiscard]] Document ReadDocument(std::string_view text);

/// Whether the output is what the document shows.
[[nodiscard]] bool Matches(const std::vector<std::string>& expected,
                           const std::vector<std::string>& actual);

}  // namespace kompono::tour

#endif  // KOMPONO_TESTS_TOUR_CONSOLE_HPP_
