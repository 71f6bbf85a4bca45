// SPDX-License-Identifier: Apache-2.0
#include "kompono/synthesis/front.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "kompono/diagnostics/expects.hpp"

namespace kompono::synthesis {
namespace {

/// How two rows of minimised values stand to each other.
struct Comparison {
  bool first_better = false;   ///< somewhere
  bool second_better = false;  ///< somewhere
};

Comparison Compare(const double* first, const double* second, std::size_t size) {
  Comparison comparison;
  for (std::size_t k = 0; k < size; ++k) {
    comparison.first_better |= first[k] < second[k];
    comparison.second_better |= second[k] < first[k];
    if (comparison.first_better && comparison.second_better) break;
  }
  return comparison;
}

}  // namespace

Front::Front(std::vector<Direction> directions) : directions_(std::move(directions)) {
  KOMPONO_EXPECTS(!directions_.empty());
}

std::size_t Front::size() const {
  return ids_.size();
}

std::span<const double> Front::Row(std::size_t row) const {
  return std::span(rows_).subspan(row * directions_.size(), directions_.size());
}

std::vector<double> Front::Turned(std::span<const double> values) const {
  std::vector<double> turned(values.begin(), values.end());
  for (std::size_t k = 0; k < turned.size(); ++k) {
    if (directions_[k] == Direction::kMaximise) turned[k] = -turned[k];
  }
  return turned;
}

void Front::Swap(std::size_t a, std::size_t b) {
  if (a == b) return;
  const std::size_t n = directions_.size();
  std::swap_ranges(rows_.begin() + static_cast<long>(a * n),
                   rows_.begin() + static_cast<long>((a + 1) * n),
                   rows_.begin() + static_cast<long>(b * n));
  std::swap(ids_[a], ids_[b]);
}

void Front::DropLast() {
  rows_.resize(rows_.size() - directions_.size());
  ids_.pop_back();
}

bool Front::Insert(std::uint64_t id, std::span<const double> values) {
  KOMPONO_EXPECTS(values.size() == directions_.size());
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!std::all_of(values.begin(), values.end(), finite)) return false;
  const std::size_t n = directions_.size();
  // The new row stands behind the others while they are looked at.
  rows_.insert(rows_.end(), values.begin(), values.end());
  ids_.push_back(id);
  for (std::size_t k = 0; k < n; ++k) {
    double& value = rows_[rows_.size() - n + k];
    if (directions_[k] == Direction::kMaximise) value = -value;
  }
  for (std::size_t row = 0; row + 1 < ids_.size();) {
    const double* mine = rows_.data() + (ids_.size() - 1) * n;
    const Comparison comparison = Compare(rows_.data() + row * n, mine, n);
    const bool twice = !comparison.first_better && !comparison.second_better && ids_[row] == id;
    if ((comparison.first_better && !comparison.second_better) || twice) {
      Swap(row, row / 2);  // what dominates one point dominates many: it is looked at early
      DropLast();
      return false;
    }
    if (comparison.second_better && !comparison.first_better) {
      const std::size_t last = ids_.size() - 1;
      Swap(row, last - 1);
      Swap(last - 1, last);
      DropLast();
    } else {
      ++row;
    }
  }
  return true;
}

void Front::Merge(const Front& other) {
  KOMPONO_EXPECTS(directions_ == other.directions_);
  for (const FrontPoint& point : other.Points()) Insert(point.id, point.values);
}

FrontPoint Front::At(std::size_t row) const {
  const std::span<const double> turned = Row(row);
  return {ids_[row], Turned(turned)};
}

std::vector<FrontPoint> Front::Points() const {
  std::vector<FrontPoint> points;
  points.reserve(ids_.size());
  for (std::size_t row = 0; row < ids_.size(); ++row) points.push_back(At(row));
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return std::tie(a.id, a.values) < std::tie(b.id, b.values);
  });
  return points;
}

std::vector<FrontPoint> Front::Extremes() const {
  std::vector<FrontPoint> extremes;
  if (ids_.empty()) return extremes;
  for (std::size_t k = 0; k < directions_.size(); ++k) {
    const auto better = [&](std::size_t a, std::size_t b) {
      const auto row_a = Row(a);
      const auto row_b = Row(b);
      for (std::size_t i = 0; i < row_a.size(); ++i) {
        const std::size_t objective = (k + i) % row_a.size();
        if (row_a[objective] != row_b[objective]) return row_a[objective] < row_b[objective];
      }
      return ids_[a] < ids_[b];
    };
    std::size_t best = 0;
    for (std::size_t row = 1; row < ids_.size(); ++row) {
      if (better(row, best)) best = row;
    }
    extremes.push_back(At(best));
  }
  return extremes;
}

