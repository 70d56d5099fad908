// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/planning/world_file.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>

#include "common/config/yaml_document.hpp"
#include "common/config/yaml_map.hpp"

namespace sidestep {
namespace {

constexpr const char* kExpected = "a world";
constexpr Range kCoordinate_m{-1000, 1000}, kSize_m{0.001, 1000};
constexpr std::size_t kMaxObstacles = 100'000, kMaxCorners = 1000, kMaxQueries = 100'000;

Vec2 point(YamlMap& map, const std::string& key) {
  Vec2 value(0, 0);
  map.require(key);
  map.read(key, kCoordinate_m, value);
  return value;
}

Circle read_circle(YamlMap& map) {
  Circle circle{point(map, "centre_m"), 0};
  map.require("radius_m");
  map.read("radius_m", kSize_m, circle.radius_m);
  return circle;
}

ConvexPolygon read_polygon(YamlMap& map) {
  ConvexPolygon polygon;
  const YamlLocation location = map.location_of("corners_m");
  for (const YAML::Node& corner : list_from(map.require("corners_m"), location, kMaxCorners)) {
    const auto numbers = numbers_from(corner, location.of(corner, location.what), 2, 2, kCoordinate_m);
    polygon.corners_m.emplace_back(numbers[0], numbers[1]);
  }
  return polygon;
}

Shape read_shape(YamlMap& map) {
  std::optional<Shape> shape;
  read_section(map, "circle", [&](YamlMap& inner) { shape = read_circle(inner); });
  read_section(map, "box", [&](YamlMap& inner) {
    shape = Box{point(inner, "min_m"), point(inner, "max_m")};
  });
  read_section(map, "polygon", [&](YamlMap& inner) { shape = read_polygon(inner); });
  read_section(map, "segment", [&](YamlMap& inner) {
    shape = Segment{point(inner, "from_m"), point(inner, "to_m")};
  });
  map.finish();
  if (!shape) map.location().fail("expected one of circle, box, polygon, segment");
  try {
    check(*shape);
  } catch (const std::invalid_argument& wrong) {
    map.location().fail(wrong.what());
  }
  return *shape;
}

void read_obstacles(YamlMap& map, PlanWorld& world) {
  const YAML::Node node = map.find("obstacles");
  if (!node.IsDefined()) return;
  const YamlLocation location = map.location_of("obstacles");
  for (const YAML::Node& element : list_from(node, location, kMaxObstacles)) {
    YamlMap inner(element, location.of(element, fmt::format("obstacles[{}]", world.obstacles.size())));
    world.obstacles.push_back(read_shape(inner));
  }
}

void read_queries(YamlMap& map, PlanWorld& world) {
  const YamlLocation location = map.location_of("queries");
  for (const YAML::Node& element : list_from(map.require("queries"), location, kMaxQueries)) {
    YamlMap inner(element, location.of(element, fmt::format("queries[{}]", world.queries.size())));
    world.queries.push_back({point(inner, "start_m"), point(inner, "goal_m")});
    inner.finish();
  }
  if (world.queries.empty()) location.fail("expected at least one query");
}

std::string text_of(const Vec2& p) { return fmt::format("[{}, {}]", p.x(), p.y()); }
std::string text_of(const Circle& circle) {
  return fmt::format("circle: {{centre_m: {}, radius_m: {}}}", text_of(circle.centre_m), circle.radius_m);
}
std::string text_of(const Box& box) {
  return fmt::format("box: {{min_m: {}, max_m: {}}}", text_of(box.min_m), text_of(box.max_m));
}
std::string text_of(const Segment& segment) {
  return fmt::format("segment: {{from_m: {}, to_m: {}}}", text_of(segment.from_m), text_of(segment.to_m));
}
std::string text_of(const ConvexPolygon& polygon) {
  std::string corners;
  for (const Vec2& corner : polygon.corners_m) corners += (corners.empty() ? "" : ", ") + text_of(corner);
  return fmt::format("polygon: {{corners_m: [{}]}}", corners);
}

}  // namespace

PlanWorld load_plan_world(const std::string& path) {
  return parse_plan_world(read_yaml_file(path, kExpected), path);
}

PlanWorld parse_plan_world(const std::string& text, const std::string& file_name) {
  YamlMap map(parse_yaml(text, file_name, kExpected), {file_name, 1, ""});
  PlanWorld world;
  const YAML::Node name = map.find("name");
  world.name = name.IsDefined() ? text_from(name, map.location_of("name"))
                                : std::filesystem::path(file_name).stem().string();
  read_section(map, "field", [&](YamlMap& field) {
    field.read("length_m", {0.5, 1000}, world.field.length_m);
    field.read("width_m", {0.5, 1000}, world.field.width_m);
  });
  map.read("radius_m", {0.001, 5}, world.radius_m);
  read_obstacles(map, world);
  read_queries(map, world);
  map.finish();
  return world;
}

std::string plan_world_text(const PlanWorld& world) {
  std::string text = fmt::format(
      "# SPDX-License-Identifier: Apache-2.0\nname: {}\nfield: {{length_m: {}, width_m: {}}}\nradius_m: {}\n",
      world.name, world.field.length_m, world.field.width_m, world.radius_m);
  if (!world.obstacles.empty()) text += "obstacles:\n";
  for (const Shape& shape : world.obstacles)
    text += fmt::format("  - {}\n", std::visit([](const auto& s) { return text_of(s); }, shape));
  text += "queries:\n";
  for (const PlanQuery& query : world.queries)
    text += fmt::format("  - {{start_m: {}, goal_m: {}}}\n", text_of(query.start_m), text_of(query.goal_m));
  return text;
}

}  // namespace sidestep
