// SPDX-License-Identifier: Apache-2.0
// The hot loop: a block of poses through the mechanisms' batch functions, then one pass per drive.
#include "lanes.hpp"
#include "segments.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kompono/analysis/pose_judge.hpp"

namespace kompono::analysis {
namespace {

constexpr std::size_t kCapacity = PoseBlock::kCapacity;
static_assert(kCapacity % lanes::kCount == 0);

std::vector<double*> MakeColumns(std::vector<double>& storage, std::size_t count) {
  storage.assign(count * kCapacity, 0.0);
  std::vector<double*> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = storage.data() + i * kCapacity;
  return out;
}

/// inside &= lower <= q <= upper. What is no number is outside. Runs over whole registers: the
/// columns are longer than any count.
void KeepWithin(
    const double* q, double lower, double upper, std::size_t count, std::int64_t* inside) {
  const lanes::Number low = lanes::Broadcast(lower);
  const lanes::Number high = lanes::Broadcast(upper);
  for (std::size_t k = 0; k < count; k += lanes::kCount) {
    const lanes::Number value = lanes::Load(q + k);
    const lanes::Mask kept = (value >= low) & (value <= high);
    lanes::Store(inside + k, lanes::Load(inside + k) & kept);
  }
}

void Check(plugin::Status status, const std::string& block) {
  if (status != plugin::Status::kOk) {
    throw std::logic_error("the module of " + block + " cannot evaluate a batch of poses");
  }
}

Eigen::Vector3d PointAt(const std::vector<double>& points, int point, std::size_t pose) {
  const double* first = points.data() + 3 * static_cast<std::size_t>(point) * kCapacity + pose;
  return {first[0], first[kCapacity], first[2 * kCapacity]};
}

/// The joint's axis in the base.
Eigen::Vector3d AxisAt(const PoseJudge::Joint& joint,
                       const std::vector<double>& platform,
                       std::size_t pose) {
  if (!joint.on_platform) return joint.axis;
  Eigen::Matrix3d R;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      R(static_cast<int>(i), static_cast<int>(j)) = platform[(4 * i + j) * kCapacity + pose];
    }
  }
  return R * joint.axis;
}

bool SwingKept(const PoseJudge::Joint& joint,
               const std::vector<double>& points,
               const std::vector<double>& platform,
               std::size_t pose) {
  const Eigen::Vector3d strut =
      PointAt(points, joint.other, pose) - PointAt(points, joint.at, pose);
  return AxisAt(joint, platform, pose).dot(strut) >= joint.cosine * strut.norm();
}

bool ClearanceKept(const PoseJudge::StrutPair& pair,
                   const std::vector<double>& points,
                   std::size_t pose) {
  return SegmentDistance(PointAt(points, pair.first[0], pose),
                         PointAt(points, pair.first[1], pose),
                         PointAt(points, pair.second[0], pose),
                         PointAt(points, pair.second[1], pose)) >= pair.distance_mm;
}

}  // namespace

PoseBlock::PoseBlock(const PoseJudge& judge)
    : judge_(&judge),
      coordinates_(judge.coordinates() * kCapacity, 0.0),
      work_(judge.mechanisms().size()),
      inside_(kCapacity, 0) {
  for (std::size_t m = 0; m < work_.size(); ++m) {
    const PoseJudge::Mechanism& mechanism = judge.mechanisms()[m];
    Work& own = work_[m];
    const std::vector<double*> local = MakeColumns(own.local, mechanism.coordinate.size());
    for (std::size_t i = 0; i < mechanism.coordinate.size(); ++i) {
      const double* shared =
          coordinates_.data() + static_cast<std::size_t>(mechanism.coordinate[i]) * kCapacity;
      own.in.push_back(mechanism.sign[i] > 0.0 ? shared : local[i]);
    }
    const auto drives = static_cast<std::size_t>(mechanism.shape.drives);
    own.drives_out = MakeColumns(own.drives, drives);
    own.drives_in.assign(own.drives_out.begin(), own.drives_out.end());
    if (mechanism.joints.empty() && mechanism.pairs.empty()) continue;
    own.points_out = MakeColumns(own.points, 3 * static_cast<std::size_t>(mechanism.shape.points));
    own.platform_out = MakeColumns(own.platform, 12);
  }
}

