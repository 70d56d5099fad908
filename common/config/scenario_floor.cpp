// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_floor.hpp"

#include <fmt/format.h>

#include "idl/vision.h"

namespace sidestep {
namespace {

constexpr Range kPlace_m{-1000, 1000};
constexpr Range kSpeed_mps{0.01, 20};
constexpr std::size_t kMaxObstacles = 1000;
constexpr std::size_t kMaxWayPoints = 1000;

void read_obstacles(YamlMap& map, Scenario& scenario) {
  const YAML::Node node = map.find("obstacles");
  if (!node.IsDefined()) return;
  for (const YAML::Node& element : list_from(node, map.place_of("obstacles"), kMaxObstacles)) {
    YamlMap inner(
        element,
        map.place_of("obstacles").of(element, fmt::format("obstacles[{}]", scenario.obstacles.size())));
    Circle circle;
    inner.require("centre_m");
    inner.require("radius_m");
    inner.read("centre_m", kPlace_m, circle.centre_m);
    inner.read("radius_m", {0.001, 1000}, circle.radius_m);
    inner.finish();
    scenario.obstacles.push_back(circle);
  }
}

OpponentSpec read_opponent(YamlMap& map, double bound_mps) {
  OpponentSpec opponent;
  map.require("radius_m");
  map.require("speed_mps");
  map.read("radius_m", {0.01, 5}, opponent.radius_m);
  map.read("speed_mps", kSpeed_mps, opponent.speed_mps);
  const YamlPlace way = map.place_of("path_m");
  for (const YAML::Node& point : list_from(map.require("path_m"), way, kMaxWayPoints)) {
    const auto numbers = numbers_from(point, way.of(point, way.what), 2, 2, kPlace_m);
    opponent.path_m.emplace_back(numbers[0], numbers[1]);
  }
  if (opponent.path_m.empty()) way.refuse("expected at least one point");
  map.finish();
  if (opponent.speed_mps > bound_mps) {
    map.place_of("speed_mps")
        .refuse(fmt::format("expected at most opponent_speed_mps, {:g}, got {:g}", bound_mps,
                            opponent.speed_mps));
  }
  return opponent;
}

void read_opponents(YamlMap& map, Scenario& scenario) {
  map.read("opponent_speed_mps", kSpeed_mps, scenario.opponent_speed_mps);
  const YAML::Node node = map.find("opponents");
  if (!node.IsDefined()) return;
  const YamlPlace place = map.place_of("opponents");
  // As many as a message about what cameras see has room for.
  for (const YAML::Node& element : list_from(node, place, msg::MAX_OBSTACLES)) {
    YamlMap inner(element, place.of(element, fmt::format("opponents[{}]", scenario.opponents.size())));
    scenario.opponents.push_back(read_opponent(inner, scenario.opponent_speed_mps));
  }
}

void read_ball(YamlMap& map, Scenario& scenario) {
  read_section(map, "ball", [&](YamlMap& inner) {
    BallSpec ball;
    inner.read("position_m", kPlace_m, ball.position_m);
    inner.read("velocity_mps", {-20, 20}, ball.velocity_mps);
    if (!scenario.field.contains(ball.position_m, 0)) {
      inner.place_of("position_m").refuse("the ball is outside the field, expected inside");
    }
    scenario.ball = ball;
  });
}

}  // namespace

void read_floor(YamlMap& map, Scenario& scenario) {
  read_obstacles(map, scenario);
  read_opponents(map, scenario);
  read_ball(map, scenario);
}

}  // namespace sidestep
