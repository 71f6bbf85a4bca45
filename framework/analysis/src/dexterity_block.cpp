// SPDX-License-Identifier: Apache-2.0
// Many poses: J by central differences of the plugin's batches, its extreme singular values from
// JᵀJ, or by one-sided Jacobi rotations (Hestenes) where squares would lose digits; two poses to a
// register.
#include "extreme_values.hpp"
#include "lanes.hpp"
#include "mechanism_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/LU>

#include "kompono/analysis/dexterity.hpp"

namespace kompono::analysis {
namespace {

using lanes::Mask;
using lanes::Number;

constexpr std::size_t kChunk = 256;  ///< poses whose Jacobians fit the processor's nearer memory
constexpr std::size_t kMost = 6;     ///< coordinates
constexpr std::size_t kMostDrives = 8;
constexpr double kStep = 6e-6;  ///< cube root of the rounding, about: both errors near 1e-10
constexpr int kSweeps = 8;

Number Magnitude(Number a) {
  return lanes::Select(a < lanes::Broadcast(0.0), -a, a);
}

/// Columns of J (and of the twists that they belong to) of two poses.
template <std::size_t N>
struct Table {
  std::array<std::array<Number, kMostDrives>, N> j;
  std::array<std::array<Number, kMost>, N> twist;
};

/// Gram-Schmidt on the twists; J follows, so that its columns belong to unit twists.
template <std::size_t N>
void MakeTwistsUnit(Table<N>& table, std::size_t drives) {
  for (std::size_t k = 0; k < N; ++k) {
    auto& own = table.twist[k];
    for (std::size_t before = 0; before < k; ++before) {
      const auto& other = table.twist[before];
      Number along = lanes::Broadcast(0.0);
      for (std::size_t i = 0; i < kMost; ++i) along += own[i] * other[i];
      for (std::size_t i = 0; i < kMost; ++i) own[i] -= along * other[i];
      for (std::size_t i = 0; i < drives; ++i) table.j[k][i] -= along * table.j[before][i];
    }
    Number square = lanes::Broadcast(0.0);
    for (std::size_t i = 0; i < kMost; ++i) square += own[i] * own[i];
    const Number factor = lanes::Broadcast(1.0) / lanes::Sqrt(square);
    for (std::size_t i = 0; i < kMost; ++i) own[i] *= factor;
    for (std::size_t i = 0; i < drives; ++i) table.j[k][i] *= factor;
  }
}

/// Turns columns p and q until they are perpendicular; how far they were from it: the larger cosine
/// squared of both poses.
template <std::size_t N>
Number Rotate(Table<N>& table, std::size_t p, std::size_t q, std::size_t drives) {
  auto& a = table.j[p];
  auto& b = table.j[q];
  Number aa = lanes::Broadcast(0.0);
  Number bb = lanes::Broadcast(0.0);
  Number ab = lanes::Broadcast(0.0);
  for (std::size_t i = 0; i < drives; ++i) {
    aa += a[i] * a[i];
    bb += b[i] * b[i];
    ab += a[i] * b[i];
  }
  const Number one = lanes::Broadcast(1.0);
  const Number limit = lanes::Broadcast(1e-30) * aa * bb;
  const Mask turned = ab * ab > limit;
  const Number zeta = (bb - aa) / (lanes::Broadcast(2.0) * ab);
  const Number size = Magnitude(zeta) + lanes::Sqrt(one + zeta * zeta);
  const Number tangent = lanes::Select(zeta < lanes::Broadcast(0.0), -one / size, one / size);
  const Number t = lanes::Select(turned, tangent, lanes::Broadcast(0.0));
  const Number c = one / lanes::Sqrt(one + t * t);
  const Number s = c * t;
  for (std::size_t i = 0; i < drives; ++i) {
    const Number ai = a[i];
    a[i] = c * ai - s * b[i];
    b[i] = s * ai + c * b[i];
  }
  return lanes::Select(turned, ab * ab / (aa * bb), lanes::Broadcast(0.0));
}

/// From JᵀJ. Its rounding is about 1e-16 of the largest eigenvalue: false where more than 1e-8 of
/// the smallest is lost so, that is for conditions above 10⁴.
template <std::size_t N>
bool SingularSquaresOfProduct(const Table<N>& table,
                              std::size_t drives,
                              Number& least,
                              Number& most) {
  lanes::Symmetric<N> product;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
  for (std::size_t p = 0; p < N; ++p) {
    for (std::size_t q = 0; q <= p; ++q) {
      Number sum = table.j[p][0] * table.j[q][0];
      for (std::size_t i = 1; i < drives; ++i) sum += table.j[p][i] * table.j[q][i];
      product[p][q] = sum;
    }
  }
  if (!lanes::ExtremeValues<N>(product, least, most)) return false;
  return least[0] > 1e-8 * most[0] && least[1] > 1e-8 * most[1];
}

template <std::size_t N>
void SingularSquares(Table<N>& table, std::size_t drives, Number& least, Number& most) {
  if (SingularSquaresOfProduct(table, drives, least, most)) return;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    Number worst = lanes::Broadcast(0.0);
    for (std::size_t p = 0; p + 1 < N; ++p) {
      for (std::size_t q = p + 1; q < N; ++q) {
        const Number cosine2 = Rotate(table, p, q, drives);
        worst = lanes::Select(cosine2 > worst, cosine2, worst);
      }
    }
    // The next sweep would square what is left: below 1e-8 that is rounding.
    if (!(worst[0] > 1e-8) && !(worst[1] > 1e-8)) break;
  }
  for (std::size_t k = 0; k < N; ++k) {
    Number square = lanes::Broadcast(0.0);
    for (std::size_t i = 0; i < drives; ++i) square += table.j[k][i] * table.j[k][i];
    least = k == 0 ? square : lanes::Select(square < least, square, least);
    most = k == 0 ? square : lanes::Select(square > most, square, most);
  }
}

/// Sign of the determinant of J by Gauss's elimination. Without exchange of rows where no pivot is
/// small beside its row, which two poses can share; else one after the other.
template <std::size_t N>
Number SignOfDeterminant(const Table<N>& table) {
  std::array<std::array<Number, N>, N> a;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  for (std::size_t row = 0; row < N; ++row) {
    for (std::size_t k = 0; k < N; ++k) a[row][k] = table.j[k][row];
  }
  Number product = lanes::Broadcast(1.0);
  Number weakest = lanes::Broadcast(1.0);
  for (std::size_t p = 0; p < N; ++p) {
    const Number pivot = a[p][p];
    Number square = pivot * pivot;
    for (std::size_t k = p + 1; k < N; ++k) square += a[p][k] * a[p][k];
    const Number share = pivot * pivot / square;
    weakest = lanes::Select(share < weakest, share, weakest);
    product = lanes::Select(pivot < lanes::Broadcast(0.0), -product, product);
    for (std::size_t row = p + 1; row < N; ++row) {
      const Number factor = a[row][p] / pivot;
      for (std::size_t k = p + 1; k < N; ++k) a[row][k] -= factor * a[p][k];
    }
  }
  for (std::size_t lane = 0; lane < lanes::kCount; ++lane) {
    if (weakest[lane] > 1e-8) continue;
    Eigen::Matrix<double, static_cast<int>(N), static_cast<int>(N)> own;
    for (std::size_t row = 0; row < N; ++row) {
      for (std::size_t k = 0; k < N; ++k)
        own(static_cast<int>(row), static_cast<int>(k)) = table.j[k][row][lane];
    }
    product[lane] = own.partialPivLu().determinant();
  }
  return product;
}

/// Whether the platform is the product of its letters' motions with translations first: then the
/// twists follow from the angles alone.
bool IsLetterProduct(const PoseJudge::Mechanism& mechanism, const VectorXd& home) {
  const std::string& letters = mechanism.description->letters;
  bool turned = false;
  for (const char letter : letters) {
    turned = turned || IsRotaryLetter(letter);
    if (turned && !IsRotaryLetter(letter)) return false;
  }
  for (int trial = 0; trial < 4; ++trial) {
    VectorXd x = home;
    Pose<double> X;
    for (std::size_t i = 0; i < letters.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      x[k] += (IsRotaryLetter(letters[i]) ? 0.3 : 20.0) * std::sin(1.0 + trial * 2.0 + 1.7 * k);
      X = X * LetterMotion(letters[i], x[k]);
    }
    const VectorXd numbers =
        ValuesAt(mechanism, plugin::Quantity::kPlatform, x, VectorXd(), false).value;
    const Pose<double> said = Pose<double>::Read({numbers.data(), 12});
    const double size = 1.0 + x.cwiseAbs().maxCoeff();
    if (!((said.R - X.R).norm() < 1e-10) || !((said.p - X.p).norm() < 1e-10 * size)) return false;
  }
  return true;
}

}  // namespace

