// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_loader.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/unit/common/config/scenario_errors.hpp"

namespace sidestep::scenario_loader_test {

const std::string kScenarios = SIDESTEP_SOURCE_DIR "/deploy/scenarios/";

TEST_CASE("every shipped scenario loads") {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenarios)) {
    if (entry.path().extension() != ".yaml") continue;
    CAPTURE(entry.path());
    const Scenario scenario = load_scenario(entry.path().string());
    CHECK(scenario.name == entry.path().stem());
    CHECK_FALSE(scenario.robots.empty());
    ++count;
  }
  CHECK(count >= 5);
}

TEST_CASE("the shipped scenarios have the numbers of robots and the noise that their names state") {
  CHECK(load_scenario(kScenarios + "crossing.yaml").robots.size() == 8);
  CHECK(load_scenario(kScenarios + "crossing.yaml").obstacles.size() == 4);
  CHECK(load_scenario(kScenarios + "two-teams-22.yaml").robots.size() == 22);
  CHECK(load_scenario(kScenarios + "two-teams-22.yaml").field.length_m == 12);
  const Scenario noisy = load_scenario(kScenarios + "crossing-noisy.yaml");
  CHECK(noisy.vision.position_noise_m == 0.0015);
  CHECK(noisy.vision.delay == std::chrono::milliseconds(35));
  CHECK(noisy.vision.miss_probability == 0.02);
  CHECK(noisy.command_loss == 0.03);
}

TEST_CASE("robots in a circle are evenly spaced and their goals lie opposite their starts") {
  const Scenario scenario = load_scenario(kScenarios + "circle-100.yaml");
  const auto& robots = scenario.robots;
  REQUIRE(robots.size() == 100);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const RobotSpec& next = robots[(i + 1) % robots.size()];
    CHECK((robots[i].start_m - next.start_m).norm() == Approx(0.4));
    CHECK((robots[i].goals.back().position_m + robots[i].start_m).norm() == Approx(0).margin(1e-9));
    CHECK(robots[i].team != next.team);
  }
}

TEST_CASE("robots in a disc fill a lattice, and their goals lie opposite their starts") {
  const int count = GENERATE(2, 3, 32, 100, 1000);
  CAPTURE(count);
  const Scenario scenario =
      parse_scenario("field: {length_m: 40, width_m: 40}\ndisc: {count: " + std::to_string(count) +
                         ", spacing_m: 0.42, centre_m: [1, 2]}\n",
                     "disc.yaml");
  const auto& robots = scenario.robots;
  REQUIRE(robots.size() == static_cast<std::size_t>(count));
  double farthest_m = 0;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const Vec2 from_centre_m = robots[i].start_m - Vec2(1, 2);
    farthest_m = std::max(farthest_m, from_centre_m.norm());
    CHECK((robots[i].goals.back().position_m + robots[i].start_m - Vec2(2, 4)).norm() < 1e-9);
    double nearest_m = 1e9;
    for (std::size_t j = 0; j < robots.size(); ++j)
      if (i != j) nearest_m = std::min(nearest_m, (robots[i].start_m - robots[j].start_m).norm());
    if (nearest_m != Approx(0.42)) FAIL("robot " << i << " is " << nearest_m << " m from its neighbour");
  }
  // A point of the lattice has an area of spacing² · √3 / 2.
  CHECK(farthest_m < std::sqrt(count * 0.42 * 0.42 * std::sqrt(0.75) / std::numbers::pi) + 0.42);
}

TEST_CASE("streams give each robot its own cell and a path across the given number of lanes") {
  const Scenario scenario = load_scenario(kScenarios + "streams-1000.yaml");
  const auto& robots = scenario.robots;
  REQUIRE(robots.size() == 1000);
  std::map<std::pair<int, int>, int> directions;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if ((robots[i].start_m - robots[j].start_m).norm() < 0.8366) FAIL("starts of " << i << " and " << j);
    }
    const Vec2 displacement = robots[i].goals.back().position_m - robots[i].start_m;
    CHECK(displacement.norm() == Approx(12 * 0.83666));
    ++directions[{static_cast<int>(std::lround(displacement.x())),
                  static_cast<int>(std::lround(displacement.y()))}];
  }
  REQUIRE(directions.size() == 4);
  for (const auto& [direction, count] : directions) CHECK(count > 200);
}

