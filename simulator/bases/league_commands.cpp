// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/league_commands.hpp"

#include <fmt/format.h>

namespace sidestep {
namespace {

const char* name_of(Team team) { return team == Team::kBlue ? "blue" : "yellow"; }

}  // namespace

league::TeamResponse LeagueCommands::on_team(Team team, const league::TeamCommands& commands, Time now) {
  league::TeamResponse response;
  for (const league::RobotCommand& command : commands.robots) {
    const auto robot = world_.find(team, command.number);
    if (!robot || !world_.bodies()[*robot].is_on_floor()) {
      response.errors.push_back(
          {"UNKNOWN_ROBOT", fmt::format("there is no {} robot {}", name_of(team), command.number)});
      continue;
    }
    if (command.move) {
      const bool is_global = command.move->kind == league::RobotMove::Kind::kGlobal;
      const bool is_accepted =
          command.move->kind == league::RobotMove::Kind::kLocal || (is_global && accepts_global_);
      if (is_accepted)
        world_.command(*robot, {command.move->linear_mps, command.move->turn_radps, is_global}, now);
      else
        response.errors.push_back(
            {"UNSUPPORTED_VELOCITY",
             fmt::format("{} robot {}: only local velocities are accepted", name_of(team), command.number)});
    }
    if (command.kick_mps > 0) world_.kick(*robot, command.kick_mps);
    response.feedback.push_back({command.number, world_.has_ball(*robot)});
  }
  return response;
}

league::SimulatorResponse LeagueCommands::on_control(const league::SimulatorCommand& command,
                                                     std::optional<double>& speed) {
  league::SimulatorResponse response;
  const auto refuse = [&](const char* what) {
    response.errors.push_back({"UNSUPPORTED_CONFIG", fmt::format("the scenario determines {}", what)});
  };
  for (const league::RobotTeleport& robot : command.robots) teleport(robot, response.errors);
  if (command.ball) {
    const State now = world_.ball() ? world_.ball()->state() : State{};
    world_.set_ball(
        {command.ball->position_m.value_or(now.position_m), command.ball->velocity_mps.value_or(Vec2(0, 0))});
  }
  if (command.speed && *command.speed > 0)
    speed = *command.speed;
  else if (command.speed)
    response.errors.push_back({"INVALID_SPEED", "the speed must be above 0"});
  if (command.has_geometry) refuse("field and cameras");
  if (command.has_robot_specs) refuse("robots");
  if (command.has_realism) refuse("noise and delays");
  if (command.vision_port) refuse("address and port of vision packets");
  return response;
}

void LeagueCommands::teleport(const league::RobotTeleport& teleport,
                              std::vector<league::SimulatorError>& errors) {
  const auto robot = world_.find(teleport.team, teleport.number);
  const std::string name = fmt::format("{} robot {}", name_of(teleport.team), teleport.number);
  if (!robot) {
    errors.push_back({"UNKNOWN_ROBOT", "there is no " + name});
  } else if (teleport.is_present == false) {
    world_.remove(*robot);
  } else if (!teleport.x_m || !teleport.y_m || !teleport.heading_rad) {
    errors.push_back({"INCOMPLETE_TELEPORT", name + ": x, y and orientation are required"});
  } else if (!world_.floor().field.contains({*teleport.x_m, *teleport.y_m}, world_.floor().radius_m)) {
    errors.push_back({"OUTSIDE_FIELD", fmt::format("{}: ({:.3f}, {:.3f}) is not on the field", name,
                                                   *teleport.x_m, *teleport.y_m)});
  } else {
    world_.place(*robot, {*teleport.x_m, *teleport.y_m}, *teleport.heading_rad);
  }
}

}  // namespace sidestep
