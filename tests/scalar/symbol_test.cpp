// SPDX-License-Identifier: Apache-2.0
#include "kompono/scalar/symbol.hpp"

#include <cmath>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include <Eigen/Geometry>
#include <ceres/jet.h>

namespace kompono {
namespace {

template <class T>
concept Branchable = requires(T a, T b) {
  a < b ? 1 : 0;
};
template <class T>
concept TruthValue = requires(T a) {
  static_cast<bool>(a);
};
static_assert(Branchable<double>);
static_assert(TruthValue<double>);
static_assert(!Branchable<Symbol>, "a recorded formula has no value to branch on");
static_assert(!TruthValue<Symbol>);
static_assert(!TruthValue<SymbolCondition>);
static_assert(!std::is_convertible_v<Symbol, double>);
static_assert(!std::is_convertible_v<double, SymbolCondition>);
static_assert(std::is_convertible_v<bool, SymbolCondition>);
static_assert(!std::is_convertible_v<bool, Symbol>);
static_assert(std::is_trivially_copyable_v<Symbol>);

// Were Symbol's functions visible here, a plain number would become a Symbol.
static_assert(std::is_same_v<decltype(sqrt(2.0)), double>);

/// Walks a recording as its receiver would; conditions are 1 and 0.
double ValueOf(const Recording& recording, int32_t root, const std::vector<double>& variables) {
  std::vector<double> values;
  for (const KomponoExpressionNode& node : recording.nodes()) {
    const auto at = [&values, &node](int k) {
      return values.at(static_cast<std::size_t>(node.operand[k]));
    };
    switch (node.operation) {
      case KOMPONO_CONSTANT:
        values.push_back(node.value);
        break;
      case KOMPONO_VARIABLE:
        values.push_back(variables.at(static_cast<std::size_t>(node.operand[0])));
        break;
      case KOMPONO_ADD:
        values.push_back(at(0) + at(1));
        break;
      case KOMPONO_SUBTRACT:
        values.push_back(at(0) - at(1));
        break;
      case KOMPONO_MULTIPLY:
        values.push_back(at(0) * at(1));
        break;
      case KOMPONO_DIVIDE:
        values.push_back(at(0) / at(1));
        break;
      case KOMPONO_NEGATE:
        values.push_back(-at(0));
        break;
      case KOMPONO_SQRT:
        values.push_back(std::sqrt(at(0)));
        break;
      case KOMPONO_SIN:
        values.push_back(std::sin(at(0)));
        break;
      case KOMPONO_COS:
        values.push_back(std::cos(at(0)));
        break;
      case KOMPONO_TAN:
        values.push_back(std::tan(at(0)));
        break;
      case KOMPONO_ASIN:
        values.push_back(std::asin(at(0)));
        break;
      case KOMPONO_ACOS:
        values.push_back(std::acos(at(0)));
        break;
      case KOMPONO_ATAN:
        values.push_back(std::atan(at(0)));
        break;
      case KOMPONO_ATAN2:
        values.push_back(std::atan2(at(0), at(1)));
        break;
      case KOMPONO_ABS:
        values.push_back(std::abs(at(0)));
        break;
      case KOMPONO_EXP:
        values.push_back(std::exp(at(0)));
        break;
      case KOMPONO_LOG:
        values.push_back(std::log(at(0)));
        break;
      case KOMPONO_LESS:
        values.push_back(at(0) < at(1) ? 1 : 0);
        break;
      case KOMPONO_LESS_EQUAL:
        values.push_back(at(0) <= at(1) ? 1 : 0);
        break;
      case KOMPONO_NOT:
        values.push_back(at(0) == 0 ? 1 : 0);
        break;
      case KOMPONO_AND:
        values.push_back(at(0) != 0 && at(1) != 0 ? 1 : 0);
        break;
      case KOMPONO_OR:
        values.push_back(at(0) != 0 || at(1) != 0 ? 1 : 0);
        break;
      case KOMPONO_SELECT:
        values.push_back(at(0) != 0 ? at(1) : at(2));
        break;
      default:
        ADD_FAILURE() << "unknown operation " << node.operation;
        return 0;
    }
  }
  return values.at(static_cast<std::size_t>(root));
}

/// Uses every function of the scalar once; the same code for double, Jet and Symbol.
template <class T>
T Everything(const T& x, const T& y) {
  using std::abs;
  using std::acos;
  using std::asin;
  using std::atan;
  using std::atan2;
  using std::cos;
  using std::exp;
  using std::hypot;
  using std::log;
  using std::sin;
  using std::sqrt;
  using std::tan;
  T sum = sqrt(x + T(3)) + sin(x) * cos(y) - tan(x / T(4)) + asin(x / T(5)) * acos(y / T(5));
  sum += atan(x * y) + atan2(y, x) + abs(y - x) + exp(-x) / log(y + T(3));
  sum -= hypot(x, y);
  sum *= T(2);
  sum /= T(3) + x * x;
  return -sum;
}

TEST(Symbol, RecordsTheSameFormulaThatDoubleComputes) {
  Recording recording;
  const Symbol value = Everything(Recording::Variable(0), Recording::Variable(1));
  const int32_t root = recording.Index(value);
  for (const auto& [x, y] : {std::pair(0.3, 1.7), std::pair(1.9, -0.4), std::pair(-1.1, 2.5)}) {
    EXPECT_EQ(ValueOf(recording, root, {x, y}), Everything(x, y)) << x << ", " << y;
  }
}

TEST(Symbol, PutsOperandsBeforeTheirUsers) {
  Recording recording;
  (void)Everything(Recording::Variable(0), Recording::Variable(1));
  for (std::size_t i = 0; i < recording.nodes().size(); ++i) {
    const KomponoExpressionNode& node = recording.nodes()[i];
    if (node.operation <= KOMPONO_VARIABLE) continue;
    for (const int32_t operand : node.operand) EXPECT_LT(operand, static_cast<int32_t>(i));
    EXPECT_GE(node.operand[0], 0);
  }
}

TEST(Symbol, CalculatesNumbersAtOnceAndWithoutARecording) {
  const Symbol a = 3;
  const Symbol b = 4.0;
  const Symbol c = sqrt(a * a + b * b) - 2 * atan2(0.0 * a, b) + pow(a, 2) + copysign(a, -b);
  ASSERT_TRUE(c.IsConstant());
  EXPECT_DOUBLE_EQ(c.ConstantValue(), 5 + 9 - 3);
  EXPECT_TRUE((a < b).IsConstant());
  EXPECT_DOUBLE_EQ(Select(!(a < b) || b <= a, a, b).ConstantValue(), 4.0);
}

TEST(Symbol, DropsWhatZerosAndOnesDoNotChange) {
  Recording recording;
  const Symbol x = Recording::Variable(0);
  const std::size_t before = recording.nodes().size();
  const int32_t place = recording.Index(x);
  EXPECT_EQ(recording.Index(x + 0), place);
  EXPECT_EQ(recording.Index(0 + x), place);
  EXPECT_EQ(recording.Index(x - 0), place);
  EXPECT_EQ(recording.Index(1 * x), place);
  EXPECT_EQ(recording.Index(x * 1), place);
  EXPECT_EQ(recording.Index(x / 1), place);
  EXPECT_EQ(recording.Index(Select(true, x, Symbol(7))), place);
  EXPECT_TRUE((x * 0).IsConstant());
  EXPECT_EQ(recording.nodes().size(), before);
  EXPECT_EQ(recording.Index(-(-x)), place);
  EXPECT_FALSE((0 / x).IsConstant()) << "has a pole";
  EXPECT_FALSE((x / x).IsConstant()) << "has a pole";
}

TEST(Symbol, SharesEqualOperations) {
  Recording recording;
  const Symbol x = Recording::Variable(0);
  const Symbol y = Recording::Variable(1);
  EXPECT_EQ(recording.Index(sin(x) * y), recording.Index(sin(x) * y));
  EXPECT_NE(recording.Index(x - y), recording.Index(y - x));
  EXPECT_EQ(recording.Index(Symbol(0.5)), recording.Index(Symbol(0.5)));
}

TEST(Symbol, PowersBecomeProducts) {
  Recording recording;
  const Symbol x = Recording::Variable(0);
  const int32_t fifth = recording.Index(pow(x, 5));
  const int32_t reciprocal = recording.Index(pow(x, -2));
  const int32_t root = recording.Index(pow(x, 0.5));
  for (const double value : {-1.5, 0.7, 3.0}) {
    EXPECT_DOUBLE_EQ(ValueOf(recording, fifth, {value}), std::pow(value, 5));
    EXPECT_DOUBLE_EQ(ValueOf(recording, reciprocal, {value}), std::pow(value, -2));
  }
  for (const KomponoExpressionNode& node : recording.nodes()) {
    EXPECT_NE(node.operation, KOMPONO_EXP);
    EXPECT_NE(node.operation, KOMPONO_LOG);
  }
  EXPECT_DOUBLE_EQ(ValueOf(recording, root, {9.0}), 3.0);
  EXPECT_DOUBLE_EQ(pow(x, 0).ConstantValue(), 1.0);
  const int32_t general = recording.Index(pow(x, 1.3));
  EXPECT_NEAR(ValueOf(recording, general, {2.5}), std::pow(2.5, 1.3), 1e-14);
}

TEST(Symbol, SelectRecordsBothWays) {
  Recording recording;
  const Symbol x = Recording::Variable(0);
  const Symbol y = Recording::Variable(1);
  const int32_t root = recording.Index(Select((x < y && x > -1.0) || !(y >= 0.0), x * 10, y * 100));
  const auto expected = [](double a, double b) {
    return (a < b && a > -1.0) || !(b >= 0.0) ? a * 10 : b * 100;
  };
  for (const double a : {-2.0, -1.0, 0.5, 3.0}) {
    for (const double b : {-1.0, 0.0, 0.5, 2.0}) {
      EXPECT_EQ(ValueOf(recording, root, {a, b}), expected(a, b)) << a << ", " << b;
    }
  }
}

TEST(Symbol, KnownConditionsNeedNoNodeUntilAskedForOne) {
  Recording recording;
  const Symbol x = Recording::Variable(0);
  const SymbolCondition unknown = x < 1.0;
  EXPECT_FALSE((unknown && true).IsConstant());
  EXPECT_TRUE((unknown && false).IsConstant());
  EXPECT_TRUE((true || unknown).IsConstant());
  EXPECT_EQ(ValueOf(recording, recording.Index(SymbolCondition(true)), {0.0}), 1.0);
  EXPECT_EQ(ValueOf(recording, recording.Index(SymbolCondition(false)), {0.0}), 0.0);
}

TEST(Symbol, IsAnEigenScalar) {
  using Vector = Eigen::Matrix<Symbol, 3, 1>;
  using Matrix = Eigen::Matrix<Symbol, 3, 3>;
  Recording recording;
  std::vector<Symbol> v;
  for (int k = 0; k < 9; ++k) v.push_back(Recording::Variable(k));
  const Vector a(v[0], v[1], v[2]);
  const Vector b(v[3], v[4], 2.5);
  Matrix m;
  m << v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8];
  const Vector product = m * a + Eigen::Matrix3d::Identity() * b - 2.0 * a.cross(b);
  const Matrix squared = m * m.transpose();
  const int32_t root = recording.Index(product.norm() + a.dot(b) + product.squaredNorm() +
                                       squared(0, 2) + m.inverse()(1, 2) + m.determinant());