void PoseBlock::Judge(std::size_t count) {
  if (count > kCapacity) throw std::logic_error("PoseBlock::Judge: expects count <= kCapacity");
  std::fill_n(inside_.begin(), count, -1);
  for (std::size_t m = 0; m < work_.size(); ++m) {
    const PoseJudge::Mechanism& mechanism = judge_->mechanisms()[m];
    JudgeDrives(mechanism, work_[m], count);
    if (!mechanism.joints.empty() || !mechanism.pairs.empty())
      JudgeSkeleton(mechanism, work_[m], count);
  }
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < count; ++k) sum -= inside_[k];
  inside_count_ = static_cast<std::size_t>(sum);
}

void PoseBlock::JudgeDrives(const PoseJudge::Mechanism& mechanism, Work& work, std::size_t count) {
  for (std::size_t i = 0; i < mechanism.coordinate.size(); ++i) {
    if (mechanism.sign[i] > 0.0) continue;
    const std::span<const double> shared =
        column(static_cast<std::size_t>(mechanism.coordinate[i]));
    double* negated = work.local.data() + i * kCapacity;
    for (std::size_t k = 0; k < count; ++k) negated[k] = -shared[k];
  }
  Check(mechanism.code->EvaluateBatch(plugin::Quantity::kDrives,
                                      {.count = count,
                                       .coordinates = work.in.data(),
                                       .drives = nullptr,
                                       .parameters = mechanism.parameters,
                                       .modes = mechanism.modes,
                                       .values = work.drives_out.data()}),
        mechanism.block);
  for (std::size_t i = 0; i < work.drives_out.size(); ++i) {
    KeepWithin(work.drives_out[i], mechanism.lower[i], mechanism.upper[i], count, inside_.data());
  }
}

void PoseBlock::JudgeSkeleton(const PoseJudge::Mechanism& mechanism,
                              Work& work,
                              std::size_t count) {
  plugin::MechanismBatch batch{.count = count,
                               .coordinates = work.in.data(),
                               .drives = work.drives_in.data(),
                               .parameters = mechanism.parameters,
                               .modes = mechanism.modes,
                               .values = work.points_out.data()};
  Check(mechanism.code->EvaluateBatch(plugin::Quantity::kSkeleton, batch), mechanism.block);
  batch.values = work.platform_out.data();
  Check(mechanism.code->EvaluateBatch(plugin::Quantity::kPlatform, batch), mechanism.block);
  for (std::size_t k = 0; k < count; ++k) {
    if (inside_[k] == 0) continue;
    const bool kept =
        std::all_of(mechanism.joints.begin(),
                    mechanism.joints.end(),
                    [&](const PoseJudge::Joint& joint) {
                      return SwingKept(joint, work.points, work.platform, k);
                    }) &&
        std::all_of(
            mechanism.pairs.begin(), mechanism.pairs.end(), [&](const PoseJudge::StrutPair& pair) {
              return ClearanceKept(pair, work.points, k);
            });
    if (!kept) inside_[k] = 0;
  }
}

bool PoseBlock::Keeps(const Constraint& constraint, std::size_t pose) const {
  const auto m = static_cast<std::size_t>(constraint.mechanism);
  const auto row = static_cast<std::size_t>(constraint.row);
  const PoseJudge::Mechanism& mechanism = judge_->mechanisms()[m];
  const Work& own = work_[m];
  switch (constraint.kind) {
    case Constraint::Kind::kReach:
      return std::isfinite(own.drives[row * kCapacity + pose]);
    case Constraint::Kind::kDriveLower:
      return own.drives[row * kCapacity + pose] >= mechanism.lower[row];
    case Constraint::Kind::kDriveUpper:
      return own.drives[row * kCapacity + pose] <= mechanism.upper[row];
    case Constraint::Kind::kSwing:
      return SwingKept(mechanism.joints[row], own.points, own.platform, pose);
    case Constraint::Kind::kClearance:
      return ClearanceKept(mechanism.pairs[row], own.points, pose);
    case Constraint::Kind::kRegular:
      break;  // judged by ZoneFunction only
  }
  return true;
}

int PoseBlock::CauseOf(std::size_t pose) const {
  if (Inside(pose)) return -1;
  const std::vector<Constraint>& all = judge_->constraints();
  const auto broken = std::find_if(
      all.begin(), all.end(), [&](const Constraint& one) { return !Keeps(one, pose); });
  return broken == all.end() ? -1 : static_cast<int>(broken - all.begin());
}

