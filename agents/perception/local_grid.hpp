// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/perception/laser_beams.hpp"
#include "common/map/map_grid.hpp"

namespace sidestep {

struct LocalGridSettings {
  int side_cells = 256;  ///< cells per side, a power of two from 16 to 4,096
};

enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

/// The floor around a robot as seen by its own laser: an occupancy grid (Moravec, Elfes 1985) that moves
/// along with the robot by whole cells. Cells are numbered in the world: cell (0, 0) has its lower left
/// corner at the world's origin. Cells outside the window are unknown. Does not allocate after the
/// constructor.
class LocalGrid {
 public:
  static constexpr double kResolution_m = 0.05;  ///< side of a cell
  // Evidence is counted in log odds: ln(p / (1 - p)), where p is the probability that a cell is occupied; 0
  // means unknown.
  static constexpr float kHit = 0.85F;  ///< added to a cell with hits, once per scan
  static constexpr float kMiss = 0.4F;  ///< subtracted from a cell that beams cross, once per scan
  /// Evidence saturates at ± this value; otherwise changes would be noticed late.
  static constexpr float kLimit = 3.5F;
  static constexpr double kDecay_s = 20;  ///< time in which evidence decays to 1/e without observations

  /// Throws std::invalid_argument if the number of cells is out of range.
  explicit LocalGrid(const LocalGridSettings& settings = {});

  /// Moves the window to the scanner, lets old evidence decay, and adds the evidence of a scan. Beams clear
  /// the cells up to their hit, or up to the maximum range. A cell with a hit is not cleared by other beams
  /// of the same scan. Hits on known robots are not added, and dropouts change nothing. Returns false and
  /// changes nothing if the scan is not newer than the last scan. Throws std::invalid_argument for positions
  /// beyond kMaxMapOrigin_m.
  bool update(const LaserBeams& beams);

  int side_cells() const { return settings_.side_cells; }
  Time updated_at() const { return updated_at_; }
  Cell cell_at(const Vec2& p) const;
  Box box_of(const Cell& cell) const {
    return {{cell.column * kResolution_m, cell.row * kResolution_m},
            {(cell.column + 1) * kResolution_m, (cell.row + 1) * kResolution_m}};
  }
  bool has(const Cell& cell) const {
    return in_window(cell.column, first_.column) && in_window(cell.row, first_.row);
  }

  /// Evidence of a cell; 0 outside the window.
  float log_odds(const Cell& cell) const { return has(cell) ? log_odds_[index(cell)] : 0; }
  CellState state(const Cell& cell) const {
    const float odds = log_odds(cell);
    if (odds >= kOccupiedFrom) return CellState::kOccupied;
    return odds <= kFreeUpTo ? CellState::kFree : CellState::kUnknown;
  }
  CellState state_at(const Vec2& p) const { return state(cell_at(p)); }
  /// How long a cell has been occupied without interruption; 0 if it is not occupied.
  Duration occupied_for(const Cell& cell) const;
  /// When a beam last crossed a cell; Time::min() if none has since the cell entered the window.
  Time crossed_at(const Cell& cell) const { return has(cell) ? crossed_at_[index(cell)] : Time::min(); }

  /// Calls `call(cell)` for the occupied cells whose closed squares intersect a box.
  template <typename Call>
  void for_each_occupied(const Box& box, const Call& call) const;

 private:
  static constexpr float kOccupiedFrom = 1.2F;  // a cell with at least this evidence is occupied
  // A cell with at most this evidence is free; in between it is unknown.
  static constexpr float kFreeUpTo = -0.6F;

  bool in_window(int number, int first) const {
    const std::int64_t offset = std::int64_t{number} - first;
    return offset >= 0 && offset < settings_.side_cells;
  }
  std::size_t index(const Cell& cell) const {
    const auto mask = static_cast<unsigned>(settings_.side_cells - 1);
    return static_cast<std::size_t>(static_cast<unsigned>(cell.row) & mask) *
               static_cast<std::size_t>(settings_.side_cells) +
           (static_cast<unsigned>(cell.column) & mask);
  }
  void move_window(const Cell& centre);
  void forget(const Cell& cell);
  void decay(Duration passed);
  void add_hit(const Cell& cell);
  void add_miss(std::size_t index);
  void clear_along(const Vec2& from_m, const Beam& beam);

  LocalGridSettings settings_;
  Cell first_{};  // lower left cell of the window
  bool is_empty_ = true;
  Time updated_at_{};
  std::uint32_t scan_ = 0;
  // Ring buffer in both directions.
  std::vector<float> log_odds_;
  std::vector<Time> occupied_since_;  // only for occupied cells
  std::vector<Time> crossed_at_;
  std::vector<std::uint32_t> touched_;  // the last scan that changed the cell
};

template <typename Call>
void LocalGrid::for_each_occupied(const Box& box, const Call& call) const {
  const double cells_per_m = 1 / kResolution_m;
  const auto clipped = [&](double at, int first) {
    return static_cast<int>(
        std::clamp(at, static_cast<double>(first) - 1, static_cast<double>(first) + settings_.side_cells));
  };
  const Cell first{clipped(std::ceil(box.min_m.x() * cells_per_m) - 1, first_.column),
                   clipped(std::ceil(box.min_m.y() * cells_per_m) - 1, first_.row)};
  const Cell last{clipped(std::floor(box.max_m.x() * cells_per_m), first_.column),
                  clipped(std::floor(box.max_m.y() * cells_per_m), first_.row)};
  for (int row = first.row; row <= last.row; ++row)
    for (int column = first.column; column <= last.column; ++column)
      if (const Cell cell{column, row}; state(cell) == CellState::kOccupied) call(cell);
}

}  // namespace sidestep
