// SPDX-License-Identifier: Apache-2.0
#include "simulator/images/floor_scene.hpp"

#include <algorithm>
#include <iterator>

namespace sidestep {
namespace {

constexpr Rgb kOpponent{118, 44, 150};

SceneRobot scene_robot(const RobotSpec& robot) {
  return {robot.team, number_in_team(robot.id), robot.start_m, robot.start_heading_rad};
}

SceneCylinder opponent(const Circle& disc) { return {disc, SceneCylinder().height_m, kOpponent}; }

SceneBall ball(const Vec2& position_m, const Vec2& velocity_mps) {
  return {{position_m.x(), position_m.y(), SceneBall().position_m.z()}, velocity_mps};
}

}  // namespace

FloorScene floor_scene(const Scenario& scenario) {
  FloorScene floor;
  for (const RobotSpec& robot : scenario.robots) {
    if (!robot.is_absent) floor.robots.push_back(scene_robot(robot));
  }
  for (const Circle& circle : circles_of(scenario.obstacles)) floor.cylinders.push_back({circle});
  for (const OpponentSpec& spec : scenario.opponents)
    floor.cylinders.push_back(opponent({spec.path_m.front(), spec.radius_m}));
  if (scenario.ball) floor.ball = ball(scenario.ball->position_m, scenario.ball->velocity_mps);
  return floor;
}

FloorScene floor_scene(const Scenario& scenario, const World& world) {
  FloorScene floor;
  for (std::size_t i = 0; i < world.robot_count(); ++i) {
    const Body& body = world.bodies()[i];
    if (!body.is_on_floor()) continue;
    SceneRobot robot = scene_robot(scenario.robots[i]);
    robot.position_m = body.position_m();
    robot.heading_rad = body.heading_rad();
    robot.velocity_mps = body.velocity_mps();
    robot.angular_radps = body.angular_radps();
    floor.robots.push_back(robot);
  }
  for (const Circle& circle : circles_of(scenario.obstacles)) floor.cylinders.push_back({circle});
  for (const Circle& disc : world.opponents().discs()) floor.cylinders.push_back(opponent(disc));
  if (world.ball()) floor.ball = ball(world.ball()->state().position_m, world.ball()->state().velocity_mps);
  return floor;
}

StaticScene static_scene(const Scenario& scenario) {
  StaticScene statics;
  std::ranges::copy_if(scenario.obstacles, std::back_inserter(statics.shapes),
                       [](const Shape& shape) { return !std::holds_alternative<Circle>(shape); });
  statics.map = scenario.map;
  return statics;
}

}  // namespace sidestep