struct DexterityBlock::Impl {
  const PoseJudge::Mechanism* mechanism = nullptr;
  double length = 1.0;
  bool letter_product = false;
  std::size_t n = 0, drives = 0;
  std::vector<double> step;         ///< per coordinate
  std::vector<double> drive_scale;  ///< per drive
  std::vector<double> local;        ///< n columns of kChunk
  std::vector<double> moved;        ///< one column
  std::vector<double> up, down;     ///< answers, as many columns as the larger quantity has
  std::vector<double> j;            ///< [coordinate][drive] columns
  std::vector<double> twist;        ///< [coordinate][6] columns
  std::vector<double> platform;     ///< 12 columns
  std::vector<const double*> in;
  std::vector<double*> up_out, down_out, platform_out;
  std::vector<double> least, most;  ///< per pose of the block
  double home_sign = 0.0;           ///< of det J; 0: sides are not looked at
  std::vector<double> side;         ///< det J, or only its sign, per pose

  void Ask(plugin::Quantity quantity, std::size_t count, const std::vector<double*>& out) {
    const plugin::Status status =
        mechanism->code->EvaluateBatch(quantity,
                                       {.count = count,
                                        .coordinates = in.data(),
                                        .drives = nullptr,
                                        .parameters = mechanism->parameters,
                                        .modes = mechanism->modes,
                                        .values = out.data()});
    if (status != plugin::Status::kOk) {
      throw std::logic_error("the module of " + mechanism->block +
                             " cannot evaluate a batch of poses");
    }
  }

