// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/scene_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "common/config/planner_names.hpp"
#include "common/config/scenario_check.hpp"
#include "deploy/trial/simulate/campaign/base_sampler.hpp"
#include "deploy/trial/simulate/campaign/building_sampler.hpp"
#include "deploy/trial/simulate/campaign/position_sampler.hpp"
#include "deploy/trial/simulate/campaign/walk_sampler.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kGoals = 150;

Shape sample_obstacle(const Field& field, Rng& rng) {
  enum ShapeKind { kCircle, kBox, kPolygon, kWall, kKinds };
  const double y = rng.uniform(-0.4, 0.4) * field.width_m, x = rng.uniform(-0.4, 0.4) * field.length_m;
  const Vec2 centre(x, y);
  const double max_radius_m = std::min(0.4, field.width_m / 6);
  const double first_m = rng.uniform(0.05, max_radius_m), second_m = rng.uniform(0.05, max_radius_m);
  switch (static_cast<ShapeKind>(rng.below(kKinds))) {
    case kBox:
      return Box{centre - Vec2(first_m, second_m), centre + Vec2(first_m, second_m)};
    case kPolygon: {
      ConvexPolygon polygon;
      const std::uint64_t corners = 3 + rng.below(4);
      for (std::uint64_t i = 0; i < corners; ++i) {
        const double turns = (static_cast<double>(i) + rng.uniform(0, 0.6)) / static_cast<double>(corners);
        polygon.corners_m.push_back(centre + rotated(Vec2(first_m, 0), 2 * std::numbers::pi * turns));
      }
      return polygon;
    }
    case kWall: {
      const double half_length_m = rng.uniform(0.1, 0.3) * field.width_m;
      const Vec2 along = rotated(Vec2(half_length_m, 0), rng.uniform(0, std::numbers::pi));
      const Vec2 aside = 0.02 * Vec2(-along.y(), along.x()) / half_length_m;
      return ConvexPolygon{
          {centre - along - aside, centre + along - aside, centre + along + aside, centre - along + aside}};
    }
    default:
      return Circle{centre, first_m};
  }
}

void sample_floor(Scenario& scenario, std::size_t robots, Rng& rng) {
  const double area_m2 = static_cast<double>(robots) * 0.5 * std::pow(6, rng.uniform());
  const double aspect = rng.uniform(1, 2);
  scenario.field = {std::sqrt(area_m2 * aspect), std::sqrt(area_m2 / aspect)};
  for (std::uint64_t left = rng.chance(0.5) ? rng.below(6) : 0; left > 0; --left) {
    scenario.obstacles.push_back(sample_obstacle(scenario.field, rng));
  }
  constexpr double kMinWidth_m = 3, kMinAreaPerRobot_m2 = 1.5;  // minimum sizes of rooms
  if (rng.chance(0.3) && scenario.field.width_m > kMinWidth_m &&
      area_m2 > kMinAreaPerRobot_m2 * static_cast<double>(robots))
    scenario.map = sample_building(scenario.field, scenario.radius_m, rng);
}

void sample_sensors(Scenario& scenario, Rng& rng) {
  if (rng.chance(0.3)) scenario.command_loss = rng.uniform(0, 0.3);
  if (rng.chance(0.3)) scenario.vision.miss_probability = rng.uniform(0, 0.3);
  if (rng.chance(0.3)) scenario.vision.delay = from_seconds(rng.uniform(0.002, 0.04));
  if (rng.chance(0.3)) scenario.limits.speed_mps = rng.uniform(0.8, scenario.limits.speed_mps);
}

