// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_floor.hpp"

#include <fmt/format.h>

#include "common/config/obstacle_list.hpp"

namespace sidestep {
namespace {

constexpr Range kCoordinate_m{-1000, 1000};
constexpr Range kSpeed_mps{0.01, 20};
constexpr std::size_t kMaxObstacles = 1000;
constexpr std::size_t kMaxOpponents = 1000;
constexpr std::size_t kMaxWaypoints = 1000;

OpponentSpec read_opponent(YamlMap& map, double max_speed_mps) {
  OpponentSpec opponent;
  for (const char* key : {"radius_m", "speed_mps", "path_m"}) (void)map.require(key);
  map.read("radius_m", {0.01, 5}, opponent.radius_m);
  map.read("speed_mps", kSpeed_mps, opponent.speed_mps);
  opponent.path_m = map.points("path_m", 1, kMaxWaypoints, kCoordinate_m);
  map.finish();
  if (opponent.speed_mps > max_speed_mps) {
    map.location_of("speed_mps")
        .fail(fmt::format("expected at most max_opponent_speed_mps, {:g}, got {:g}", max_speed_mps,
                          opponent.speed_mps));
  }
  return opponent;
}

void read_opponents(YamlMap& map, Scenario& scenario) {
  map.read("max_opponent_speed_mps", kSpeed_mps, scenario.max_opponent_speed_mps);
  read_optional_list(map, "opponents", 0, kMaxOpponents, [&](YamlMap& opponent) {
    scenario.opponents.push_back(read_opponent(opponent, scenario.max_opponent_speed_mps));
  });
}

void read_ball(YamlMap& map, Scenario& scenario) {
  read_section(map, "ball", [&](YamlMap& inner) {
    BallSpec ball;
    inner.read("position_m", kCoordinate_m, ball.position_m);
    inner.read("velocity_mps", {-20, 20}, ball.velocity_mps);
    if (!scenario.field.contains(ball.position_m, 0)) {
      inner.location_of("position_m").fail("expected a position on the field");
    }
    scenario.ball = ball;
  });
}

}  // namespace

void read_floor(YamlMap& map, const OccupancyMap* cells, Scenario& scenario) {
  scenario.obstacles = read_obstacles(map, kMaxObstacles);
  scenario.map = read_floor_map(map, cells);
  read_opponents(map, scenario);
  read_ball(map, scenario);
}

}  // namespace sidestep