  /// Differences by coordinate `k` into up_out: (f(x + h) - f(x - h)) / 2h.
  void Differentiate(plugin::Quantity quantity,
                     std::size_t k,
                     std::size_t count,
                     std::size_t rows) {
    const double* own = local.data() + k * kChunk;
    in[k] = moved.data();
    for (std::size_t i = 0; i < count; ++i) moved[i] = own[i] + step[k];
    Ask(quantity, count, up_out);
    for (std::size_t i = 0; i < count; ++i) moved[i] = own[i] - step[k];
    Ask(quantity, count, down_out);
    in[k] = own;
    const double factor = 0.5 / step[k];
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t i = 0; i < count; i += lanes::kCount) {
        const Number difference = lanes::Load(up_out[row] + i) - lanes::Load(down_out[row] + i);
        lanes::Store(up_out[row] + i, difference * lanes::Broadcast(factor));
      }
    }
  }

  void TwistsFromLetters(std::size_t count) {
    const std::string& letters = mechanism->description->letters;
    for (std::size_t i = 0; i < count; ++i) {
      Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
      for (std::size_t k = 0; k < n; ++k) {
        const int axis = AxisOfLetter(letters[k]);
        if (!IsRotaryLetter(letters[k])) continue;
        for (std::size_t r = 0; r < 3; ++r)
          twist[(k * kMost + 3 + r) * kChunk + i] = length * R(static_cast<int>(r), axis);
        if (k + 1 < n) R = R * LetterMotion(letters[k], local[k * kChunk + i]).R;
      }
    }
  }

  void TwistsFromPlatform(std::size_t count) {
    Ask(plugin::Quantity::kPlatform, count, platform_out);
    for (std::size_t k = 0; k < n; ++k) {
      Differentiate(plugin::Quantity::kPlatform, k, count, 12);
      for (std::size_t i = 0; i < count; ++i) {
        Eigen::Matrix3d R;
        Eigen::Matrix3d dR;
        for (std::size_t r = 0; r < 3; ++r) {
          for (std::size_t c = 0; c < 3; ++c) {
            R(static_cast<int>(r), static_cast<int>(c)) = platform_out[4 * r + c][i];
            dR(static_cast<int>(r), static_cast<int>(c)) = up_out[4 * r + c][i];
          }
          twist[(k * kMost + r) * kChunk + i] = up_out[4 * r + 3][i];
        }
        const Eigen::Matrix3d W = dR * R.transpose();
        const std::array<double, 3> omega{W(2, 1) - W(1, 2), W(0, 2) - W(2, 0), W(1, 0) - W(0, 1)};
        for (std::size_t r = 0; r < 3; ++r)
          twist[(k * kMost + 3 + r) * kChunk + i] = 0.5 * length * omega[r];
      }
    }
  }

  template <std::size_t N>
  void Decompose(std::size_t first, std::size_t count) {
    Table<N> table;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
    for (std::size_t i = 0; i < count; i += lanes::kCount) {
      for (std::size_t k = 0; k < N; ++k) {
        for (std::size_t row = 0; row < drives; ++row)
          table.j[k][row] = lanes::Load(j.data() + (k * drives + row) * kChunk + i);
        for (std::size_t row = 0; row < kMost; ++row)
          table.twist[k][row] = lanes::Load(twist.data() + (k * kMost + row) * kChunk + i);
      }
      if (home_sign != 0.0) lanes::Store(side.data() + first + i, SignOfDeterminant<N>(table));
      MakeTwistsUnit(table, drives);
      Number low{};
      Number high{};
      SingularSquares(table, drives, low, high);
      lanes::Store(least.data() + first + i, low);
      lanes::Store(most.data() + first + i, high);
    }
  }

  void Chunk(std::size_t first, std::size_t count) {
    for (std::size_t k = 0; k < n; ++k) {
      Differentiate(plugin::Quantity::kDrives, k, count, drives);
      for (std::size_t row = 0; row < drives; ++row) {
        double* to = j.data() + (k * drives + row) * kChunk;
        for (std::size_t i = 0; i < count; ++i) to[i] = up_out[row][i] * drive_scale[row];
      }
    }
    if (letter_product) {
      TwistsFromLetters(count);
    } else {
      TwistsFromPlatform(count);
    }
    using Self = void (Impl::*)(std::size_t, std::size_t);
    static constexpr std::array<Self, kMost> kBySize{&Impl::Decompose<1>,
                                                     &Impl::Decompose<2>,
                                                     &Impl::Decompose<3>,
                                                     &Impl::Decompose<4>,
                                                     &Impl::Decompose<5>,
                                                     &Impl::Decompose<6>};
    (this->*kBySize[n - 1])(first, count);
  }
};

