// SPDX-License-Identifier: Apache-2.0
// ReplaceNumbers: the numbers a calibration found, put into the text of the layout they belong to.
#include "number_places.hpp"
#include "shape.hpp"
#include "toml_edit.hpp"
#include "units.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "kompono/diagnostics/suggestion.hpp"
#include "kompono/layout/codes.hpp"
#include "kompono/layout/layout.hpp"

namespace kompono::layout {
namespace {

/// Written numbers must read back this well, relatively.
constexpr double kReadBack = 1e-12;

bool Same(double a, double b) {
  return std::abs(a - b) <= kReadBack * std::max(std::abs(a), std::abs(b));
}

double FactorOf(const Number& number, const Units& units) {
  return number.pure ? 1.0 : units.Of(number.angle);
}

/// A number in the file's unit whose product with `factor` is `value`, the roundest of its
/// neighbours; the quotient itself if rounding lets none of them through.
double InFileUnit(double value, double factor) {
  const double quotient = value / factor;
  if (quotient * factor == value && factor == 1.0) return quotient;
  const double round = std::stod(fmt::format("{:.15g}", quotient));
  if (round * factor == value) return round;
  for (const double toward : {-HUGE_VAL, HUGE_VAL}) {
    const double neighbour = std::nextafter(quotient, toward);
    if (quotient * factor != value && neighbour * factor == value) return neighbour;
  }
  return quotient;
}

struct Change {
  double value = 0.0;
  double before = 0.0;
  std::optional<double> sigma;
  const Number* number = nullptr;
};

class Rewriter {
 public:
  Rewriter(const Layout& layout, const plugin::Registry& registry)
      : layout_(layout),
        registry_(registry),
        places_(ValuePlacesOf(layout, registry)),
        edit_(layout.text),
        units_(UnitsOf(edit_.root())) {}

  Parsed<std::string> Rewrite(const std::vector<Replacement>& replacements,
                              std::string_view source) {
    for (const Replacement& replacement : replacements) Accept(replacement);
    if (!complaints_.empty()) return tl::unexpected(std::move(complaints_));
    for (const ValuePlace& place : places_) Write(place);
    WriteOrigin(source);
    if (complaints_.empty()) ReadBack();
    if (!complaints_.empty()) return tl::unexpected(std::move(complaints_));
    return edit_.text();
  }

 private:
  void Complain(const CodeTitle& code, std::string message, std::string help = {}) {
    complaints_.push_back({.severity = Severity::kError,
                           .code = std::string(code.code),
                           .file = layout_.file.string(),
                           .span = {},
                           .message = std::move(message),
                           .help = std::move(help)});
  }

  void Accept(const Replacement& replacement) {
    std::vector<std::string> names;
    for (const ValuePlace& place : places_) {
      for (const Number& number : place.numbers) {
        const auto& others = number.other_names;
        names.push_back(number.name);
        if (number.name != replacement.parameter &&
            std::find(others.begin(), others.end(), replacement.parameter) == others.end())
          continue;
        if (!std::isfinite(replacement.value)) {
          return Complain(codes::kNotFinite,
                          fmt::format("'{}' cannot become {}", number.name, replacement.value));
        }
        changes_[number.name] = {replacement.value, number.value, replacement.sigma, &number};
        return;
      }
    }
    Complain(codes::kUnknownNumber,
             fmt::format("the layout has no number '{}'", replacement.parameter),
             DidYouMean(replacement.parameter, names));
  }

  [[nodiscard]] double NewValue(const Number& number) const {
    const auto change = changes_.find(number.name);
    return change == changes_.end() ? number.value : change->second.value;
  }
  [[nodiscard]] std::string Text(const Number& number) const {
    return TomlNumber(InFileUnit(NewValue(number), FactorOf(number, units_)));
  }