TEST_CASE("a number of any type may have one leading plus") {
  const Scenario s = parse_scenario(
      "robots: [{id: +7, start_m: [+1, -2], heading_rad: +.5, goals_m: [[+1.5, +1e-1, +3]]}]\n"
      "margin_m: +0.02\n",
      "file.yaml");
  CHECK(s.margin_m == 0.02);
  REQUIRE(s.robots.size() == 1);
  CHECK(s.robots[0].id == 7);
  CHECK(s.robots[0].start_m == Vec2(1, -2));
  CHECK(s.robots[0].start_heading_rad == 0.5);
  REQUIRE(s.robots[0].goals.size() == 1);
  CHECK(s.robots[0].goals[0].position_m == Vec2(1.5, 0.1));
  CHECK(s.robots[0].goals[0].heading_rad == 3);
}

TEST_CASE("every scenario key is read and converted from its unit") {
  const Scenario s = parse_scenario(R"(name: all-keys
field: {length_m: 12, width_m: 9}
limits: {acceleration_mps2: 2.5, deceleration_mps2: 4, speed_mps: 1.5}
radius_m: 0.08
margin_m: 0.02
tracking_bound_m: 0.004
clock_bound_s: 0.001
control_rate_hz: 50
goal_tolerance_m: 0.03
time_limit_s: 12.5
vision: {images: {format: rgb, width_px: 1001, height_px: 400, camera_height_m: 3.5, distortion: 0.2}, rate_hz: 30, columns: 4, rows: 3, overlap_m: 0.25, position_noise_m: 0.002, heading_noise_rad: 0.01,
         delay_ms: 12.5, miss_probability: 0.1, ghost_probability: 0.2, ghost_obstacle_probability: 0.3, league_interfaces: all}
odometry: {scale_error: 0.01, velocity_noise_mps: 0.02}
laser: {beams: 270, field_of_view_rad: 4.5, min_range_m: 0.1, max_range_m: 25, rate_hz: 40, range_error_m: 0.02, dropout_probability: 0.05, person_radius_m: 0.2}
command_loss: 0.25
network: {loss: 0.3, duplicate: 0.1, delay_min_ms: 0, delay_max_ms: 150}
restart: [agents, vision]
coordinators: 3
planner: errt
ball: {position_m: [1, 2], velocity_mps: [-1, 0.5]}
obstacles: [{centre_m: [3, 3], radius_m: 0.5}]
opponents:
  - {radius_m: 0.3, speed_mps: 0.75, path_m: [[4, 1], [4, -1], [3, -1]]}
  - {radius_m: 0.2, speed_mps: 2.5, path_m: [[-4, 0]]}
max_opponent_speed_mps: 2.5
robots:
  - {id: 7, team: yellow, start_m: [1, -2], heading_rad: 1.5, clock_offset_ms: -1.25, absent: true, planner: grid-a-star, goals_m: [[2, 2], [-2, 2, -0.5]]}
  - {id: 3, start_m: [0, 0], goals_m: [[1, 1]]}
)",
                                    "x.yaml");
  CHECK(s.name == "all-keys");
  CHECK(s.field.length_m == 12);
  CHECK(s.field.width_m == 9);
  CHECK(s.limits.acceleration_mps2 == 2.5);
  CHECK(s.limits.deceleration_mps2 == 4);
  CHECK(s.limits.speed_mps == 1.5);
  CHECK(s.radius_m == 0.08);
  CHECK(s.margin_m == 0.02);
  CHECK(s.tracking_bound_m == 0.004);
  CHECK(s.clock_bound_s == 0.001);
  CHECK(s.cycle == std::chrono::milliseconds(20));
  CHECK(s.goal_tolerance_m == 0.03);
  CHECK(s.time_limit_s == 12.5);
  CHECK(s.vision.rate_hz == 30);
  CHECK(s.vision.columns == 4);
  CHECK(s.vision.rows == 3);
  CHECK(s.vision.overlap_m == 0.25);
  CHECK(s.vision.has_league_everywhere);
  CHECK(s.vision.position_noise_m == 0.002);
  CHECK(s.vision.heading_noise_rad == 0.01);
  CHECK(s.vision.delay == std::chrono::microseconds(12500));
  CHECK(s.vision.miss_probability == 0.1);
  CHECK(s.vision.ghost_probability == 0.2);
  CHECK(s.vision.ghost_obstacle_probability == 0.3);
  REQUIRE(s.vision.images);
  CHECK(s.vision.images->format == PixelFormat::kRgb);
  CHECK(s.vision.images->width_px == 1001);
  CHECK(s.vision.images->height_px == 400);
  CHECK(s.vision.images->camera_height_m == 3.5);
  CHECK(s.vision.images->distortion == 0.2);
  REQUIRE(s.laser);
  CHECK(s.laser->settings.beams == 270);
  CHECK(s.laser->settings.field_of_view_rad == 4.5);
  CHECK(s.laser->settings.min_range_m == 0.1);
  CHECK(s.laser->settings.max_range_m == 25);
  CHECK(s.laser->rate_hz == 40);
  CHECK(s.laser->range_error_m == 0.02);
  CHECK(s.laser->dropout_probability == 0.05);
  CHECK(s.laser->person_radius_m == 0.2);
  CHECK(s.odometry.scale_error == 0.01);
  CHECK(s.odometry.velocity_noise_mps == 0.02);
  CHECK(s.command_loss == 0.25);
  CHECK(s.network.loss == 0.3);
  CHECK(s.network.duplicate == 0.1);
  CHECK(s.network.delay_min == Duration{0});
  CHECK(s.network.delay_max == std::chrono::milliseconds(150));
  CHECK(s.coordinators == 3);
  CHECK(s.planner == "errt");
  CHECK((s.restart.agents && s.restart.vision && !s.restart.coordinator));
  REQUIRE(s.ball);
  CHECK(s.ball->velocity_mps == Vec2(-1, 0.5));
  REQUIRE(s.obstacles.size() == 1);
  CHECK(std::get<Circle>(s.obstacles[0]).radius_m == 0.5);
  CHECK(s.max_opponent_speed_mps == 2.5);
  REQUIRE(s.opponents.size() == 2);
  CHECK(s.opponents[0].radius_m == 0.3);
  CHECK(s.opponents[0].speed_mps == 0.75);
  CHECK(s.opponents[0].path_m == std::vector<Vec2>{{4, 1}, {4, -1}, {3, -1}});
  REQUIRE(s.robots.size() == 2);
  CHECK(s.robots[0].id == 3);
  CHECK_FALSE(s.robots[0].is_absent);
  CHECK(s.robots[1].is_absent);
  CHECK(s.robots[0].planner.empty());
  CHECK(s.robots[1].planner == "grid-a-star");
  CHECK(s.robots[1].clock_offset == -std::chrono::microseconds(1250));
  const RobotSpec* seven = find_robot(s, 7);
  REQUIRE(seven != nullptr);
  CHECK(seven->team == Team::kYellow);
  CHECK(seven->start_heading_rad == 1.5);
  CHECK(seven->goals[1].position_m == Vec2(-2, 2));
  CHECK(seven->goals[1].heading_rad == -0.5);
  CHECK_FALSE(seven->goals[0].heading_rad);
  CHECK(find_robot(s, 5) == nullptr);
  CHECK(find_robot(s, 8) == nullptr);
}