DexterityBlock::DexterityBlock(const PoseJudge& judge,
                               std::size_t mechanism,
                               double length_mm,
                               bool with_sides)
    : impl_(std::make_unique<Impl>()) {
  Impl& own = *impl_;
  own.mechanism = &judge.mechanisms()[mechanism];
  own.length = length_mm;
  own.n = own.mechanism->coordinate.size();
  own.drives = static_cast<std::size_t>(own.mechanism->shape.drives);
  if (own.n == 0 || own.n > kMost || own.drives > kMostDrives)
    throw std::logic_error("DexterityBlock: expects 1 to 6 coordinates and at most 8 drives");
  const VectorXd home = LocalAt(*own.mechanism, judge.machine().home());
  own.letter_product = IsLetterProduct(*own.mechanism, home);
  if (with_sides && own.n == own.drives) {
    own.home_sign = ValuesAt(*own.mechanism, plugin::Quantity::kDrives, home, VectorXd(), true)
                        .by_coordinates.determinant();
    if (!std::isfinite(own.home_sign)) own.home_sign = 0.0;
  }
  double size = 1.0;
  for (const Eigen::Vector3d& point : PointsAt(*own.mechanism, judge.machine().home()).point)
    size = std::max(size, point.norm());
  for (const char letter : own.mechanism->description->letters)
    own.step.push_back(IsRotaryLetter(letter) ? kStep : kStep * size);
  for (const plugin::DriveDescription& drive : own.mechanism->description->drives)
    own.drive_scale.push_back(drive.rotary ? length_mm : 1.0);
  own.local.assign(own.n * kChunk, 0.0);
  own.moved.assign(kChunk, 0.0);
  const std::size_t rows = std::max<std::size_t>(12, own.drives);
  own.up.assign(rows * kChunk, 0.0);
  own.down.assign(rows * kChunk, 0.0);
  own.platform.assign(12 * kChunk, 0.0);
  for (std::size_t i = 0; i < rows; ++i) {
    own.up_out.push_back(own.up.data() + i * kChunk);
    own.down_out.push_back(own.down.data() + i * kChunk);
  }
  for (std::size_t i = 0; i < 12; ++i) own.platform_out.push_back(own.platform.data() + i * kChunk);
  own.j.assign(own.n * own.drives * kChunk, 0.0);
  own.twist.assign(own.n * kMost * kChunk, 0.0);
  for (std::size_t k = 0; k < own.n; ++k) {
    own.in.push_back(own.local.data() + k * kChunk);
    const char letter = own.mechanism->description->letters[k];
    if (!own.letter_product || IsRotaryLetter(letter)) continue;
    const auto axis = static_cast<std::size_t>(AxisOfLetter(letter));
    std::fill_n(
        own.twist.begin() + static_cast<std::ptrdiff_t>((k * kMost + axis) * kChunk), kChunk, 1.0);
  }
  own.least.assign(PoseBlock::kCapacity, 0.0);
  own.most.assign(PoseBlock::kCapacity, 0.0);
  own.side.assign(PoseBlock::kCapacity, 0.0);
}
DexterityBlock::DexterityBlock(DexterityBlock&&) noexcept = default;
DexterityBlock& DexterityBlock::operator=(DexterityBlock&&) noexcept = default;
DexterityBlock::~DexterityBlock() = default;

