// SPDX-License-Identifier: Apache-2.0
#include "tests/study/clutter/clutter_scene.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "common/map/floor_plan.hpp"
#include "deploy/trial/simulate/campaign/position_sampler.hpp"
#include "deploy/trial/simulate/campaign/walk_sampler.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {
namespace {

constexpr double kPersonRadius_m = 0.25, kMaxPersonSpeed_mps = 1.2;
constexpr int kGoalsPerRobot = 3, kWalks = 4, kHallObstacles = 10;
constexpr double kTimeLimit_s = 300;
// Robots start at least this far from people.
constexpr double kStartDistance_m = 1;

void sample_building_floor(Scenario& scenario, Rng& rng) {
  scenario.field = {14, 10};
  MapGrid grid;
  grid.columns = 280, grid.rows = 200, grid.origin_m = {-7, -5};
  FloorPlanSettings plan;
  plan.wall_m = 0.1;
  plan.min_room_m = 2.5;
  plan.max_room_m = 6;
  plan.corridor_m = 1.4;
  plan.shelf_m = 0.5;
  plan.aisle_m = 1;
  scenario.map = std::make_shared<const FloorMap>(make_floor_plan(rng.bits(), grid, plan));
}

void sample_hall(Scenario& scenario, Rng& rng) {
  scenario.field = {16, 12};
  for (int i = 0; i < kHallObstacles; ++i) {
    const double y = rng.uniform(-4.5, 4.5), x = rng.uniform(-6.5, 6.5);
    const double half_y = rng.uniform(0.2, 0.8), half_x = rng.uniform(0.2, 0.8);
    const Vec2 centre(x, y), half(half_x, half_y);
    if (rng.chance(0.5))
      scenario.obstacles.emplace_back(Circle{centre, half_x});
    else
      scenario.obstacles.emplace_back(Box{centre - half, centre + half});
  }
}

/// Precondition: the floor has room for people.
void sample_people(Scenario& scenario, int count, Rng& rng) {
  WalkSampler walks(scenario, kPersonRadius_m, rng);
  scenario.max_opponent_speed_mps = kMaxPersonSpeed_mps;
  for (int i = 0; i < count; ++i) {
    OpponentSpec person;
    person.radius_m = kPersonRadius_m;
    person.speed_mps = rng.uniform(0.3, 1) * kMaxPersonSpeed_mps;
    person.path_m = walks.sample_walk(walks.sample_free().value(), kWalks);
    scenario.opponents.push_back(std::move(person));
  }
}

/// Adds a robot at a free position away from others and from people, with goals that it can reach.
void add_robot(Scenario& scenario, std::vector<Vec2>& starts, std::vector<Vec2>& last_goals, Rng& rng) {
  PositionSampler positions(scenario, rng);
  WalkSampler walks(scenario, scenario.radius_m + scenario.margin_m, rng);
  const auto is_near_people = [&](const Vec2& p) {
    return std::ranges::any_of(scenario.opponents, [&](const OpponentSpec& person) {
      return (person.path_m.front() - p).norm() < kStartDistance_m;
    });
  };
  RobotSpec robot;
  robot.id = static_cast<RobotId>(scenario.robots.size());
  do robot.start_m = positions.sample_apart(starts);
  while (is_near_people(robot.start_m));
  starts.push_back(robot.start_m);
  while (robot.goals.size() < kGoalsPerRobot) {
    const Vec2 goal = positions.sample_apart(last_goals);
    if (walks.path(robot.start_m, goal)) robot.goals.push_back({goal});
  }
  last_goals.push_back(robot.goals.back().position_m);
  scenario.robots.push_back(std::move(robot));
}

}  // namespace

Scenario clutter_scene(const ClutterSettings& settings, std::uint64_t seed) {
  Rng rng(seed);
  Scenario scenario;
  scenario.name = settings.is_building ? "building" : "hall";
  scenario.planner = settings.planner;
  scenario.time_limit_s = kTimeLimit_s;
  settings.is_building ? sample_building_floor(scenario, rng) : sample_hall(scenario, rng);
  sample_people(scenario, settings.people, rng);
  std::vector<Vec2> starts, last_goals;
  for (int i = 0; i < settings.robots; ++i) add_robot(scenario, starts, last_goals, rng);
  return scenario;
}

ClutterResult run_clutter(const Scenario& scenario, std::uint64_t seed) {
  SimSystem system(scenario, seed);
  system.run_until_arrived(system.begin() + from_seconds(scenario.time_limit_s));
  const Report report = system.metrics().report();
  ClutterResult result;
  result.robots = static_cast<int>(scenario.robots.size());
  result.arrived = report.arrived;
  result.seconds = report.makespan_s.value_or(scenario.time_limit_s);
  result.contacts = report.contacts;
  result.crashes = report.crashes;
  result.crashes_in_motion = report.crashes_while_moving;
  result.audit_passed = report.audit && report.audit->verdict() == AuditVerdict::kPassed;
  return result;
}

}  // namespace sidestep