double PoseBlock::DriveCoordinate(std::size_t mechanism,
                                  std::size_t drive,
                                  std::size_t pose) const {
  return work_[mechanism].drives[drive * kCapacity + pose];
}

void FillHeld(const Region& region, PoseBlock& block) {
  for (Eigen::Index i = 0; i < region.z.size(); ++i) {
    const std::span<double> column = block.column(static_cast<std::size_t>(i));
    std::fill(column.begin(), column.end(), region.z[i]);
  }
}

namespace {

/// column[begin, end) = from + i * step for i = 0, 1, …
void FillRamp(double* column, std::size_t begin, std::size_t end, double from, double step) {
  std::size_t k = begin;
  // From the index, not by adding up: no rounding gathers.
  for (; k + lanes::kCount <= end; k += lanes::kCount) {
    const auto i = static_cast<double>(k - begin);
    lanes::Store(column + k, lanes::Number{from + i * step, from + (i + 1.0) * step});
  }
  for (; k < end; ++k) column[k] = from + static_cast<double>(k - begin) * step;
}

}  // namespace

void FillGrid(const Region& region,
              std::span<const std::uint64_t> steps,
              std::uint64_t first,
              std::size_t count,
              PoseBlock& block) {
  const std::size_t n = region.dimension();
  const std::size_t fast = n - 1;
  std::size_t done = 0;
  while (done < count) {  // one row of the fastest coordinate, or what is left of it
    std::uint64_t index = first + done;
    const std::uint64_t in_row = index % steps[fast];
    const auto run =
        static_cast<std::size_t>(std::min<std::uint64_t>(count - done, steps[fast] - in_row));
    for (std::size_t i = n; i-- > 0;) {
      const double step = region.Extent(i) / static_cast<double>(steps[i]);
      const double value = region.lower[i] + (static_cast<double>(index % steps[i]) + 0.5) * step;
      index /= steps[i];
      double* column = block.column(static_cast<std::size_t>(region.varied[i])).data();
      if (i == fast) {
        FillRamp(column, done, done + run, value, step);
      } else {
        std::fill_n(column + done, run, value);
      }
    }
    done += run;
  }
}

PoseCount CountGrid(const PoseJudge& judge,
                    const Region& region,
                    std::span<const std::uint64_t> steps,
                    bool with_causes,
                    const RunControl& control) {
  std::uint64_t poses = 1;
  for (const std::uint64_t step : steps) poses *= step;
  const unsigned threads = control.Threads();
  std::vector<PoseBlock> blocks;
  std::vector<PoseCount> counts(threads);
  for (unsigned i = 0; i < threads; ++i) {
    counts[i].causes.assign(judge.constraints().size(), 0);
    blocks.emplace_back(judge);
    FillHeld(region, blocks.back());
  }
  const std::uint64_t tasks = (poses + kCapacity - 1) / kCapacity;
  const std::uint64_t done = ForEachTask(tasks, control, [&](std::uint64_t task, unsigned worker) {
    PoseBlock& block = blocks[worker];
    PoseCount& sum = counts[worker];
    const std::uint64_t first = task * kCapacity;
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(kCapacity, poses - first));
    FillGrid(region, steps, first, count, block);
    block.Judge(count);
    sum.poses += count;
    sum.inside += block.InsideCount();
    for (std::size_t k = 0; with_causes && k < count; ++k) {
      const int cause = block.CauseOf(k);
      if (cause >= 0) ++sum.causes[static_cast<std::size_t>(cause)];
    }
  });
  PoseCount out{.causes = std::vector<std::uint64_t>(judge.constraints().size(), 0),
                .stopped = done < tasks};
  for (const PoseCount& sum : counts) {
    out.poses += sum.poses;
    out.inside += sum.inside;
    for (std::size_t i = 0; i < out.causes.size(); ++i) out.causes[i] += sum.causes[i];
  }
  return out;
}

int CauseAt(const PoseJudge& judge, const VectorXd& z) {
  PoseBlock block(judge);
  for (Eigen::Index i = 0; i < z.size(); ++i) block.column(static_cast<std::size_t>(i))[0] = z[i];
  block.Judge(1);
  return block.CauseOf(0);
}

}  // namespace kompono::analysis
