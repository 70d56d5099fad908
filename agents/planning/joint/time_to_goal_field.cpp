// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/time_to_goal_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kTimeCell_m = 0.05;
/// A robot at its speed limit drives this many cells in one step of time.
constexpr std::size_t kCellsPerStep = 2;
/// Cells near a robot stay free up to this distance inside its disc, so that the grid closes no real gap.
constexpr double kSlack_m = 0.04;

struct CellMove {
  int columns, rows;
};
constexpr std::array<CellMove, 16> kMoves{{{1, 0},
                                           {-1, 0},
                                           {0, 1},
                                           {0, -1},
                                           {1, 1},
                                           {1, -1},
                                           {-1, 1},
                                           {-1, -1},
                                           {2, 1},
                                           {2, -1},
                                           {-2, 1},
                                           {-2, -1},
                                           {1, 2},
                                           {1, -2},
                                           {-1, 2},
                                           {-1, -2}}};

constexpr std::size_t kMaxTiles = 4096;  ///< number of tiles that are remembered, each of a square metre

std::int64_t cell_number(double x_m) { return static_cast<std::int64_t>(std::floor(x_m / kTimeCell_m)); }

Vec2 cell_centre_m(std::int64_t column, std::int64_t row) {
  return kTimeCell_m * Vec2(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
}

std::int64_t floor_div(std::int64_t a, std::int64_t b) { return (a >= 0 ? a : a - b + 1) / b; }

}  // namespace

const TimeToGoalField::Tile& TimeToGoalField::tile(std::int64_t column, std::int64_t row) {
  if (tiles_.size() >= kMaxTiles) tiles_.clear();
  const auto [entry, is_new] = tiles_.try_emplace((column << 32) + row);
  if (!is_new) return entry->second;
  const double distance_m = problem_->distance_from_obstacles_m();
  for (std::int64_t i = 0; i < kTileCells * kTileCells; ++i) {
    const Vec2 at = cell_centre_m(column * kTileCells + i % kTileCells, row * kTileCells + i / kTileCells);
    entry->second[static_cast<std::size_t>(i)] =
        !problem_->field.contains(at, distance_m) || problem_->world->touches(at, distance_m) ? kNever
                                                                                              : Ms{0};
  }
  return entry->second;
}

void TimeToGoalField::set_area(const Box& area_m) {
  constexpr auto kBorder = static_cast<std::int64_t>(kCellsPerStep);
  const auto first_column = cell_number(area_m.min_m.x()) - kBorder,
             first_row = cell_number(area_m.min_m.y()) - kBorder,
             last_column = cell_number(area_m.max_m.x()) + kBorder,
             last_row = cell_number(area_m.max_m.y()) + kBorder;
  columns_ = static_cast<std::size_t>(last_column - first_column + 1);
  rows_ = static_cast<std::size_t>(last_row - first_row + 1);
  origin_m_ = cell_centre_m(first_column, first_row);
  least_.assign(columns_ * rows_, kNever);
  near_.resize(least_.size());
  wide_.resize(least_.size());
  for (std::int64_t tile_row = floor_div(first_row, kTileCells); tile_row <= floor_div(last_row, kTileCells);
       ++tile_row)
    for (std::int64_t tile_column = floor_div(first_column, kTileCells);
         tile_column <= floor_div(last_column, kTileCells); ++tile_column) {
      const Tile& cells = tile(tile_column, tile_row);
      const std::int64_t column0 = tile_column * kTileCells, row0 = tile_row * kTileCells;
      const std::int64_t begin = std::max(column0, first_column + kBorder),
                         end = std::min(column0 + kTileCells, last_column - kBorder + 1);
      for (std::int64_t row = std::max(row0, first_row + kBorder);
           row < std::min(row0 + kTileCells, last_row - kBorder + 1) && begin < end; ++row)
        std::copy_n(cells.begin() + (row - row0) * kTileCells + (begin - column0), end - begin,
                    least_.begin() + (row - first_row) * static_cast<std::int64_t>(columns_) +
                        (begin - first_column));
    }
}

Vec2 TimeToGoalField::centre_m(std::size_t cell) const {
  const std::size_t column = cell % columns_, row = cell / columns_;
  return origin_m_ + kTimeCell_m * Vec2(static_cast<double>(column), static_cast<double>(row));
}

