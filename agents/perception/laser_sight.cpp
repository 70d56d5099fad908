// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/laser_sight.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sidestep {
namespace {

/// How near to what the rules know a hit belongs to it. Never so far that the front of somebody who leans
/// against a wall, or both sides of a gap that the smallest person passes, would count as the wall.
double explained_within_m(const LaserSpec& laser, const FloorRules& rules, double pose_error_m) {
  const double error_m = laser.range_error_m + pose_error_m;
  const double cell_m = rules.map ? rules.map->cells().grid().resolution_m : 0;
  const double front_m = 2 * laser.person_radius_m - error_m;
  return std::max(0.0, std::min({error_m + cell_m, laser.person_radius_m, front_m}));
}

}  // namespace

LaserSight::LaserSight(const LaserSpec& laser, const FloorRules& rules, const LaserSightSettings& settings)
    : settings_(settings),
      explained_within_m_(explained_within_m(laser, rules, settings.pose_error_m)),
      shapes_(rules.obstacles),
      floor_{rules.map ? &rules.map->cells() : nullptr, rules.obstacles.empty() ? nullptr : &shapes_},
      beams_(laser.settings),
      visibility_({laser.person_radius_m, laser.range_error_m}) {
  is_fixed_.resize(static_cast<std::size_t>(laser.settings.beams));
  unknown_.reserve(settings.max_unknown);
}

bool LaserSight::update(const LaserScan& scan, std::span<const Circle> robots) {
  if (scan.captured_at <= captured_at_) return false;
  captured_at_ = scan.captured_at;
  beams_.read(scan, robots);
  tracks_.update(beams_, grid_, floor_);
  const bool is_grid_due = captured_at_ - grid_.updated_at() >= settings_.grid_period;
  if (is_grid_due) grid_.update(beams_);
  for (int beam = 0; beam < beams_.count(); ++beam) {
    // What is near a robot may be the wall behind it.
    is_fixed_[static_cast<std::size_t>(beam)] =
        floor_.is_near(beams_.end_m(beams_[beam]), explained_within_m_);
  }
  visibility_.update(beams_, [&](int beam) { return is_fixed_[static_cast<std::size_t>(beam)] != 0; });
  if (is_grid_due) find_unknown();
  return true;
}

void LaserSight::find_unknown() {
  const double side_m = settings_.unknown_cell_m, range_m = settings_.unknown_range_m;
  squares_.clear();
  unknown_.clear();
  const Vec2& at = beams_.at_m();
  grid_.for_each_occupied(inflated({at, at}, range_m), [&](const Cell& cell) {
    if (grid_.occupied_for(cell) < settings_.unknown_after) return;
    const Box box = grid_.box_of(cell);
    const Vec2 centre = (box.min_m + box.max_m) / 2;
    if (floor_.is_near(centre, explained_within_m_)) return;
    squares_.push_back({static_cast<int>(std::floor(centre.x() / side_m)),
                        static_cast<int>(std::floor(centre.y() / side_m))});
  });
  const auto centre_of = [&](const Cell& square) {
    return Vec2((square.column + 0.5) * side_m, (square.row + 0.5) * side_m);
  };
  const auto key = [&](const Cell& square) {
    return std::tuple((centre_of(square) - at).squaredNorm(), square.column, square.row);
  };
  std::ranges::sort(squares_, {}, key);
  squares_.erase(std::ranges::unique(squares_).begin(), squares_.end());
  if (squares_.size() > settings_.max_unknown) squares_.resize(settings_.max_unknown);
  for (const Cell& square : squares_) unknown_.push_back({centre_of(square), side_m / std::sqrt(2.0)});
}

}  // namespace sidestep