void DexterityBlock::Evaluate(const PoseBlock& poses, std::size_t count) {
  if (count > PoseBlock::kCapacity)
    throw std::logic_error("DexterityBlock::Evaluate: expects count <= kCapacity");
  Impl& own = *impl_;
  for (std::size_t first = 0; first < count; first += kChunk) {
    const std::size_t size = std::min(kChunk, count - first);
    for (std::size_t k = 0; k < own.n; ++k) {
      const std::span<const double> column =
          poses.column(static_cast<std::size_t>(own.mechanism->coordinate[k]));
      for (std::size_t i = 0; i < size; ++i)
        own.local[k * kChunk + i] = own.mechanism->sign[k] * column[first + i];
    }
    own.Chunk(first, size);
  }
}

Dexterity DexterityBlock::At(std::size_t pose) const {
  const double low = impl_->least[pose];
  const double high = impl_->most[pose];
  return {.condition = std::sqrt(high / low),
          .weakest_force = std::sqrt(low),
          .slowest_velocity = 1.0 / std::sqrt(high)};
}

bool DexterityBlock::OnHomeSide(std::size_t pose) const {
  return impl_->home_sign == 0.0 || impl_->side[pose] * impl_->home_sign > 0.0;
}

namespace {

/// One thread's share of a field.
struct Part {
  DexterityField field;
  double sum = 0.0, inverse_sum = 0.0;
  std::uint64_t best = 0, worst = 0;  ///< grid index

