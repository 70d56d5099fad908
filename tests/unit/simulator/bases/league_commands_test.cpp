// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/league_commands.hpp"

#include "tests/catch.hpp"

namespace sidestep::league_commands_test {
namespace {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'000'000'000'000);

Scenario one_robot() {
  Scenario scenario;
  scenario.robots.emplace_back();
  scenario.robots.front().id = 4;
  scenario.ball = BallSpec{{0.09 + 0.025, 0}, {0, 0}};
  return scenario;
}

league::TeamCommands command(std::uint32_t number, league::RobotMove::Kind kind) {
  league::RobotCommand robot;
  robot.number = number;
  robot.move = {kind, {1, 0}, 0};
  return {{robot}};
}

}  // namespace

TEST_CASE("only local velocities are accepted, unless global velocities are allowed") {
  using Kind = league::RobotMove::Kind;
  BaseWorld world(one_robot(), 0, {}, kBegin);
  LeagueCommands strict(world, false), generous(world, true);
  CHECK(strict.on_team(Team::kBlue, command(4, Kind::kLocal), kBegin).errors.empty());
  const auto refused = strict.on_team(Team::kBlue, command(4, Kind::kGlobal), kBegin);
  REQUIRE(refused.errors.size() == 1);
  CHECK(refused.errors[0].code == "UNSUPPORTED_VELOCITY");
  CHECK(refused.feedback.size() == 1);
  CHECK(generous.on_team(Team::kBlue, command(4, Kind::kGlobal), kBegin).errors.empty());
  CHECK(generous.on_team(Team::kBlue, command(4, Kind::kWheels), kBegin).errors.size() == 1);
  CHECK(strict.on_team(Team::kYellow, command(4, Kind::kLocal), kBegin).errors[0].code == "UNKNOWN_ROBOT");
  CHECK(strict.on_team(Team::kBlue, command(5, Kind::kLocal), kBegin).errors[0].message ==
        "there is no blue robot 5");
}

TEST_CASE("the feedback tells whether the robot has the ball, and a kick moves the ball") {
  BaseWorld world(one_robot(), 0, {}, kBegin);
  LeagueCommands commands(world, false);
  league::RobotCommand kick;
  kick.number = 4;
  auto response = commands.on_team(Team::kBlue, {{kick}}, kBegin);
  REQUIRE(response.feedback.size() == 1);
  CHECK(response.feedback[0].has_ball);
  kick.kick_mps = 3;
  commands.on_team(Team::kBlue, {{kick}}, kBegin);
  world.advance(kBegin + 50ms);
  CHECK(world.ball()->state().velocity_mps.x() > 2.5);
}

TEST_CASE("a teleport moves the robot of the named team, and commands for unassigned numbers move no robot") {
  Scenario scenario = one_robot();
  scenario.robots.emplace_back();
  scenario.robots.back().id = 20;
  scenario.robots.back().team = Team::kYellow;
  scenario.robots.back().start_m = {-1, -1};
  BaseWorld world(scenario, 0, {}, kBegin);
  LeagueCommands commands(world, false);
  league::RobotTeleport robot;
  robot.team = Team::kYellow;
  robot.number = 4;
  robot.x_m = 1, robot.y_m = 2, robot.heading_rad = 3;
  league::SimulatorCommand teleport;
  teleport.robots.push_back(robot);
  std::optional<double> speed;
  CHECK(commands.on_control(teleport, speed).errors.empty());
  CHECK(world.bodies()[0].position_m() == Vec2(0, 0));
  CHECK(world.bodies()[1].position_m() == Vec2(1, 2));
  for (const std::uint32_t number : {11U, 200U, 4294967295U})
    CHECK(commands.on_team(Team::kYellow, command(number, league::RobotMove::Kind::kLocal), kBegin)
              .errors[0]
              .code == "UNKNOWN_ROBOT");
}

TEST_CASE("robots and the ball are teleported, and incomplete teleports are refused") {
  BaseWorld world(one_robot(), 0, {}, kBegin);
  LeagueCommands commands(world, false);
  std::optional<double> speed;
  const auto teleport = [&](auto change) {
    league::RobotTeleport robot;
    robot.number = 4;
    robot.x_m = 1, robot.y_m = 2, robot.heading_rad = 3;
    change(robot);
    league::SimulatorCommand command;
    command.robots.push_back(robot);
    return commands.on_control(command, speed).errors;
  };
  CHECK(teleport([](auto&) {}).empty());
  CHECK(world.bodies()[0].position_m() == Vec2(1, 2));
  CHECK(teleport([](auto& robot) { robot.y_m.reset(); })[0].code == "INCOMPLETE_TELEPORT");
  CHECK(teleport([](auto& robot) { robot.x_m = 4.45; })[0].code == "OUTSIDE_FIELD");
  CHECK(teleport([](auto& robot) { robot.number = 9; })[0].code == "UNKNOWN_ROBOT");
  CHECK(teleport([](auto& robot) { robot.is_present = false; }).empty());
  CHECK_FALSE(world.bodies()[0].is_on_floor());
  CHECK(teleport([](auto&) {}).empty());
  CHECK(world.bodies()[0].is_on_floor());
  CHECK_FALSE(speed);

  league::SimulatorCommand command;
  command.ball = league::BallTeleport{Vec2(-1, -1), Vec2(1, 0)};
  command.speed = 0.5;
  command.has_geometry = command.has_robot_specs = true;
  const auto errors = commands.on_control(command, speed).errors;
  CHECK(errors.size() == 2);
  CHECK(speed == 0.5);
  CHECK(world.ball()->state().position_m == Vec2(-1, -1));
}

}  // namespace sidestep::league_commands_test