template <typename Call>
void TimeToGoalField::for_each_near(const Vec2& at_m, double distance_m, Call call) const {
  const Vec2 low = (at_m - origin_m_ - Vec2(distance_m, distance_m)) / kTimeCell_m,
             high = (at_m - origin_m_ + Vec2(distance_m, distance_m)) / kTimeCell_m;
  const auto index = [](double x, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(count - 1)));
  };
  const std::size_t first = index(std::ceil(low.x()), columns_), last = index(std::floor(high.x()), columns_);
  for (std::size_t row = index(std::ceil(low.y()), rows_); row <= index(std::floor(high.y()), rows_); ++row)
    for (std::size_t column = first; column <= last; ++column) {
      const std::size_t cell = row * columns_ + column;
      const double distance = (centre_m(cell) - at_m).norm();
      if (distance < distance_m) call(cell, distance);
    }
}

void TimeToGoalField::block(const Vec2& at_m, Ms* times) const {
  const Vec2 at = (at_m - origin_m_) / kTimeCell_m;
  const double radius = (problem_->min_separation_m() - kSlack_m) / kTimeCell_m;
  const auto index = [](double x, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(count)));
  };
  const std::size_t rows_end = index(std::floor(at.y() + radius) + 1, rows_);
  for (std::size_t row = index(std::ceil(at.y() - radius), rows_); row < rows_end; ++row) {
    const double up = static_cast<double>(row) - at.y();
    const double half = std::sqrt(std::max(0.0, radius * radius - up * up));
    const std::size_t first = index(std::ceil(at.x() - half), columns_),
                      end = index(std::floor(at.x() + half) + 1, columns_);
    if (first < end) std::fill_n(times + row * columns_ + first, end - first, kNever);
  }
}

void TimeToGoalField::compute(const Box& area_m, const Vec2& goal_m, double speed_mps,
                              std::span<const TimedPositions> others) {
  set_area(area_m);
  goal_m_ = goal_m;
  speed_mps_ = speed_mps;
  step_s_ = kCellsPerStep * kTimeCell_m / speed_mps;
  double last_s = 0, goal_free_s = 0;  // from goal_free_s on, no other robot comes too close to the goal
  const double separation_m = problem_->min_separation_m();
  for (const TimedPositions& other : others) {
    last_s = std::max(last_s, other.end_s());
    for (std::size_t sample = 0; sample < other.at_m.size(); ++sample)
      if ((other.at_m[sample] - goal_m).squaredNorm() < separation_m * separation_m)
        goal_free_s = std::max(goal_free_s, kCourseSample_s * static_cast<double>(sample + 1));
  }
  last_ = static_cast<std::size_t>(std::ceil(last_s / step_s_));
  times_.resize((last_ + 1) * least_.size());
  computed_cells_ += times_.size();
  compute_last(others);
  for (std::size_t step = last_; step-- > 0;) {
    Ms* times = times_.data() + step * least_.size();
    step_back(times + least_.size(), times);
    const double t_s = static_cast<double>(step) * step_s_;
    if (t_s >= goal_free_s)
      for_each_near(goal_m_, 2 * kTimeCell_m, [&](std::size_t cell, double distance_m) {
        times[cell] = std::min(times[cell], static_cast<Ms>(1e3 * distance_m / speed_mps_));
      });
    const auto sample = static_cast<std::size_t>(std::lround(t_s / kCourseSample_s));
    for (const TimedPositions& other : others)
      if (other.is_known(sample)) block(other.at(sample), times);
    std::ranges::transform(std::span(times, least_.size()), least_, times, std::ranges::max);
  }
}