TEST_CASE("a scenario without a name is named after its file, whose name may be in any language") {
  const auto [file, name] = GENERATE(table<std::string, std::string>({
      {"dir/lone.yaml", "lone"},
      {"dir/\xe4\xba\xa4\xe5\xb7\xae-\xc3\xa4.yaml", "\xe4\xba\xa4\xe5\xb7\xae-\xc3\xa4"},
      {"hall 2 (old).yaml", "hall_2__old_"},
      {".hidden.yaml", "_hidden"},
      {"a\xff\x1b[K\xc2\x9b.yaml", "a___K_"},
      {std::string(80, 'x') + ".yaml", std::string(64, 'x')},
      {"", "scenario"},
  }));
  CAPTURE(file);
  CHECK(parse_scenario(kRobot, file).name == name);
  CHECK(parse_scenario("name: " + name + "\n" + kRobot, "other.yaml").name == name);
}

TEST_CASE("missing keys keep their defaults") {
  const Scenario given = parse_scenario(kRobot, "dir/lone.yaml"), defaults;
  CHECK(given.name == "lone");
  CHECK(given.cycle == defaults.cycle);
  CHECK(given.vision.delay == defaults.vision.delay);
  CHECK_FALSE(given.vision.images);
  CHECK(given.margin_m == defaults.margin_m);
  CHECK(given.time_limit_s == defaults.time_limit_s);
  CHECK_FALSE(given.ball);
}

}  // namespace sidestep::scenario_loader_test