  const std::vector<double> x{0.3, -1.2, 2.2, 0.7, 1.9, -0.6, 1.1, 0.4, 3.0};
  const Eigen::Vector3d xa(x[0], x[1], x[2]);
  const Eigen::Vector3d xb(x[3], x[4], 2.5);
  Eigen::Matrix3d xm;
  xm << x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], x[8];
  const Eigen::Vector3d xp = xm * xa + xb - 2.0 * xa.cross(xb);
  const Eigen::Matrix3d xs = xm * xm.transpose();
  EXPECT_NEAR(
      ValueOf(recording, root, x),
      xp.norm() + xa.dot(xb) + xp.squaredNorm() + xs(0, 2) + xm.inverse()(1, 2) + xm.determinant(),
      1e-12);
}

TEST(Symbol, UnderJetsRecordsDerivatives) {
  using SymbolJet = ceres::Jet<Symbol, 2>;
  using NumberJet = ceres::Jet<double, 2>;
  Recording recording;
  const SymbolJet recorded =
      Everything(SymbolJet(Recording::Variable(0), 0), SymbolJet(Recording::Variable(1), 1)) +
      pow(SymbolJet(Recording::Variable(0), 0), 3.0);
  const std::vector<int32_t> roots{
      recording.Index(recorded.a), recording.Index(recorded.v[0]), recording.Index(recorded.v[1])};
  for (const auto& [x, y] : {std::pair(0.3, 1.7), std::pair(1.9, -0.4), std::pair(-1.1, 2.5)}) {
    const NumberJet expected =
        Everything(NumberJet(x, 0), NumberJet(y, 1)) + pow(NumberJet(x, 0), 3.0);
    EXPECT_NEAR(ValueOf(recording, roots[0], {x, y}), expected.a, 1e-12);
    EXPECT_NEAR(ValueOf(recording, roots[1], {x, y}), expected.v[0], 1e-12);
    EXPECT_NEAR(ValueOf(recording, roots[2], {x, y}), expected.v[1], 1e-12);
  }
}

