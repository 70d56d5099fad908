// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/time_to_goal_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

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

}  // namespace

TimeToGoalField::TimeToGoalField(const JointProblem& problem) : problem_(&problem) {
  columns_ = static_cast<std::size_t>(std::ceil(problem.field.length_m / kTimeCell_m)) + 2 * kCellsPerStep;
  rows_ = static_cast<std::size_t>(std::ceil(problem.field.width_m / kTimeCell_m)) + 2 * kCellsPerStep;
  origin_m_ = -kTimeCell_m / 2 * Vec2(static_cast<double>(columns_ - 1), static_cast<double>(rows_ - 1));
  is_blocked_.resize(columns_ * rows_);
  near_.resize(is_blocked_.size());
  wide_.resize(is_blocked_.size());
  const double distance_m = problem.distance_from_obstacles_m();
  for (std::size_t cell = 0; cell < is_blocked_.size(); ++cell) {
    const std::size_t column = cell % columns_, row = cell / columns_;
    const bool is_border = column < kCellsPerStep || column >= columns_ - kCellsPerStep ||
                           row < kCellsPerStep || row >= rows_ - kCellsPerStep;
    const Vec2 at = centre_m(cell);
    is_blocked_[cell] =
        is_border || !problem.field.contains(at, distance_m) || problem.world->touches(at, distance_m);
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
  for_each_near(at_m, problem_->min_separation_m() - kSlack_m,
                [&](std::size_t cell, double) { times[cell] = kNever; });
}

void TimeToGoalField::compute(const Vec2& goal_m, double speed_mps,
                              std::span<const SampledCourse* const> others) {
  goal_m_ = goal_m;
  speed_mps_ = speed_mps;
  step_s_ = kCellsPerStep * kTimeCell_m / speed_mps;
  double end_s = 0, goal_free_s = 0;  // from goal_free_s on, no other robot comes too close to the goal
  const double separation_m = problem_->min_separation_m();
  for (const SampledCourse* other : others) {
    end_s = std::max(end_s, other->arrival_s());
    for (std::size_t sample = 0; sample < other->samples_m.size(); ++sample)
      if ((other->samples_m[sample] - goal_m).norm() < separation_m)
        goal_free_s = std::max(goal_free_s, kCourseSample_s * static_cast<double>(sample + 1));
  }
  last_ = static_cast<std::size_t>(std::ceil(end_s / step_s_));
  times_.resize((last_ + 1) * is_blocked_.size());
  compute_last(others);
  for (std::size_t step = last_; step-- > 0;) {
    Ms* times = times_.data() + step * is_blocked_.size();
    step_back(times + is_blocked_.size(), times);
    const double t_s = static_cast<double>(step) * step_s_;
    if (t_s >= goal_free_s)
      for_each_near(goal_m_, 2 * kTimeCell_m, [&](std::size_t cell, double distance_m) {
        times[cell] = std::min(times[cell], static_cast<Ms>(1e3 * distance_m / speed_mps_));
      });
    const auto sample = static_cast<std::size_t>(std::lround(t_s / kCourseSample_s));
    for (const SampledCourse* other : others) block(other->at(sample), times);
    for (std::size_t cell = 0; cell < is_blocked_.size(); ++cell)
      if (is_blocked_[cell]) times[cell] = kNever;
  }
}

void TimeToGoalField::compute_last(std::span<const SampledCourse* const> others) {
  // A cell with kNever is blocked here; all others are not reached yet.
  constexpr Ms kOpen = kNever - 1;
  Ms* times = times_.data() + last_ * is_blocked_.size();
  std::fill_n(times, is_blocked_.size(), kOpen);
  for (const SampledCourse* other : others) block(other->samples_m.back(), times);
  for (std::size_t cell = 0; cell < is_blocked_.size(); ++cell)
    if (is_blocked_[cell]) times[cell] = kNever;
  using Entry = std::pair<Ms, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto relax = [&](std::size_t cell, double ms) {
    if (times[cell] == kNever || ms >= times[cell]) return;
    times[cell] = static_cast<Ms>(ms);
    queue.emplace(times[cell], static_cast<std::uint32_t>(cell));
  };
  for_each_near(goal_m_, 2 * kTimeCell_m,
                [&](std::size_t cell, double distance_m) { relax(cell, 1e3 * distance_m / speed_mps_); });
  while (!queue.empty()) {
    const auto [ms, cell] = queue.top();
    queue.pop();
    if (ms > times[cell]) continue;
    for (const CellMove& move : kMoves) {
      const std::ptrdiff_t offset = move.rows * static_cast<std::ptrdiff_t>(columns_) + move.columns;
      const double length_m = kTimeCell_m * std::sqrt(move.columns * move.columns + move.rows * move.rows);
      relax(static_cast<std::size_t>(static_cast<std::ptrdiff_t>(cell) + offset),
            ms + 1e3 * length_m / speed_mps_);
    }
  }
  std::replace(times, times + is_blocked_.size(), kOpen, kNever);
}

void TimeToGoalField::step_back(const Ms* later, Ms* times) {
  const std::size_t cells = is_blocked_.size();
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

double TimeToGoalField::time_to_goal_s(const Vec2& at_m, double t_s) const {
  const std::size_t step = std::min(static_cast<std::size_t>(std::lround(t_s / step_s_)), last_);
  const Ms* times = times_.data() + step * is_blocked_.size();
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
