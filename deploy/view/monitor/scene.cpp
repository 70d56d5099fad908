// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/scene.hpp"

#include <nlohmann/json.hpp>
#include <variant>

#include "deploy/view/monitor/floor_frame.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

Json point(const Vec2& p) { return Json::array({p.x(), p.y()}); }

Json shape_json(const Shape& shape) {
  struct Visitor {
    Json operator()(const Circle& c) const {
      return {{"centre", point(c.centre_m)}, {"radius_m", c.radius_m}};
    }
    Json operator()(const Box& b) const {
      Json corners = Json::array();
      for (const Vec2& corner : corners_of(b)) corners.push_back(point(corner));
      return {{"corners", corners}};
    }
    Json operator()(const ConvexPolygon& p) const {
      Json corners = Json::array();
      for (const Vec2& corner : p.corners_m) corners.push_back(point(corner));
      return {{"corners", corners}};
    }
    Json operator()(const Segment& s) const { return {{"corners", {point(s.from_m), point(s.to_m)}}}; }
  };
  return std::visit(Visitor{}, shape);
}

Json map_json(const OccupancyMap& map) {
  const Box extent = map.extent();
  return {{"columns", map.blocked().columns()},
          {"rows", map.blocked().rows()},
          {"min", point(extent.min_m)},
          {"max", point(extent.max_m)}};
}

}  // namespace

Json scene_json(const Scenario* scenario) {
  const Scenario unknown;
  const Scenario& s = scenario ? *scenario : unknown;
  Json obstacles = Json::array(), robots = Json::array();
  for (const Shape& obstacle : s.obstacles) obstacles.push_back(shape_json(obstacle));
  for (const RobotSpec& robot : s.robots)
    robots.push_back({{"id", robot.id}, {"team", robot.team == Team::kBlue ? "blue" : "yellow"}});
  Json scene{{"name", s.name},
             {"is_known", scenario != nullptr},
             {"field", {{"length_m", s.field.length_m}, {"width_m", s.field.width_m}}},
             {"radius_m", s.radius_m},
             {"margin_m", s.margin_m},
             {"tracking_bound_m", s.tracking_bound_m},
             {"clock_bound_s", s.clock_bound_s},
             {"speed_mps", s.limits.speed_mps},
             {"opponent_speed_mps", s.max_opponent_speed_mps},
             {"cycle_s", to_seconds(s.cycle)},
             {"cameras", s.vision.images ? s.vision.columns * s.vision.rows : 0},
             {"obstacles", obstacles},
             {"robots", robots},
             {"layout", frame_layout()}};
  if (s.map) scene["map"] = map_json(s.map->cells());
  return scene;
}

std::string map_bits(const OccupancyMap& map) {
  const int columns = map.blocked().columns(), rows = map.blocked().rows();
  const auto row_bytes = (static_cast<std::size_t>(columns) + 7) / 8;
  std::string bits(row_bytes * static_cast<std::size_t>(rows), '\0');
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      if (map.blocked().get(column, row)) {
        char& byte = bits[static_cast<std::size_t>(row) * row_bytes + static_cast<std::size_t>(column) / 8];
        byte = static_cast<char>(byte | (1 << (column % 8)));
      }
  return bits;
}

}  // namespace sidestep