TEST(Symbol, JetsOfSymbolsAreEigenScalars) {
  using Jet = ceres::Jet<Symbol, 3>;
  Recording recording;
  Eigen::Matrix<Jet, 3, 1> a;
  for (int k = 0; k < 3; ++k) a[k] = Jet(Recording::Variable(k), k);
  const Eigen::Matrix<Jet, 3, 3> twice =
      Eigen::Matrix<Jet, 3, 3>::Identity() + Eigen::Matrix<Jet, 3, 3>::Identity();
  const Eigen::Matrix<Jet, 3, 1> b = twice * a;
  const Jet length = b.norm();
  const int32_t root = recording.Index(length.v[1]);
  EXPECT_NEAR(ValueOf(recording, root, {1.0, 2.0, 2.0}), 2.0 * 2.0 / 3.0, 1e-15);
}

TEST(Recording, RefusesSymbolsFromElsewhere) {
  Symbol leftover;
  {
    Recording first;
    leftover = Recording::Variable(0);
    Recording second;
    EXPECT_THROW((void)second.Index(leftover), std::logic_error);
    EXPECT_THROW((void)sin(leftover), std::logic_error) << "the second recording is active";
    EXPECT_EQ(first.Index(leftover), 0);
  }
  EXPECT_THROW((void)-leftover, std::logic_error);
  EXPECT_THROW((void)Recording::Variable(0), std::logic_error);
  Recording third;
  EXPECT_THROW((void)(leftover + 1), std::logic_error);
  EXPECT_THROW((void)Recording::Variable(-1), std::logic_error);
}

TEST(Recording, NestsAndMayEndInAnyOrder) {
  auto outer = std::make_unique<Recording>();
  const Symbol x = Recording::Variable(0);
  {
    Recording inner;
    (void)Recording::Variable(5);
    EXPECT_EQ(inner.nodes().size(), 1U);
  }
  EXPECT_EQ(outer->Index(x + Recording::Variable(1)), 2);
  auto last = std::make_unique<Recording>();
  outer.reset();
  (void)Recording::Variable(3);
  EXPECT_EQ(last->nodes().size(), 1U);
  last.reset();
  EXPECT_THROW((void)Recording::Variable(0), std::logic_error);
}

TEST(Recording, EachThreadHasItsOwn) {
  Recording recording;
  bool refused = false;
  std::thread([&refused] {
    try {
      (void)Recording::Variable(0);
    } catch (const std::logic_error&) {
      refused = true;
    }
  }).join();
  EXPECT_TRUE(refused);
}

}  // namespace
}  // namespace kompono