  void Take(const Dexterity& at, std::uint64_t index) {
    if (!std::isfinite(at.condition)) return;
    const bool first = field.poses++ == 0;
    if (first || at.condition < field.best) {
      field.best = at.condition;
      best = index;
    }
    if (first || at.condition > field.worst) {
      field.worst = at.condition;
      worst = index;
    }
    field.weakest_force =
        first ? at.weakest_force : std::min(field.weakest_force, at.weakest_force);
    field.slowest_velocity =
        first ? at.slowest_velocity : std::min(field.slowest_velocity, at.slowest_velocity);
    sum += at.condition;
    inverse_sum += 1.0 / at.condition;
  }
};

VectorXd GridPose(const Region& region, std::span<const std::uint64_t> steps, std::uint64_t index) {
  VectorXd z = region.z;
  for (std::size_t i = region.dimension(); i-- > 0;) {
    z[region.varied[i]] = region.lower[i] + (static_cast<double>(index % steps[i]) + 0.5) *
                                                region.Extent(i) / static_cast<double>(steps[i]);
    index /= steps[i];
  }
  return z;
}

}  // namespace

DexterityField DexterityOver(const PoseJudge& judge,
                             std::size_t mechanism,
                             double length_mm,
                             const Region& region,
                             std::span<const std::uint64_t> steps,
                             const RunControl& control,
                             bool regular) {
  constexpr std::size_t kCapacity = PoseBlock::kCapacity;
  std::uint64_t poses = 1;
  for (const std::uint64_t step : steps) poses *= step;
  std::vector<PoseBlock> blocks;
  std::vector<DexterityBlock> dexterity;
  for (unsigned i = 0; i < control.Threads(); ++i) {
    blocks.emplace_back(judge);
    dexterity.emplace_back(judge, mechanism, length_mm, regular);
    FillHeld(region, blocks.back());
  }
  std::vector<Part> parts(blocks.size());
  const std::uint64_t tasks = (poses + kCapacity - 1) / kCapacity;
  const std::uint64_t done = ForEachTask(tasks, control, [&](std::uint64_t task, unsigned worker) {
    const std::uint64_t first = task * kCapacity;
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(kCapacity, poses - first));
    FillGrid(region, steps, first, count, blocks[worker]);
    blocks[worker].Judge(count);
    if (blocks[worker].InsideCount() == 0) return;
    dexterity[worker].Evaluate(blocks[worker], count);
    for (std::size_t k = 0; k < count; ++k) {
      if (blocks[worker].Inside(k) && dexterity[worker].OnHomeSide(k))
        parts[worker].Take(dexterity[worker].At(k), first + k);
    }
  });
  DexterityField out;
  double sum = 0.0;
  double inverse_sum = 0.0;
  for (const Part& part : parts) {
    if (part.field.poses == 0) continue;
    const bool first = out.poses == 0;
    // Equal conditions: the earlier pose, whatever thread found it.
    if (first || part.field.best < out.best) {
      out.best = part.field.best;
      out.best_at = GridPose(region, steps, part.best);
    }
    if (first || part.field.worst > out.worst) {
      out.worst = part.field.worst;
      out.worst_at = GridPose(region, steps, part.worst);
    }
    out.weakest_force =
        first ? part.field.weakest_force : std::min(out.weakest_force, part.field.weakest_force);
    out.slowest_velocity = first ? part.field.slowest_velocity
                                 : std::min(out.slowest_velocity, part.field.slowest_velocity);
    out.poses += part.field.poses;
    sum += part.sum;
    inverse_sum += part.inverse_sum;
  }
  if (out.poses > 0) {
    out.mean = sum / static_cast<double>(out.poses);
    out.global = inverse_sum / static_cast<double>(out.poses);
  }
  out.stopped = done < tasks;
  return out;
}

}  // namespace kompono::analysis
