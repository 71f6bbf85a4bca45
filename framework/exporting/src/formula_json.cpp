// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <numeric>

#include "kompono/exporting/formulas.hpp"
#include "kompono/expression/polynomial.hpp"
#include "kompono/expression/printing.hpp"
#include "kompono/expression/root_form.hpp"

namespace kompono::exporting {
namespace {

/// "x^2*y" -> coefficient; the constant term under "1".
nlohmann::json Coefficients(const Polynomial& polynomial, const std::vector<std::string>& names) {
  nlohmann::json json = nlohmann::json::object();
  for (const Monomial& term : polynomial.terms) {
    std::string key;
    for (std::size_t i = 0; i < term.exponents.size(); ++i) {
      if (term.exponents[i] == 0) continue;
      if (!key.empty()) key += "*";
      key += names[static_cast<std::size_t>(polynomial.variables[i])];
      if (term.exponents[i] > 1) key += fmt::format("^{}", term.exponents[i]);
    }
    const std::optional<double> value = term.coefficient.ConstantValue();
    json[key.empty() ? "1" : key] =
        value ? nlohmann::json(*value) : nlohmann::json(ToText(term.coefficient));
  }
  return json;
}

}  // namespace

nlohmann::json FormulaJson(const MachineFormulas& formulas, const FormulaOptions& options) {
  std::vector<int> variables(formulas.variables.size());
  std::iota(variables.begin(), variables.end(), 0);
  nlohmann::json drives = nlohmann::json::array();
  for (const DriveFormula& drive : formulas.drives) {
    nlohmann::json entry{
        {"drive", drive.drive},
        {"text",
         ToText(drive.expression, {.names = formulas.variables, .digits = options.digits})}};
    if (const auto polynomial = ExpandPolynomial(drive.expression, variables)) {
      entry["polynomial"] = Coefficients(*polynomial, formulas.variables);
    } else if (const auto form = ExpandRootForm(drive.expression, variables)) {
      entry["polynomial"] = Coefficients(form->outside, formulas.variables);
      entry["root_sign"] = form->sign;
      entry["under_root"] = Coefficients(form->under, formulas.variables);
    }
    drives.push_back(std::move(entry));
  }
  return {
      {"variables", formulas.variables}, {"coordinates", formulas.coordinates}, {"drives", drives}};
}

}  // namespace kompono::exporting