std::vector<double> Front::Scales() const {
  std::vector<double> scales;
  for (std::size_t k = 0; k < directions_.size(); ++k) {
    double least = HUGE_VAL;
    double greatest = -HUGE_VAL;
    for (std::size_t row = 0; row < ids_.size(); ++row) {
      least = std::min(least, Row(row)[k]);
      greatest = std::max(greatest, Row(row)[k]);
    }
    scales.push_back(greatest > least ? 1.0 / (greatest - least) : 0.0);
  }
  return scales;
}

std::optional<FrontPoint> Front::Knee() const {
  if (ids_.empty()) return std::nullopt;
  const std::vector<double> scales = Scales();
  std::vector<std::pair<double, std::uint64_t>> sums;
  for (std::size_t row = 0; row < ids_.size(); ++row) {
    const auto values = Row(row);
    sums.emplace_back(std::inner_product(values.begin(), values.end(), scales.begin(), 0.0),
                      ids_[row]);
  }
  const auto least = std::min_element(sums.begin(), sums.end());
  return At(static_cast<std::size_t>(least - sums.begin()));
}

std::vector<FrontPoint> Front::Thinned(std::span<const double> epsilon) const {
  KOMPONO_EXPECTS(epsilon.size() == directions_.size());
  KOMPONO_EXPECTS(std::all_of(epsilon.begin(), epsilon.end(), [](double e) { return e > 0.0; }));
  const std::vector<double> scales = Scales();
  struct Best {
    double sum = 0.0;
    std::uint64_t id = 0;
    std::size_t row = 0;
    bool operator<(const Best& other) const {
      return std::tie(sum, id, row) < std::tie(other.sum, other.id, other.row);
    }
  };
  std::map<std::vector<double>, Best> boxes;
  for (std::size_t row = 0; row < ids_.size(); ++row) {
    const auto values = Row(row);
    std::vector<double> box;
    for (std::size_t k = 0; k < values.size(); ++k)
      box.push_back(std::floor(values[k] / epsilon[k]));
    const double sum = std::inner_product(values.begin(), values.end(), scales.begin(), 0.0);
    const Best best{sum, ids_[row], row};
    const auto [place, is_new] = boxes.try_emplace(std::move(box), best);
    if (!is_new && best < place->second) place->second = best;
  }
  Front front_of_boxes(std::vector<Direction>(directions_.size(), Direction::kMinimise));
  for (const auto& [box, best] : boxes) front_of_boxes.Insert(best.row, box);
  std::vector<FrontPoint> points;
  for (const FrontPoint& box : front_of_boxes.Points()) {
    points.push_back(At(static_cast<std::size_t>(box.id)));
  }
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return std::tie(a.id, a.values) < std::tie(b.id, b.values);
  });
  return points;
}

std::optional<Domination> Front::WhyDominated(std::span<const double> values) const {
  KOMPONO_EXPECTS(values.size() == directions_.size());
  const std::vector<double> mine = Turned(values);
  const std::vector<double> scales = Scales();
  std::optional<Domination> why;
  double best_least = -1.0;
  std::size_t dominators = 0;
  for (std::size_t row = 0; row < ids_.size(); ++row) {
    const auto theirs = Row(row);
    const Comparison comparison = Compare(theirs.data(), mine.data(), mine.size());
    if (!comparison.first_better || comparison.second_better) continue;
    ++dominators;
    Domination domination{.by = At(row), .better_by = std::vector<double>(mine.size())};
    double least = HUGE_VAL;
    double most = -1.0;
    for (std::size_t k = 0; k < mine.size(); ++k) {
      domination.better_by[k] = mine[k] - theirs[k];
      const double scaled = domination.better_by[k] * scales[k];
      least = std::min(least, scaled);
      if (scaled > most) {
        most = scaled;
        domination.most = k;
      }
    }
    const bool first =
        !why || least > best_least || (least == best_least && domination.by.id < why->by.id);
    if (!first) continue;
    best_least = least;
    why = std::move(domination);
  }
  if (why) why->dominators = dominators;
  return why;
}

}  // namespace kompono::synthesis
