// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/fields/robot_fields.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "agents/navigation/bubble_band/bubble_band.hpp"
#include "agents/navigation/free_space.hpp"
#include "agents/planning/grids/navigation/blocked_cells.hpp"
#include "agents/planning/grids/navigation/descent.hpp"
#include "agents/planning/grids/navigation/estar.hpp"
#include "common/map/floor_map.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kFinestCell_m = 0.05, kCellsAcross = 200;
/// Scans are added until this long after the last request.
constexpr Duration kPatience = std::chrono::seconds(5);

Json point(const Vec2& p) { return {std::round(p.x() * 1e3) / 1e3, std::round(p.y() * 1e3) / 1e3}; }

GridLayout layout_of(const Scenario& scenario) {
  Box extent{{-scenario.field.length_m / 2, -scenario.field.width_m / 2},
             {scenario.field.length_m / 2, scenario.field.width_m / 2}};
  if (scenario.map) extent = scenario.map->cells().extent();
  const Vec2 size = extent.max_m - extent.min_m;
  const double cell_m = std::max(kFinestCell_m, size.maxCoeff() / kCellsAcross);
  return {static_cast<std::uint32_t>(std::ceil(size.x() / cell_m)),
          static_cast<std::uint32_t>(std::ceil(size.y() / cell_m)), cell_m, extent.min_m};
}

CostGrid fixed_costs(const Scenario& scenario) {
  CostGrid grid(layout_of(scenario));
  for (const Shape& obstacle : scenario.obstacles) block_shape(grid, obstacle, scenario.radius_m);
  const double reach_m = scenario.radius_m + grid.layout().resolution_m * std::numbers::sqrt2 / 2;
  for (GridCell cell = 0; cell < grid.layout().size(); ++cell) {
    const Vec2 centre = grid.layout().centre_of(cell);
    if (scenario.map && scenario.map->cells().distance_m(centre, reach_m) < reach_m) grid.block(cell);
    if (!scenario.field.contains(centre, scenario.radius_m)) grid.block(cell);
  }
  return grid;
}

Json grid_json(const Vec2& min_m, double cell_m, std::size_t columns, std::size_t rows) {
  return {{"min", point(min_m)}, {"cell_m", cell_m}, {"columns", columns}, {"rows", rows}};
}

Json navigation_json(const EStar& field) {
  const GridLayout& layout = field.layout();
  float most = 0;
  for (GridCell cell = 0; cell < layout.size(); ++cell)
    if (std::isfinite(field.value(cell))) most = std::max(most, field.value(cell));
  Json values = Json::array();
  for (GridCell cell = 0; cell < layout.size(); ++cell) {
    const float value = field.value(cell);
    values.push_back(std::isfinite(value) ? 1 + static_cast<int>(254 * value / std::max(most, 1.0F)) : 0);
  }
  Json json = grid_json(layout.origin_m, layout.resolution_m, layout.columns, layout.rows);
  json["values"] = values;
  return json;
}

Json local_json(const LocalGrid& grid, const Vec2& centre_m) {
  const int side = grid.side_cells();
  const Cell centre = grid.cell_at(centre_m);
  const Cell first{centre.column - side / 2, centre.row - side / 2};
  Json values = Json::array();
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      values.push_back(static_cast<int>(grid.state({first.column + column, first.row + row})));
  Json json = grid_json(grid.box_of(first).min_m, LocalGrid::kResolution_m, static_cast<std::size_t>(side),
                        static_cast<std::size_t>(side));
  json["values"] = values;
  return json;
}

Json band_json(const std::vector<Vec2>& path, double radius_m, const std::vector<Shape>& obstacles,
               const FloorMap* map) {
  constexpr double kFar_m = 3;
  const DistanceFunction free([&obstacles, map](const Vec2& at) {
    double nearest_m = map ? map->cells().distance_m(at, kFar_m) : kFar_m;
    for (const Shape& shape : obstacles) nearest_m = std::min(nearest_m, signed_distance(at, shape));
    return nearest_m;
  });
  BubbleBand band(radius_m);
  band.start(path, free);
  for (int i = 0; i < 20 && !band.is_broken(); ++i) band.update(path.front(), free);
  Json bubbles = Json::array();
  for (const Bubble& bubble : band.bubbles())
    bubbles.push_back({bubble.centre_m.x(), bubble.centre_m.y(), bubble.radius_m});
  return bubbles;
}

