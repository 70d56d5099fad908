// SPDX-License-Identifier: Apache-2.0
// Fuzzes the reader of scenario files.
#include <cmath>
#include <set>

#include "common/config/scenario_loader.hpp"
#include "common/config/shared_rules.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace sidestep::fuzz {
namespace {

constexpr const char* kFile = "fuzz.yaml";

#define SIDESTEP_REQUIRE_WITHIN(value, low, high) SIDESTEP_REQUIRE((value) >= (low) && (value) <= (high))

/// The key `map` of every input refers to this map, so that no input reads files.
const OccupancyMap& cells() {
  static const OccupancyMap map = [] {
    MapGrid grid;
    grid.columns = 40, grid.rows = 30, grid.resolution_m = 0.5, grid.origin_m = {-10, -7.5};
    BitGrid blocked(grid.columns, grid.rows);
    blocked.set_run(0, grid.columns, 0);
    return OccupancyMap(grid, std::move(blocked));
  }();
  return map;
}

bool is_near(const Vec2& p, double bound_m) {
  return std::abs(p.x()) <= bound_m && std::abs(p.y()) <= bound_m;
}

/// Checks the bounds of deploy/scenarios/README.md.
void check_numbers(const Scenario& scenario) {
  SIDESTEP_REQUIRE_WITHIN(scenario.field.length_m, 0.5, 1000);
  SIDESTEP_REQUIRE_WITHIN(scenario.field.width_m, 0.5, 1000);
  SIDESTEP_REQUIRE_WITHIN(scenario.limits.acceleration_mps2, 0.1, 50);
  SIDESTEP_REQUIRE_WITHIN(scenario.limits.deceleration_mps2, 0.1, 50);
  SIDESTEP_REQUIRE_WITHIN(scenario.limits.speed_mps, 0.05, 20);
  SIDESTEP_REQUIRE_WITHIN(scenario.radius_m, 0.01, 5);
  SIDESTEP_REQUIRE_WITHIN(scenario.tracking_bound_m, 0.0005, 1);
  SIDESTEP_REQUIRE_WITHIN(scenario.clock_bound_s, 0, 1);
  const double required_m =
      2 * scenario.tracking_bound_m + 4 * scenario.clock_bound_s * scenario.limits.speed_mps;
  SIDESTEP_REQUIRE_WITHIN(scenario.margin_m, required_m - 2e-9, 1);
  SIDESTEP_REQUIRE_WITHIN(scenario.goal_tolerance_m, 0.001, 1);
  SIDESTEP_REQUIRE_WITHIN(scenario.time_limit_s, 0.1, 86400);
  SIDESTEP_REQUIRE_WITHIN(to_seconds(scenario.cycle), 1.0 / 501, 1.0 / 4.9);
  SIDESTEP_REQUIRE_WITHIN(scenario.command_loss, 0, 1);
  SIDESTEP_REQUIRE_WITHIN(scenario.network.loss, 0, 1);
  SIDESTEP_REQUIRE_WITHIN(scenario.network.delay_max, scenario.network.delay_min, std::chrono::seconds(10));
  SIDESTEP_REQUIRE_WITHIN(scenario.vision.rate_hz, 5, 1000);
  SIDESTEP_REQUIRE_WITHIN(scenario.vision.columns, 1, 16);
  SIDESTEP_REQUIRE_WITHIN(scenario.vision.miss_probability, 0, 1);
  SIDESTEP_REQUIRE(!scenario.name.empty() && scenario.name.size() <= 64);
  SIDESTEP_REQUIRE(scenario.name.find_first_of("/\\ \n") == std::string::npos && scenario.name[0] != '.');
  if (scenario.vision.images) {
    SIDESTEP_REQUIRE_WITHIN(scenario.vision.images->width_px, 16, 4096);
    SIDESTEP_REQUIRE_WITHIN(scenario.vision.images->height_px, 16, 4096);
  }
  if (scenario.laser) {
    SIDESTEP_REQUIRE_WITHIN(scenario.laser->settings.beams, 8, 10'000);
    SIDESTEP_REQUIRE(scenario.laser->settings.min_range_m < scenario.laser->settings.max_range_m);
  }
}

/// Checks that robots start and end on the field, apart from each other, from obstacles and from blocked
/// cells.
void check_robots(const Scenario& scenario) {
  constexpr double kRounding_m = 1e-6;
  const double x_m = scenario.field.length_m / 2 - scenario.radius_m + kRounding_m,
               y_m = scenario.field.width_m / 2 - scenario.radius_m + kRounding_m,
               apart_m = 2 * scenario.radius_m + scenario.margin_m - kRounding_m;
  SIDESTEP_REQUIRE(!scenario.robots.empty() && scenario.robots.size() <= kMaxRobots);
  std::vector<Vec2> starts;
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const RobotSpec& robot = scenario.robots[i];
    SIDESTEP_REQUIRE(robot.id < kMaxRobots && (i == 0 || robot.id > scenario.robots[i - 1].id));
    SIDESTEP_REQUIRE(std::abs(robot.start_heading_rad) <= 7);
    std::vector<Vec2> places{robot.start_m};
    for (const Goal& goal : robot.goals) {
      places.push_back(goal.position_m);
      SIDESTEP_REQUIRE(std::abs(goal.heading_rad.value_or(0)) <= 7);
    }
    for (const Vec2& place : places) {
      SIDESTEP_REQUIRE(std::abs(place.x()) <= x_m && std::abs(place.y()) <= y_m);
      for (const Shape& obstacle : scenario.obstacles)
        SIDESTEP_REQUIRE(signed_distance(place, obstacle) >=
                         scenario.radius_m + scenario.margin_m - kRounding_m);
      SIDESTEP_REQUIRE(!scenario.map || scenario.map->cells().distance_m(place, 5) >=
                                            scenario.radius_m + scenario.margin_m - kRounding_m);
    }
    if (robot.is_absent) continue;
    for (const Vec2& other : starts) SIDESTEP_REQUIRE((other - robot.start_m).norm() >= apart_m);
    starts.push_back(robot.start_m);
  }
}

void check_floor(const Scenario& scenario) {
  for (const OpponentSpec& opponent : scenario.opponents) {
    SIDESTEP_REQUIRE_WITHIN(opponent.radius_m, 0.01, 5);
    SIDESTEP_REQUIRE_WITHIN(opponent.speed_mps, 0.01, scenario.max_opponent_speed_mps);
    SIDESTEP_REQUIRE(!opponent.path_m.empty());
    for (const Vec2& point : opponent.path_m) SIDESTEP_REQUIRE(is_near(point, 1000));
  }
  for (const Shape& obstacle : scenario.obstacles) {
    SIDESTEP_REQUIRE(is_near(centre_m(obstacle), 3000));
    SIDESTEP_REQUIRE(std::isfinite(signed_distance({0, 0}, obstacle)));
  }
  if (scenario.ball)
    SIDESTEP_REQUIRE(is_near(scenario.ball->position_m, 500) && is_near(scenario.ball->velocity_mps, 20));
}

/// Checks that the receiver can decode the rules that processes send each other.
void check_rules(const Scenario& scenario) {
  const SharedRules rules(scenario);
  const auto heard = SharedRules::parse(rules.text());
  SIDESTEP_REQUIRE(heard && heard->fingerprint() == rules.fingerprint());
  SIDESTEP_REQUIRE(rules.differences(*heard).empty());
}

}  // namespace

bool try_input(View input) {
  try {
    const Scenario scenario = parse_scenario(text_of(input), kFile, &cells());
    check_numbers(scenario);
    check_robots(scenario);
    check_floor(scenario);
    check_rules(scenario);
    return true;
  } catch (const ConfigError& error) {
    SIDESTEP_REQUIRE(std::string_view(error.what()).starts_with("fuzz.yaml:"));
    return false;
  }
}

std::vector<Bytes> seeds() {
  std::vector<Bytes> result;
  for (const auto& file : files_in("deploy/scenarios", ".yaml")) {
    Bytes text = file_content(file);
    // Other files there are not scenarios, or their robots would overlap walls of this map.
    constexpr std::size_t kMaxSize = 4096;
    if (text.size() <= kMaxSize && try_input(text)) result.push_back(std::move(text));
  }
  return result;
}

}  // namespace sidestep::fuzz