/// Samples starts and long sequences of goals.
void sample_paths(Scenario& scenario, Rng& rng) {
  enum Pattern { kAnywhere, kThroughTheMiddle, kCircle, kSides, kPatterns };
  const auto pattern = static_cast<Pattern>(rng.below(kPatterns));
  PositionSampler positions(scenario, rng);
  const double spread = rng.uniform(0.5, 0.9);
  const double circle_m = 0.42 * scenario.field.width_m;
  const auto count = static_cast<double>(scenario.robots.size());
  std::vector<Vec2> starts, last_goals;
  for (RobotSpec& robot : scenario.robots) {
    const auto i = static_cast<double>(robot.id);
    const Vec2 arm = rotated(Vec2(circle_m, 0), 2 * std::numbers::pi * i / count);
    const double side = robot.id % 2 == 0 ? 1 : -1;
    const Vec2 at_side(side * 0.42 * scenario.field.length_m,
                       rng.uniform(-0.45, 0.45) * scenario.field.width_m);
    robot.start_m = pattern == kCircle  ? positions.sample_near(arm, starts)
                    : pattern == kSides ? positions.sample_near(at_side, starts)
                                        : positions.sample_apart(starts);
    starts.push_back(robot.start_m);
    robot.start_heading_rad = rng.uniform(-3, 3);
    while (robot.goals.size() + 1 < kGoals) {
      const double direction = robot.goals.size() % 2 == 0 ? -1 : 1;
      const Vec2 across(direction * at_side.x(), rng.uniform(-0.45, 0.45) * scenario.field.width_m);
      robot.goals.push_back({pattern == kCircle             ? positions.sample_near(direction * arm, {})
                             : pattern == kSides            ? positions.sample_near(across, {})
                             : pattern == kThroughTheMiddle ? positions.sample(spread)
                                                            : positions.sample(),
                             std::nullopt});
    }
    last_goals.push_back(positions.sample_apart(last_goals));
    robot.goals.push_back({last_goals.back(), std::nullopt});
  }
}

/// Samples people who walk around obstacles and through the rooms of a building.
void sample_people(Scenario& scenario, double min_radius_m, double max_radius_m, Rng& rng) {
  const auto is_near_robot = [&](const Vec2& p, double radius_m) {
    return std::ranges::any_of(scenario.robots, [&](const RobotSpec& robot) {
      return (robot.start_m - p).norm() < radius_m + scenario.radius_m + scenario.margin_m;
    });
  };
  for (std::uint64_t left = 1 + rng.below(6); left > 0; --left) {
    OpponentSpec person;
    person.radius_m = rng.uniform(min_radius_m, max_radius_m);
    person.speed_mps = rng.uniform(0.1, 1) * scenario.max_opponent_speed_mps;
    WalkSampler walks(scenario, person.radius_m, rng);
    const int places = 2 + static_cast<int>(rng.below(3));
    const std::optional<Vec2> start = walks.sample_free();
    if (!start || is_near_robot(*start, person.radius_m)) continue;
    person.path_m = walks.sample_walk(*start, places);
    scenario.opponents.push_back(std::move(person));
  }
}

}  // namespace

Scenario sample_scene(Rng& rng, const std::optional<DrivenBaseSettings>& bases) {
  Scenario scenario;
  scenario.name = "random";
  constexpr std::size_t kMost = 30, kMaxDrivenBases = 16;  // a team has 16 numbers
  const std::size_t robots = 5 + rng.below((bases ? kMaxDrivenBases : kMost) - 4);
  if (bases) prepare_for(scenario, *bases);
  sample_floor(scenario, robots, rng);
  sample_sensors(scenario, rng);
  if (bases) scenario.command_loss = 0;  // only firmware loses commands
  scenario.robots.resize(robots);
  std::vector<RobotLines> lines(robots);
  for (std::size_t i = 0; i < robots; ++i) {
    scenario.robots[i].id = static_cast<RobotId>(i);
    scenario.robots[i].team = i % 2 == 0 ? Team::kBlue : Team::kYellow;
    lines[i] = {1, std::vector<int>(kGoals, 1)};
  }
  sample_paths(scenario, rng);
  const double u = rng.uniform();
  scenario.coordinators = u < 0.25 ? 1 : u < 0.85 ? 2 : 3;
  check_placement(scenario, lines, scenario.name);
  return scenario;
}

