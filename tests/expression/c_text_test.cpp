// SPDX-License-Identifier: Apache-2.0
// The C text is given to the C compiler, loaded, and compared with Evaluate.
#include "random_formula.hpp"
#include <dlfcn.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <gtest/gtest-spi.h>

#include "kompono/expression/printing.hpp"

namespace kompono {
namespace {

using testing_support::ComputeBounded;
using testing_support::kVariableCount;
using testing_support::MakeFormula;
using testing_support::MakePoint;
using testing_support::RandomFormula;

using Function = void (*)(const double*, double*);

std::string FileText(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// A shared library made of C text, in a folder of its own that goes with it.
class CompiledC {
 public:
  explicit CompiledC(const std::string& text) {
    std::string pattern = testing::TempDir() + "kompono_c_XXXXXX";
    const char* const made = mkdtemp(pattern.data());
    if (made == nullptr) throw std::runtime_error("cannot make " + pattern);
    folder_ = made;
    std::ofstream(folder_ / "formula.c") << text;
    const std::string command = fmt::format(
        "'{0}' -std=c99 -pedantic -Wall -Wextra -Wshadow -Werror -O1 -ffp-contract=off -fPIC "
        "-shared "
        "-o '{1}/formula.so' '{1}/formula.c' -lm 2> '{1}/messages'",
        KOMPONO_C_COMPILER,
        folder_.string());
    if (std::system(command.c_str()) != 0) {
      ADD_FAILURE() << "the C compiler says\n" << FileText(folder_ / "messages");
      return;
    }
    library_ = dlopen((folder_ / "formula.so").c_str(), RTLD_NOW | RTLD_LOCAL);
  }
  ~CompiledC() {
    if (library_ != nullptr) dlclose(library_);
    std::filesystem::remove_all(folder_);
  }
  CompiledC(const CompiledC&) = delete;
  CompiledC& operator=(const CompiledC&) = delete;
  CompiledC(CompiledC&&) = delete;
  CompiledC& operator=(CompiledC&&) = delete;

  [[nodiscard]] Function Find(const std::string& name) const {
    if (library_ == nullptr) return nullptr;
    return reinterpret_cast<Function>(dlsym(library_, name.c_str()));
  }

 private:
  std::filesystem::path folder_;
  void* library_ = nullptr;
};

/// Equal but for what a compiler may do better than the library: a constant sin(2) in the last
/// digit.
bool SameNumber(double a, double b) {
  if (!std::isfinite(a) || !std::isfinite(b)) return std::isfinite(a) == std::isfinite(b);
  return std::abs(a - b) <= 1e-12 * std::abs(b);
}

TEST(CText, ComputesWhatEvaluateComputes) {
  constexpr uint64_t kSeed = 31;
  constexpr int kFunctions = 60;
  std::mt19937_64 random(kSeed);
  std::string text;
  std::vector<std::vector<Expression>> formulas;
  std::vector<std::vector<RandomFormula>> recorded;
  for (int k = 0; k < kFunctions; ++k) {
    std::vector<RandomFormula> pair{MakeFormula(random, {.operations = 5 + k}),
                                    MakeFormula(random, {.operations = 5 + k})};
    std::vector<Expression> roots{pair[0].Import(), pair[1].Import()};
    if (k % 2 == 0) roots = Simplify(roots).expressions;
    const std::vector<NamedExpression> named{{"first", roots[0]}, {"second", roots[1]}};
    const COptions options{.function_name = fmt::format("f{}", k),
                           .names = {"x", "y", "t1"},
                           .include = k == 0 ? "<math.h>" : ""};
    text += fmt::format("void f{}(const double in[], double out[]);\n", k);
    text += ToC(named, options).value();
    formulas.push_back(std::move(roots));
    recorded.push_back(std::move(pair));
  }
  text.insert(0, "#include <math.h>\n");
  const CompiledC compiled(text);
  int compared = 0;
  for (int k = 0; k < kFunctions; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const Function function = compiled.Find(fmt::format("f{}", k));
    ASSERT_NE(function, nullptr) << "function " << k;
    for (int p = 0; p < 20; ++p) {
      const std::vector<double> point = MakePoint(random);
      std::vector<double> results(2);
      function(point.data(), results.data());
      const std::vector<double> expected = Evaluate(formulas[at], point);
      for (std::size_t i = 0; i < 2; ++i) {
        if (!ComputeBounded(recorded[at][i], point).decided) continue;
        ++compared;
        EXPECT_PRED2(SameNumber, results[i], expected[i])
            << "seed " << kSeed << ", function " << k << ", result " << i;
      }
    }
  }
  EXPECT_GT(compared, kFunctions * 20);
}

TEST(CText, NumbersComeBackExactly) {
  const std::vector<double> numbers{0.1,
                                    -1.0 / 3.0,
                                    1e300,
                                    4.9e-324,
                                    25641.3446,
                                    1e16,
                                    -0.0,
                                    123456789,
                                    2.5e-7,
                                    9007199254740993.0,
                                    1.0e22,
                                    INFINITY,
                                    -INFINITY,
                                    NAN};
  std::vector<NamedExpression> roots;
  roots.reserve(numbers.size());
  for (const double number : numbers) roots.push_back({"", Expression(number)});
  const CompiledC compiled(*ToC(roots, {.function_name = "numbers"}));
  const Function function = compiled.Find("numbers");
  ASSERT_NE(function, nullptr);
  std::vector<double> results(numbers.size());
  const double nothing = 0.0;
  function(&nothing, results.data());
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (std::isnan(numbers[k])) {
      EXPECT_TRUE(std::isnan(results[k]));
    } else {
      EXPECT_EQ(results[k], numbers[k]);
      EXPECT_EQ(std::signbit(results[k]), std::signbit(numbers[k]));
    }
  }
}

TEST(CText, ADeepFormulaStaysWithinTheCompilersLimits) {
  Expression e = Expression::Variable(0);
  for (int k = 0; k < 3000; ++k) e = sin(e) + 0.5;
  const std::vector<NamedExpression> roots{{"deep", e}};
  const CompiledC compiled(*ToC(roots, {.function_name = "deep"}));
  const Function function = compiled.Find("deep");
  ASSERT_NE(function, nullptr);
  const double x = 0.3;
  double result = 0.0;
  function(&x, &result);
  EXPECT_PRED2(SameNumber, result, e.Evaluate({&x, 1}));
}

TEST(CText, TheCompilerIsAskedAndCanRefuse) {
  EXPECT_NONFATAL_FAILURE((void)CompiledC("int f(void) { return; }\n"), "the C compiler says");
}

}  // namespace
}  // namespace kompono