void TimeToGoalField::compute_last(std::span<const TimedPositions> others) {
  // A cell with kNever is blocked here; all others are not reached yet.
  constexpr Ms kOpen = kNever - 1;
  Ms* times = times_.data() + last_ * least_.size();
  std::fill_n(times, least_.size(), kOpen);
  for (const TimedPositions& other : others)
    if (other.stays) block(other.at_m.back(), times);
  std::ranges::transform(std::span(times, least_.size()), least_, times, std::ranges::max);
  // A queue with one bucket per millisecond (Dial, 1969). No move takes longer than its buckets last.
  std::array<double, kMoves.size()> moves_ms;
  for (std::size_t i = 0; i < kMoves.size(); ++i)
    moves_ms[i] = 1e3 * kTimeCell_m * std::hypot(kMoves[i].columns, kMoves[i].rows) / speed_mps_;
  const double longest_ms = std::max(std::ranges::max(moves_ms), 2e3 * kTimeCell_m / speed_mps_);
  buckets_.resize(static_cast<std::size_t>(longest_ms) + 2);
  std::size_t waiting = 0;
  const auto relax = [&](std::size_t cell, double ms) {
    if (times[cell] == kNever || ms >= times[cell]) return;
    times[cell] = static_cast<Ms>(ms);
    buckets_[static_cast<std::size_t>(ms) % buckets_.size()].push_back(static_cast<std::uint32_t>(cell));
    ++waiting;
  };
  for_each_near(goal_m_, 2 * kTimeCell_m,
                [&](std::size_t cell, double distance_m) { relax(cell, 1e3 * distance_m / speed_mps_); });
  for (std::size_t ms = 0; waiting > 0; ++ms) {
    std::vector<std::uint32_t>& bucket = buckets_[ms % buckets_.size()];
    for (std::size_t i = 0; i < bucket.size(); ++i, --waiting) {
      const std::size_t cell = bucket[i];
      if (times[cell] != static_cast<Ms>(ms)) continue;  // reached earlier by another way
      for (std::size_t k = 0; k < kMoves.size(); ++k) {
        const std::ptrdiff_t offset =
            kMoves[k].rows * static_cast<std::ptrdiff_t>(columns_) + kMoves[k].columns;
        relax(static_cast<std::size_t>(static_cast<std::ptrdiff_t>(cell) + offset),
              static_cast<double>(ms) + moves_ms[k]);
      }
    }
    bucket.clear();
  }
  std::replace(times, times + least_.size(), kOpen, kNever);
}

void TimeToGoalField::step_back(const Ms* later, Ms* times) {
  const std::size_t cells = least_.size();
  for (std::size_t i = 1; i + 1 < cells; ++i)
    near_[i] = std::min(later[i], std::min(later[i - 1], later[i + 1]));
  for (std::size_t i = 2; i + 2 < cells; ++i) wide_[i] = std::min(near_[i - 1], near_[i + 1]);
  const auto step_ms = static_cast<Ms>(std::lround(1e3 * step_s_));
  std::fill_n(times, cells, kNever);
  const std::size_t border = kCellsPerStep * columns_;
  for (std::size_t i = border + kCellsPerStep; i + border + kCellsPerStep < cells; ++i) {
    const Ms beside = std::min(wide_[i - columns_], wide_[i + columns_]),
             far = std::min(near_[i - 2 * columns_], near_[i + 2 * columns_]);
    const Ms nearest = std::min(wide_[i], std::min(beside, far));
    times[i] = std::min(static_cast<Ms>(nearest + step_ms), kNever);
  }
}

TimeToGoalField::Moment TimeToGoalField::at_time(double t_s) const {
  return Moment(std::min(static_cast<std::size_t>(std::lround(t_s / step_s_)), last_));
}

double TimeToGoalField::time_to_goal_s(const Vec2& at_m, Moment moment) const {
  const Ms* times = times_.data() + moment.step_ * least_.size();
  const Vec2 place = (at_m - origin_m_) / kTimeCell_m;
  // A position outside the grid is blocked.
  if (!(place.x() >= 0 && place.y() >= 0)) return kNever_s;
  const auto column = static_cast<std::size_t>(place.x()), row = static_cast<std::size_t>(place.y());
  if (column + 1 >= columns_ || row + 1 >= rows_) return kNever_s;
  double best_s = kNever_s;
  for (const std::size_t cell : {row * columns_ + column, row * columns_ + column + 1,
                                 (row + 1) * columns_ + column, (row + 1) * columns_ + column + 1}) {
    if (times[cell] == kNever) continue;
    best_s = std::min(best_s, 1e-3 * times[cell] + (centre_m(cell) - at_m).norm() / speed_mps_);
  }
  return best_s;
}

}  // namespace sidestep