std::vector<Circle> moving_obstacles(const FloorState& floor, Time now) {
  std::vector<Circle> circles;
  if (const msg::ObstacleList* list = fresh(floor.obstacles(), now))
    for (const msg::TrackedObstacle& o : list->obstacles())
      if (std::isfinite(o.x_m() + o.y_m()) && o.radius_m() > 0 && o.radius_m() < 100)
        circles.push_back({{o.x_m(), o.y_m()}, o.radius_m()});
  return circles;
}

std::optional<Vec2> position_of(const RobotView& robot, Time now) {
  const msg::Feedback* feedback = fresh(robot.feedback, now);
  if (feedback == nullptr || !std::isfinite(feedback->x_m() + feedback->y_m())) return std::nullopt;
  return Vec2(feedback->x_m(), feedback->y_m());
}

std::optional<Vec2> goal_of(const RobotView& robot, Time now) {
  const msg::Version* granted = fresh(robot.granted, now);
  if (granted == nullptr || !granted->has_intent()) return std::nullopt;
  const Vec2 goal(granted->intent().target_x_m(), granted->intent().target_y_m());
  return goal.allFinite() ? std::optional(goal) : std::nullopt;
}

}  // namespace

RobotFields::RobotFields(const Scenario& scenario) : scenario_(scenario), fixed_(fixed_costs(scenario)) {}

CostGrid RobotFields::costs_with_moving_obstacles(const FloorState& floor, Time now) const {
  CostGrid grid = fixed_;
  for (const Circle& circle : moving_obstacles(floor, now)) block_shape(grid, circle, scenario_.radius_m);
  return grid;
}

void RobotFields::on(const msg::LaserScan& scan, const FloorState& floor, Time now) {
  const auto local = locals_.find(scan.robot());
  if (local == locals_.end() || !scenario_.laser) return;
  if (now - local->second.asked_at > kPatience) {
    locals_.erase(local);
    return;
  }
  LaserBeams beams(scenario_.laser->settings);
  if (static_cast<std::size_t>(beams.settings().beams) != scan.ranges_m().size()) return;
  std::vector<Circle> robots;
  for (const auto& [id, robot] : floor.robots())
    if (id != scan.robot())
      if (const auto at = position_of(robot, now)) robots.push_back({*at, scenario_.radius_m});
  try {
    beams.read({{scan.x_m(), scan.y_m()}, scan.heading_rad(), now, scan.ranges_m()}, robots);
    (void)local->second.grid.update(beams);
  } catch (const std::invalid_argument&) {
    // The scan has an invalid pose.
  }
}

Json RobotFields::json(RobotId id, const FloorState& floor, Time now) {
  Json json = Json::object();
  const auto robot = floor.robots().find(id);
  const auto at = robot == floor.robots().end() ? std::nullopt : position_of(robot->second, now);
  if (!at) return json;
  if (scenario_.laser) {
    Local& local = locals_[id];
    local.asked_at = now;
    json["local"] = local_json(local.grid, *at);
  }
  const std::optional<Vec2> goal = goal_of(robot->second, now);
  if (!goal || !fixed_.layout().cell_at(*goal)) return json;
  EStar field(costs_with_moving_obstacles(floor, now));
  field.set_goal(*goal);
  field.propagate();
  json["navigation"] = navigation_json(field);
  std::vector<Vec2> path;
  if (!trace(field, *at, path)) return json;
  for (const Vec2& p : path) json["path"].push_back(point(p));
  std::vector<Shape> obstacles = scenario_.obstacles;
  for (const Circle& circle : moving_obstacles(floor, now)) obstacles.emplace_back(circle);
  json["band"] = band_json(path, scenario_.radius_m, obstacles, scenario_.map.get());
  return json;
}

}  // namespace sidestep
