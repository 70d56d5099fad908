// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/laser_sight.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sidestep {
namespace {

/// Minimum interval between scans that are added to the grid. Adding a scan takes most of the time, and
/// nothing appears on the floor that quickly.
constexpr Duration kGridPeriod{90'000'000};
constexpr double kUnknownRange_m = 2.5;  ///< squares farther away are ignored

double explained_within_m(const LaserSpec& laser, const FloorRules& rules, double position_error_m) {
  const double cell_m = rules.map ? rules.map->cells().grid().resolution_m : 0;
  return laser.range_error_m + position_error_m + cell_m;
}

VisibilitySettings visibility_settings(const LaserSpec& laser, const FloorRules& rules,
                                       const LaserSightSettings& settings) {
  const double clear_m = rules.margin_m - settings.position_error_m;
  return {laser.person_radius_m, laser.range_error_m, settings.position_error_m, settings.heading_error_rad,
          min_contact_distance_m(rules.radius_m, clear_m, laser.person_radius_m)};
}

}  // namespace

LaserSight::LaserSight(const LaserSpec& laser, const FloorRules& rules, const LaserSightSettings& settings)
    : settings_(settings),
      explained_within_m_(explained_within_m(laser, rules, settings.position_error_m)),
      shapes_(rules.obstacles),
      prior_map_{rules.map ? &rules.map->cells() : nullptr, rules.obstacles.empty() ? nullptr : &shapes_},
      beams_(laser.settings),
      visibility_(visibility_settings(laser, rules, settings)) {
  unknown_.reserve(settings.max_unknown);
}

bool LaserSight::update(const LaserScan& scan, std::span<const Circle> robots) {
  if (scan.captured_at <= captured_at_) return false;
  captured_at_ = scan.captured_at;
  beams_.read(scan, robots);
  tracks_.update(beams_, grid_, prior_map_);
  const bool is_grid_due = captured_at_ - grid_.updated_at() >= kGridPeriod;
  if (is_grid_due) grid_.update(beams_);
  visibility_.update(beams_,
                     [&](const Vec2& p, double within_m) { return prior_map_.nearest_m(p, within_m); });
  if (is_grid_due) find_unknown();
  return true;
}

void LaserSight::forget() {
  captured_at_ = {};
  grid_ = LocalGrid();
  tracks_ = LaserTracks();
  unknown_.clear();
}

void LaserSight::find_unknown() {
  squares_.clear();
  unknown_.clear();
  const Vec2& at = beams_.at_m();
  grid_.for_each_occupied(inflated({at, at}, kUnknownRange_m), [&](const Cell& cell) {
    if (grid_.occupied_for(cell) < kUnknownAfter) return;
    const Box box = grid_.box_of(cell);
    const Vec2 centre = (box.min_m + box.max_m) / 2;
    if (prior_map_.is_near(centre, explained_within_m_)) return;
    squares_.push_back({static_cast<int>(std::floor(centre.x() / kUnknownCell_m)),
                        static_cast<int>(std::floor(centre.y() / kUnknownCell_m))});
  });
  const auto centre_of = [&](const Cell& square) {
    return Vec2((square.column + 0.5) * kUnknownCell_m, (square.row + 0.5) * kUnknownCell_m);
  };
  const auto key = [&](const Cell& square) {
    return std::tuple((centre_of(square) - at).squaredNorm(), square.column, square.row);
  };
  std::ranges::sort(squares_, {}, key);
  squares_.erase(std::ranges::unique(squares_).begin(), squares_.end());
  if (squares_.size() > settings_.max_unknown) squares_.resize(settings_.max_unknown);
  for (const Cell& square : squares_)
    unknown_.push_back({centre_of(square), kUnknownCell_m / std::sqrt(2.0)});
}

}  // namespace sidestep
