// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_ASSIGNMENTS_HPP_
#define KOMPONO_CLI_ASSIGNMENTS_HPP_

#include "codes.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"

/// Arguments such as `--pose X=10,Y=20` and `--region X=-50:50`: all their faults at once, each
/// with its place in the argument.
namespace kompono::cli {

/// One piece `name=value` of an option's text; offsets are into `Argument::text`.
struct Assignment {
  std::string name, value;
  std::size_t name_begin = 0, value_begin = 0;
};

/// An option with everything that was given to it.
class Argument {
 public:
  /// Several uses of one option are read as one text with commas.
  Argument(std::string option, const std::vector<std::string>& uses);

  [[nodiscard]] const std::string& option() const { return option_; }
  [[nodiscard]] const std::string& text() const { return text_; }

  /// The pieces between the commas, none if the option was not given; E0609 for those without '='.
  [[nodiscard]] std::vector<Assignment> Split(Diagnostics& problems) const;

  /// A complaint about `length` bytes of the text.
  [[nodiscard]] Diagnostic Complaint(const CodeTitle& code,
                                     std::size_t begin,
                                     std::size_t length,
                                     std::string message,
                                     std::string help = "") const;

  /// The number, or a complaint (E0608) among `problems`.
  [[nodiscard]] std::optional<double> Number(const Assignment& assignment,
                                             Diagnostics& problems) const;
  /// `lower:upper`, in this order.
  struct Interval {
    double lower = 0.0, upper = 0.0;
  };
  [[nodiscard]] std::optional<Interval> Range(const Assignment& assignment,
                                              Diagnostics& problems) const;

 private:
  std::string option_;  ///< "--pose"
  std::string text_;
  bool given_ = false;
};

/// What a name may stand for: `drive.q1`, or `q1` if only one block has such a thing, in either
/// letter case.
class NameTable {
 public:
  NameTable(std::string what, std::vector<std::string> names)
      : what_(std::move(what)), names_(std::move(names)), others_(names_.size()) {}
  /// The first of each thing's forms is its name, the others count as much.
  NameTable(std::string what, std::vector<std::vector<std::string>> forms);

  /// The index, or a complaint (E0604, E0606) among `problems`; E0605 for one that `taken` has
  /// already.
  [[nodiscard]] std::optional<std::size_t> Find(const Argument& argument,
                                                const Assignment& assignment,
                                                std::vector<bool>& taken,
                                                Diagnostics& problems) const;
  [[nodiscard]] std::vector<std::size_t> Matches(std::string_view name) const;
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  std::string what_;  ///< "drive"
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> others_;  ///< further forms of each
};

/// Numbers for the names of `table`, in its order; those not given are empty.
[[nodiscard]] std::vector<std::optional<double>> ReadNumbers(const Argument& argument,
                                                             const NameTable& table,
                                                             Diagnostics& problems);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_ASSIGNMENTS_HPP_