void sample_opponents(Scenario& scenario, Rng& rng) {
  if (!rng.chance(scenario.map ? 0.6 : 0.12)) return;
  // On a small floor, quick opponents could be anywhere before a robot has stopped, and no robot would drive.
  scenario.max_opponent_speed_mps = std::min(1.5, 0.25 * scenario.field.width_m);
  if (scenario.map) return sample_people(scenario, 0.5 * scenario.radius_m, 2 * scenario.radius_m, rng);
  PositionSampler positions(scenario, rng);
  std::vector<Vec2> starts;
  for (const RobotSpec& robot : scenario.robots) starts.push_back(robot.start_m);
  for (std::uint64_t left = 1 + rng.below(3); left > 0; --left) {
    OpponentSpec opponent;
    // Starts keep the same distance from each other as two robots.
    opponent.radius_m = rng.uniform(0.4, 1) * scenario.radius_m;
    opponent.speed_mps = rng.chance(0.3) ? scenario.max_opponent_speed_mps
                                         : rng.uniform(0.1, 1) * scenario.max_opponent_speed_mps;
    opponent.path_m.push_back(positions.sample_apart(starts));
    starts.push_back(opponent.path_m.front());
    for (std::uint64_t points = 1 + rng.below(3); points > 0; --points)
      opponent.path_m.push_back(positions.sample());
    scenario.opponents.push_back(opponent);
  }
}

void sample_lasers(Scenario& scenario, Rng& rng) {
  constexpr std::size_t kMaxRobotsWithLasers = 12;  // scans take most of the time
  if (scenario.robots.size() > kMaxRobotsWithLasers || !rng.chance(0.4)) return;
  LaserSpec& laser = scenario.laser.emplace();
  laser.settings.beams = 240 + static_cast<int>(rng.below(480));
  laser.settings.max_range_m = rng.uniform(4, 10);
  laser.rate_hz = rng.uniform(10, 30);
  laser.range_error_m = rng.uniform(0.005, 0.03);
  if (rng.chance(0.3)) laser.dropout_probability = rng.uniform(0, 0.05);
  laser.person_radius_m = rng.uniform(0.1, 0.2);
  scenario.max_opponent_speed_mps = std::min(1.2, 0.25 * scenario.field.width_m);
  scenario.opponents.clear();
  sample_people(scenario, laser.person_radius_m, 1.5 * laser.person_radius_m, rng);
}

void sample_planners(Scenario& scenario, Rng& rng) {
  if (rng.chance(0.5)) return;
  std::vector<std::string> planners = driving_planners();
  std::erase_if(planners, [](const std::string& name) {
    return name == "dynamic-window" || name == "potential-field";
  });
  const auto draw = [&] { return planners[rng.below(planners.size())]; };
  scenario.planner = draw();
  if (rng.chance(0.5)) return;
  for (RobotSpec& robot : scenario.robots) robot.planner = draw();
}

std::string scene_summary(const Scenario& scenario) {
  return fmt::format(
      "{} robots{} on {:.2f} x {:.2f} m, {}{} obstacles, {} {}, {} coordinators; {}; "
      "at most {:.2f} m/s; command loss {:.1f} %, "
      "vision delay {:.1f} ms, missed detections {:.1f} %, ghosts {:.1f} % robots and {:.1f} % obstacles",
      scenario.robots.size(), scenario.laser ? " with lasers" : "", scenario.field.length_m,
      scenario.field.width_m, scenario.map ? "a building, " : "", scenario.obstacles.size(),
      scenario.opponents.size(), scenario.map ? "people" : "opponents", scenario.coordinators,
      scenario.robots.front().planner.empty() ? scenario.planner : "a planner for each robot",
      scenario.limits.speed_mps, 100 * scenario.command_loss, to_seconds(scenario.vision.delay) * 1e3,
      100 * scenario.vision.miss_probability, 100 * scenario.vision.ghost_probability,
      100 * scenario.vision.ghost_obstacle_probability);
}

}  // namespace sidestep
