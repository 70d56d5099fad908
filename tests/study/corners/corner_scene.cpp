// SPDX-License-Identifier: Apache-2.0
#include "tests/study/corners/corner_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/map/floor_plan.hpp"
#include "deploy/trial/simulate/campaign/walk_sampler.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {
namespace {

constexpr double kWall_m = 0.1;
constexpr double kMinPathLength_m = 3;      // minimum length of the robot's path
constexpr double kMinPersonDistance_m = 1;  // distance from the robot's start
constexpr int kTries = 2000;

/// A wall parallel to the y axis.
void add_wall(Scenario& scenario, double x, double low_y, double high_y) {
  scenario.obstacles.emplace_back(Box{{x - kWall_m / 2, low_y}, {x + kWall_m / 2, high_y}});
}

void add_corner(Scenario& scenario, Rng& rng) {
  const double edge = scenario.field.width_m / 2, end = rng.uniform(-1, 1.5);
  add_wall(scenario, rng.uniform(-1, 1), -edge, end);
  if (rng.chance(0.5)) {
    const double from = rng.uniform(0, 1), to = rng.uniform(2, 3.5);
    scenario.obstacles.emplace_back(Box{{from, end - kWall_m}, {to, end}});
  }
}

void add_door(Scenario& scenario, Rng& rng) {
  const double edge = scenario.field.width_m / 2, x = rng.uniform(-1, 1);
  const double gap_m = rng.uniform(0.8, 1.6), low = rng.uniform(-2, 2 - gap_m);
  add_wall(scenario, x, -edge, low);
  add_wall(scenario, x, low + gap_m, edge);
}

void add_shelves(Scenario& scenario, Rng& rng) {
  const double aisle_m = rng.uniform(1, 1.6), depth_m = rng.uniform(0.3, 0.6);
  const double left = -scenario.field.length_m / 2 + aisle_m, right = scenario.field.length_m / 2 - aisle_m;
  for (double y = -scenario.field.width_m / 2 + aisle_m; y + depth_m + aisle_m < scenario.field.width_m / 2;
       y += depth_m + aisle_m) {
    const double gap_m = rng.uniform(0.8, 1.4), at = rng.uniform(left + 0.5, right - 0.5 - gap_m);
    scenario.obstacles.emplace_back(Box{{left, y}, {at, y + depth_m}});
    scenario.obstacles.emplace_back(Box{{at + gap_m, y}, {right, y + depth_m}});
  }
}

void add_pillars(Scenario& scenario, Rng& rng) {
  for (std::uint64_t i = 4 + rng.below(5); i > 0; --i) {
    const double x = rng.uniform(-3, 3), y = rng.uniform(-2.3, 2.3);
    const double half_x = rng.uniform(0.15, 0.5), half_y = rng.uniform(0.15, 0.5);
    if (rng.chance(0.5))
      scenario.obstacles.emplace_back(Circle{{x, y}, half_x});
    else
      scenario.obstacles.emplace_back(Box{{x - half_x, y - half_y}, {x + half_x, y + half_y}});
  }
}

void add_rooms(Scenario& scenario, Rng& rng) {
  MapGrid grid;
  grid.columns = 180, grid.rows = 140, grid.origin_m = {-4.5, -3.5};
  scenario.field = {9, 7};
  FloorPlanSettings plan;
  plan.wall_m = kWall_m;
  plan.min_room_m = 2.2;
  plan.max_room_m = 5;
  plan.corridor_m = 1.4;
  plan.shelf_m = 0.5;
  plan.aisle_m = 1;
  scenario.map = std::make_shared<const FloorMap>(make_floor_plan(rng.bits(), grid, plan));
}

void sample_robot_and_laser(Scenario& scenario, Rng& rng) {
  scenario.radius_m = rng.uniform(0.08, 0.2);
  scenario.limits.speed_mps = rng.uniform(0.8, 2);
  scenario.limits.deceleration_mps2 = rng.uniform(3, 5);
  scenario.max_opponent_speed_mps = std::array{0.8, 1.2, 1.6}[rng.below(3)];
  LaserSpec& laser = scenario.laser.emplace();
  laser.settings.beams = 360 + static_cast<int>(rng.below(720));
  laser.settings.max_range_m = rng.uniform(5, 12);
  laser.rate_hz = rng.uniform(10, 40);
  laser.range_error_m = rng.uniform(0.01, 0.03);
  laser.dropout_probability = rng.chance(0.5) ? rng.uniform(0, 0.05) : 0;
  laser.person_radius_m = rng.uniform(0.15, 0.3);
}

/// The position at the fraction `part` of the length of a path that begins at `from_m`.
Vec2 point_on(const Vec2& from_m, const std::vector<Vec2>& way_m, double part) {
  double length_m = 0;
  Vec2 last = from_m;
  for (const Vec2& p : way_m) length_m += (p - std::exchange(last, p)).norm();
  double left_m = part * length_m;
  last = from_m;
  for (const Vec2& p : way_m) {
    const double leg_m = (p - last).norm();
    if (left_m <= leg_m) return last + left_m / leg_m * (p - last);
    left_m -= leg_m;
    last = p;
  }
  return last;
}

/// A person who walks from a place that the robot does not see from its start onto the robot's path, and
/// back.
std::optional<OpponentSpec> sample_person(const Scenario& scenario, const RobotSpec& robot,
                                          const std::vector<Vec2>& way_m, Rng& rng) {
  const double smallest_m = scenario.laser->person_radius_m;
  OpponentSpec person;
  person.radius_m = rng.chance(0.5) ? smallest_m : smallest_m * rng.uniform(1, 1.5);
  person.speed_mps = scenario.max_opponent_speed_mps * (rng.chance(0.5) ? 1 : rng.uniform(0.4, 1));
  WalkSampler finder(scenario, person.radius_m, rng);
  const Vec2 meeting = point_on(robot.start_m, way_m, rng.uniform(0.2, 0.95));
  for (int i = 0; i < kTries; ++i) {
    const std::optional<Vec2> place = finder.sample_free();
    if (!place || !finder.is_free(meeting)) return std::nullopt;
    const Vec2& hidden = *place;
    if (finder.is_seen(robot.start_m, hidden) || (hidden - robot.start_m).norm() < kMinPersonDistance_m)
      continue;
    const auto walk = finder.path(hidden, meeting);
    if (!walk) continue;
    // People start anywhere on their routes, so that they meet the robot at random times.
    const Vec2 first = point_on(hidden, *walk, rng.uniform(0, 0.6));
    if ((first - robot.start_m).norm() < kMinPersonDistance_m) continue;
    if (const auto rest = finder.path(first, meeting)) {
      person.path_m = {first};
      person.path_m.insert(person.path_m.end(), rest->begin(), rest->end());
      if (const auto back = finder.path(meeting, hidden))
        person.path_m.insert(person.path_m.end(), back->begin(), back->end());
      return person;
    }
  }
  return std::nullopt;
}

}  // namespace