  /// Single elements where the file has them, so that comments between them stay; else the value.
  void Write(const ValuePlace& place) {
    const bool changed =
        std::any_of(place.numbers.begin(), place.numbers.end(), [this](const Number& number) {
          return changes_.count(number.name) != 0;
        });
    if (!changed) return;
    const toml::node* node = edit_.Find(place.path);
    if (node == nullptr) {
      if (!edit_.Add(place.path, Whole(place)))
        Complain(codes::kCannotWrite,
                 fmt::format("there is no place for '{}' in the file", place.numbers.front().name));
      return;
    }
    if (!node->is_array()) return edit_.Replace(place.path, {}, Whole(place));
    for (std::size_t i = 0; i < place.numbers.size(); ++i) {
      if (changes_.count(place.numbers[i].name) == 0) continue;
      std::vector<std::size_t> indices{i};
      if (place.points) indices = {i / 3, i % 3};
      edit_.Replace(place.path, indices, Text(place.numbers[i]));
    }
  }

  [[nodiscard]] std::string Whole(const ValuePlace& place) const {
    if (place.columns == 0) return Text(place.numbers.front());
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < place.numbers.size(); i += place.columns) {
      std::vector<std::string> row;
      for (std::size_t k = 0; k < place.columns; ++k) row.push_back(Text(place.numbers[i + k]));
      rows.push_back(fmt::format("[{}]", fmt::join(row, ", ")));
    }
    return place.points ? fmt::format("[{}]", fmt::join(rows, ", ")) : rows.front();
  }

  void Put(const TomlEdit::Path& path, const std::string& value) {
    if (edit_.Find(path) != nullptr) return edit_.Replace(path, {}, value);
    if (!edit_.Add(path, value, true))
      Complain(codes::kCannotWrite, fmt::format("'{}' has no place in [calibrated]", path.back()));
  }

  /// What an earlier calibration kept as nominal stays nominal.
  void WriteOrigin(std::string_view source) {
    Put({"calibrated", "source"}, TomlString(source));
    // In the order of the layout; the map would put them by the alphabet.
    for (const bool sigma : {false, true}) {
      for (const ValuePlace& place : places_) {
        for (const Number& number : place.numbers) {
          const auto found = changes_.find(number.name);
          if (found == changes_.end()) continue;
          const double factor = FactorOf(number, units_);
          const TomlEdit::Path path{"calibrated", sigma ? "sigma" : "nominal", number.name};
          if (!sigma) {
            if (edit_.Find(path) == nullptr)
              Put(path, TomlNumber(InFileUnit(number.value, factor)));
          } else if (found->second.sigma && std::isfinite(*found->second.sigma)) {
            Put(path, TomlNumber(*found->second.sigma / factor));
          } else {
            edit_.Remove(path);
          }
        }
      }
    }
  }

  void ReadBack() {
    const Parsed<Layout> again =
        ParseLayout(edit_.text(), layout_.file.string(), registry_, nullptr);
    if (!again) {
      complaints_ = again.error();
      return;
    }
    const std::vector<ValuePlace> places = ValuePlacesOf(*again, registry_);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      for (std::size_t k = 0; k < places_[i].numbers.size(); ++k) {
        const Number& number = places_[i].numbers[k];
        if (i < places.size() && k < places[i].numbers.size() &&
            places[i].numbers[k].name == number.name &&
            Same(places[i].numbers[k].value, NewValue(number)))
          continue;
        Complain(codes::kCannotWrite,
                 fmt::format("'{}' does not read back as {}", number.name, NewValue(number)));
      }
    }
  }

  const Layout& layout_;
  const plugin::Registry& registry_;
  std::vector<ValuePlace> places_;
  TomlEdit edit_;
  Units units_;
  std::map<std::string, Change> changes_;  ///< by the number's name
  Diagnostics complaints_;
};

}  // namespace

Parsed<std::string> ReplaceNumbers(const Layout& layout,
                                   const plugin::Registry& registry,
                                   const std::vector<Replacement>& replacements,
                                   std::string_view source) {
  try {
    return Rewriter(layout, registry).Rewrite(replacements, source);
  } catch (const toml::parse_error& error) {
    return tl::unexpected(Diagnostics{
        {.severity = Severity::kError,
         .code = std::string(codes::kCannotWrite.code),
         .file = layout.file.string(),
         .span = {},
         .message = fmt::format("the layout's text is no TOML: {}", error.description()),
         .help = ""}});
  }
}

}  // namespace kompono::layout
