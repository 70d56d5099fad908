// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/hull_cell_times.hpp"

#include <stdexcept>

#include "agents/navigation/dynamic_window/hull.hpp"

namespace sidestep {
namespace {

void lower(float& least, double time_s) { least = std::min(least, static_cast<float>(time_s)); }

/// Updates one velocity's times in the cells that a corner of the hull passes through.
class CornerTrace {
 public:
  CornerTrace(CellTimes& times, std::size_t slot) : times_(times), slot_(slot) {}

  void add(const Vec2& corner_m, const ArcMotion& motion) {
    // Seen from the ground, the corner moves as a fixed point appears to move when seen from a robot that
    // moves backwards.
    const ArcMotion backwards = motion.reversed();
    const double horizon_s = static_cast<double>(times_.horizon_s);
    events_s_.assign({0, horizon_s});
    const ObstacleGrid& grid = times_.grid;
    for (int column = 0; column <= grid.columns; ++column)
      add_crossings(corner_m, corner_m.x() - grid.corner_m(column, 0).x(), Vec2(1, 0), backwards, horizon_s);
    for (int row = 0; row <= grid.rows; ++row)
      add_crossings(corner_m, corner_m.y() - grid.corner_m(0, row).y(), Vec2(0, 1), backwards, horizon_s);
    std::ranges::sort(events_s_);
    for (std::size_t i = 0; i + 1 < events_s_.size(); ++i) {
      const Vec2 at = point_after_motion(corner_m, backwards, (events_s_[i] + events_s_[i + 1]) / 2);
      if (const auto cell = grid.cell_of(at)) lower(times_.of(*cell)[slot_], events_s_[i]);
    }
  }

 private:
  void add_crossings(const Vec2& corner_m, double offset_m, const Vec2& normal, const ArcMotion& motion,
                     double horizon_s) {
    for (const double sign : {1.0, -1.0}) {
      const double time_s = first_crossing(corner_m, sign * offset_m, sign * normal, motion).time_s;
      if (time_s < horizon_s) events_s_.push_back(time_s);
    }
  }

  CellTimes& times_;
  std::size_t slot_;
  std::vector<double> events_s_;
};

/// The distance of the farthest corner from the robot's origin.
double outer_radius_m(std::span<const Vec2> corners_m) {
  double radius_m = 0;
  for (const Vec2& corner : corners_m) radius_m = std::max(radius_m, corner.norm());
  return radius_m;
}

/// Updates one velocity's times in the cells whose corners enter the hull.
void add_cell_corners(const Hull& hull, const ArcMotion& motion, std::size_t slot, CellTimes& times) {
  const ObstacleGrid& grid = times.grid;
  const double radius_m = outer_radius_m(hull.corners_m()), horizon_s = static_cast<double>(times.horizon_s);
  for (int row = 0; row <= grid.rows; ++row) {
    for (int column = 0; column <= grid.columns; ++column) {
      const Vec2 corner = grid.corner_m(column, row);
      // Seen from the robot, a point moves at a constant speed.
      const double v = motion.speed_mps, w = motion.turn_rate_radps;
      const double reach_m = horizon_s * std::hypot(v - w * corner.y(), w * corner.x());
      if (corner.norm() > radius_m + reach_m) continue;
      const double time_s = hull.time_to_collision_s(corner, motion);
      if (time_s >= horizon_s) continue;
      for (int r = std::max(row - 1, 0); r <= std::min(row, grid.rows - 1); ++r) {
        for (int c = std::max(column - 1, 0); c <= std::min(column, grid.columns - 1); ++c)
          lower(times.of(grid.index(c, r))[slot], time_s);
      }
    }
  }
}

bool overlap(const Box& cell, std::span<const Vec2> hull) {
  const auto corners = corners_of(cell);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (squared_distance(Segment{corners[i], corners[(i + 1) % corners.size()]}, hull) == 0) return true;
  }
  return signed_distance(hull[0], cell) <= 0;
}

/// The area that a point on the hull can reach within the horizon with any permitted motion.
Box reachable_area(const DifferentialDrive& drive, std::span<const Vec2> corners_m, double horizon_s) {
  const double reach_m = outer_radius_m(corners_m) + drive.speed_mps * horizon_s;
  return {Vec2(-reach_m, -reach_m), Vec2(reach_m, reach_m)};
}

}  // namespace

CellTimes hull_cell_times(const DifferentialDrive& drive, const ConvexPolygon& hull, double cell_m,
                          double horizon_s) {
  check(drive);
  if (!(horizon_s > 0)) throw std::invalid_argument("the horizon of collision times has to be positive");
  const Hull outline(padded(hull, kCellPadding_m));
  CellTimes times{ObstacleGrid::covering(reachable_area(drive, outline.corners_m(), horizon_s), cell_m),
                  static_cast<float>(horizon_s),
                  {},
                  {}};
  times.times_s.assign(times.grid.size() * kSlots, times.horizon_s);
  times.touches_hull.assign(times.grid.size(), false);
  for_each_velocity({{0, kGridSide - 1}, {0, kGridSide - 1}}, [&](int row, int column, std::size_t slot) {
    const ArcMotion motion = drive.motion(drive.wheels(row, column));
    if (!drive.is_allowed(motion)) return;
    add_cell_corners(outline, motion, slot, times);
    CornerTrace trace(times, slot);
    for (const Vec2& corner : outline.corners_m()) trace.add(corner, motion);
  });
  for (int row = 0; row < times.grid.rows; ++row) {
    for (int column = 0; column < times.grid.columns; ++column)
      times.touches_hull[times.grid.index(column, row)] =
          overlap(times.grid.cell(column, row), outline.corners_m());
  }
  return times;
}

}  // namespace sidestep
