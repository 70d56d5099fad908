// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/planning/world_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>

#include "common/config/obstacle_list.hpp"
#include "common/yaml/yaml_document.hpp"
#include "common/yaml/yaml_map.hpp"

namespace sidestep {
namespace {

constexpr const char* kExpected = "a world";
constexpr Range kCoordinate_m{-1000, 1000};
constexpr std::size_t kMaxObstacles = 100'000, kMaxQueries = 100'000;

/// Reads a position at which the robot's whole disc is on the field.
Vec2 place_m(YamlMap& map, const std::string& key, const PlanWorld& world) {
  constexpr double kRounding_m = 1e-9;
  Vec2 value(0, 0);
  map.require(key);
  map.read(key, kCoordinate_m, value);
  if (!world.field.contains(value, world.radius_m - kRounding_m))
    map.location_of(key).fail(
        fmt::format("expected |x| <= {:g} and |y| <= {:g}, so that the robot is on the field",
                    world.field.length_m / 2 - world.radius_m, world.field.width_m / 2 - world.radius_m));
  return value;
}

void read_queries(YamlMap& map, PlanWorld& world) {
  const YamlLocation location = map.location_of("queries");
  for (const YAML::Node& element : list_from(map.require("queries"), location, kMaxQueries)) {
    YamlMap inner(element, location.of(element, fmt::format("queries[{}]", world.queries.size())));
    world.queries.push_back({place_m(inner, "start_m", world), place_m(inner, "goal_m", world)});
    inner.finish();
  }
  if (world.queries.empty()) location.fail("expected at least one query");
}

std::string text_of(const Vec2& p) { return fmt::format("[{}, {}]", p.x(), p.y()); }
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
  world.obstacles = read_obstacles(map, kMaxObstacles);
  if (const auto floor = read_floor_map(map))
    std::ranges::copy(floor->boxes_on(world.field), std::back_inserter(world.obstacles));
  read_queries(map, world);
  map.finish();
  return world;
}

std::string plan_world_text(const PlanWorld& world) {
  std::string text = fmt::format(
      "# SPDX-License-Identifier: Apache-2.0\nname: {}\nfield: {{length_m: {}, width_m: {}}}\nradius_m: {}\n",
      world.name, world.field.length_m, world.field.width_m, world.radius_m);
  if (!world.obstacles.empty()) text += "obstacles:\n";
  for (const Shape& shape : world.obstacles) text += fmt::format("  - {}\n", obstacle_text(shape));
  text += "queries:\n";
  for (const PlanQuery& query : world.queries)
    text += fmt::format("  - {{start_m: {}, goal_m: {}}}\n", text_of(query.start_m), text_of(query.goal_m));
  return text;
}

}  // namespace sidestep
