// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/local_grid.hpp"

#include <bit>
#include <limits>
#include <stdexcept>

namespace sidestep {
namespace {

/// One axis of a ray on its way through the cells.
struct CellAxis {
  CellAxis(double from, double direction, double resolution_m)
      : index(static_cast<int>(std::floor(from / resolution_m))), step(direction > 0 ? 1 : -1) {
    if (direction == 0) return;
    per_cell_m = resolution_m / std::abs(direction);
    next_m = ((index + (step > 0 ? 1 : 0)) * resolution_m - from) / direction;
  }
  void advance() {
    index += step;
    next_m += per_cell_m;
  }

  int index, step;
  double per_cell_m = std::numeric_limits<double>::infinity();
  // Distance at which the ray leaves the column or row.
  double next_m = std::numeric_limits<double>::infinity();
};

}  // namespace

LocalGrid::LocalGrid(const LocalGridSettings& settings) : settings_(settings) {
  const auto side = static_cast<std::size_t>(settings.side_cells);
  if (settings.side_cells < 16 || settings.side_cells > 4096 || !std::has_single_bit(side))
    throw std::invalid_argument("a local grid's cells per side must be a power of two from 16 to 4096");
  log_odds_.resize(side * side);
  occupied_since_.resize(side * side);
  crossed_at_.resize(side * side, Time::min());
  touched_.resize(side * side);
}

Cell LocalGrid::cell_at(const Vec2& p) const {
  constexpr double kMost = 2e9;  // outside any window, but still fits an int
  const auto number = [&](double at_m) {
    const double at = std::floor(at_m / kResolution_m);
    return at >= -kMost && at <= kMost ? static_cast<int>(at) : std::numeric_limits<int>::max();
  };
  return {number(p.x()), number(p.y())};
}

Duration LocalGrid::occupied_for(const Cell& cell) const {
  return state(cell) == CellState::kOccupied ? updated_at_ - occupied_since_[index(cell)] : Duration::zero();
}

void LocalGrid::forget(const Cell& cell) {
  const std::size_t i = index(cell);
  log_odds_[i] = 0;
  crossed_at_[i] = Time::min();
  touched_[i] = 0;
}

void LocalGrid::move_window(const Cell& centre) {
  const int side = settings_.side_cells;
  const Cell before = first_;
  first_ = {centre.column - side / 2, centre.row - side / 2};
  const auto is_new = [side](int number, int first) { return number < first || number >= first + side; };
  for (int row = first_.row; row < first_.row + side; ++row) {
    if (is_empty_ || is_new(row, before.row)) {
      for (int column = first_.column; column < first_.column + side; ++column) forget({column, row});
      continue;
    }
    const int moved = first_.column - before.column;
    const int begin = moved > 0 ? std::max(first_.column, before.column + side) : first_.column;
    const int end = moved > 0 ? first_.column + side : std::min(first_.column + side, before.column);
    for (int column = begin; column < end; ++column) forget({column, row});
  }
  is_empty_ = false;
}

void LocalGrid::decay(Duration passed) {
  const auto factor = static_cast<float>(std::exp(-to_seconds(passed) / kDecay_s));
  constexpr float kNegligible = 1e-3F;  // avoids denormal numbers, which are slow
  for (float& odds : log_odds_) odds = std::abs(odds) < kNegligible ? 0 : odds * factor;
}

void LocalGrid::add_hit(const Cell& cell) {
  if (!has(cell)) return;
  const std::size_t i = index(cell);
  if (touched_[i] == scan_) return;
  touched_[i] = scan_;
  if (log_odds_[i] < kOccupiedFrom) occupied_since_[i] = updated_at_;
  log_odds_[i] = std::min(log_odds_[i] + kHit, kLimit);
}

void LocalGrid::add_miss(std::size_t i) {
  if (touched_[i] == scan_) return;
  touched_[i] = scan_;
  crossed_at_[i] = updated_at_;
  log_odds_[i] = std::max(log_odds_[i] - kMiss, -kLimit);
}

void LocalGrid::clear_along(const Vec2& from, const Beam& beam) {
  CellAxis x(from.x(), beam.direction.x(), kResolution_m);
  CellAxis y(from.y(), beam.direction.y(), kResolution_m);
  while (has({x.index, y.index})) {
    add_miss(index({x.index, y.index}));
    CellAxis& axis = x.next_m < y.next_m ? x : y;
    if (axis.next_m > beam.free_m) return;
    axis.advance();
  }
}

bool LocalGrid::update(const LaserBeams& beams) {
  if (!is_empty_ && beams.captured_at() <= updated_at_) return false;
  if (!(beams.at_m().cwiseAbs().maxCoeff() <= kMaxMapOrigin_m))
    throw std::invalid_argument("the position of a scan is too far from the origin for a local grid");
  if (!is_empty_) decay(beams.captured_at() - updated_at_);
  move_window(cell_at(beams.at_m()));
  updated_at_ = beams.captured_at();
  ++scan_;
  for (const Beam& beam : beams.all())
    if (beam.end == BeamEnd::kHit) add_hit(cell_at(beams.end_m(beam)));
  for (const Beam& beam : beams.all())
    if (beam.end != BeamEnd::kUnknown) clear_along(beams.at_m(), beam);
  return true;
}

}  // namespace sidestep
