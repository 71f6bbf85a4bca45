// SPDX-License-Identifier: Apache-2.0
#include "notation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

namespace kompono::expression_internal {
namespace {

constexpr double kWhole = 1e15;  // whole numbers below are exact and printed with all digits

constexpr std::array<std::string_view, 25> kGreek = {
    "alpha",   "beta",   "gamma", "delta", "epsilon", "zeta",  "eta",  "theta", "iota",
    "kappa",   "lambda", "mu",    "nu",    "xi",      "pi",    "rho",  "sigma", "tau",
    "upsilon", "phi",    "chi",   "psi",   "omega",   "Delta", "Omega"};

bool IsLetter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}
bool IsDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::string WithoutTrailingZeros(std::string text) {
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string Digits(double value, const Notation& notation) {
  if (value == std::trunc(value) && std::abs(value) < kWhole) return fmt::format("{:.0f}", value);
  if (notation.decimals >= 0 && std::abs(value) < kWhole) {
    std::string text = WithoutTrailingZeros(fmt::format("{:.{}f}", value, notation.decimals));
    if (text != "0" && text != "-0") return text;
  }
  return fmt::format("{:.{}g}", value, std::max(notation.digits, 1));
}

}  // namespace

std::string FormatNumber(double value, const Notation& notation) {
  if (std::isnan(value)) return notation.latex ? "\\mathrm{nan}" : "nan";
  if (std::isinf(value)) {
    const std::string infinity = notation.latex ? "\\infty" : "inf";
    return value < 0 ? "-" + infinity : infinity;
  }
  std::string text = Digits(value, notation);
  const std::size_t exponent = text.find('e');
  if (!notation.latex || exponent == std::string::npos) return text;
  return fmt::format(
      "{} \\cdot 10^{{{}}}", text.substr(0, exponent), std::stoi(text.substr(exponent + 1)));
}

std::string LatexName(const std::string& name) {
  const auto letters_end = std::find_if_not(name.begin(), name.end(), IsLetter);
  const std::string letters(name.begin(), letters_end);
  std::string rest(letters_end, name.end());
  if (!rest.empty() && rest.front() == '_') rest.erase(0, 1);
  const bool is_greek = std::find(kGreek.begin(), kGreek.end(), letters) != kGreek.end();
  const bool plain_rest =
      std::all_of(rest.begin(), rest.end(), [](char c) { return IsLetter(c) || IsDigit(c); });
  if (!letters.empty() && plain_rest && (is_greek || letters.size() == 1)) {
    const std::string base = is_greek ? "\\" + letters : letters;
    return rest.empty() ? base : fmt::format("{}_{{{}}}", base, rest);
  }
  std::string escaped;
  for (const char c : name) {
    if (std::string_view("_#$%&{}").find(c) != std::string_view::npos) escaped += '\\';
    if (c == '\\' || c == '^' || c == '~') continue;  // have no short escape and no place in a name
    escaped += c;
  }
  return "\\mathrm{" + escaped + "}";
}

std::string VariableNames::operator[](int number) const {
  const auto at = static_cast<std::size_t>(number);
  if (at < given_.size() && !given_[at].empty()) return given_[at];
  const auto found = own_.find(number);
  return found != own_.end() ? found->second : fmt::format("x{}", number);
}

}  // namespace kompono::expression_internal