Scenario corner_scene(std::size_t kind, std::uint64_t seed) {
  Rng rng(seed * kCornerKinds.size() + kind);
  while (true) {
    Scenario scenario;
    scenario.name = kCornerKinds.at(kind);
    scenario.field = {8, 6};
    scenario.time_limit_s = 30;
    constexpr std::array kFloors{add_corner, add_door, add_shelves, add_pillars, add_rooms};
    kFloors.at(kind)(scenario, rng);
    sample_robot_and_laser(scenario, rng);
    WalkSampler finder(scenario, scenario.radius_m + scenario.margin_m + 0.05, rng);
    RobotSpec robot;
    const std::optional<Vec2> start = finder.sample_free(), end = finder.sample_free();
    if (!start || !end) continue;
    robot.start_m = *start;
    robot.start_heading_rad = rng.uniform(-3, 3);
    const Vec2& goal = *end;
    const auto way = finder.path(robot.start_m, goal);
    if (!way || (goal - robot.start_m).norm() < kMinPathLength_m || finder.is_seen(robot.start_m, goal))
      continue;
    robot.goals = {{goal}};
    scenario.robots = {robot};
    for (std::uint64_t i = 1 + rng.below(3); i > 0; --i)
      if (auto person = sample_person(scenario, robot, *way, rng))
        scenario.opponents.push_back(std::move(*person));
    if (!scenario.opponents.empty()) return scenario;
  }
}

CornerResult run_corner(Scenario scenario, std::uint64_t seed, bool has_laser) {
  if (!has_laser) scenario.laser.reset();
  SimSystem system(scenario, seed);
  CornerResult result;
  system.observer_bus().subscribe(topics::kOrderStatus, [&](const msg::OrderStatus& status) {
    result.was_blocked |= status.block_reason() == msg::BlockReason::BLOCK_OCCLUDED_CORNER;
  });
  result.has_arrived = system.run_until_arrived(system.begin() + from_seconds(scenario.time_limit_s));
  const Report report = system.metrics().report();
  result.seconds = report.makespan_s.value_or(scenario.time_limit_s);
  result.contacts = report.contacts;
  result.crashes = report.crashes;
  result.crashes_in_motion = report.crashes_while_moving;
  result.audit_passed = report.audit && report.audit->verdict() == AuditVerdict::kPassed;
  return result;
}

}  // namespace sidestep
