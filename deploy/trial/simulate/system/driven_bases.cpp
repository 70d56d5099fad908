// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/system/driven_bases.hpp"

#include <algorithm>

namespace sidestep {

namespace {

/// The index of the robot's base.
std::size_t base_of(const BaseWorld& world, const Scenario& scenario, RobotId robot) {
  return *world.find(find_robot(scenario, robot)->team, number_in_team(robot));
}

DriveSettings drive_settings_for(const Scenario& scenario, const DrivenBaseSettings& bases) {
  DriveSettings settings = drive_settings(scenario, bases.latency);
  settings.turn_radps = bases.turn_radps;
  return settings;
}

}  // namespace

void DirectDriver::send(std::span<const BaseCommand> commands) {
  BaseWorld& world = bases_.world_now();
  for (const BaseCommand& command : commands) {
    const std::size_t robot = base_of(world, scenario_, command.robot);
    world.command(robot, {command.velocity.linear_mps, command.velocity.turn_radps}, bases_.simulated_now());
  }
}

DrivenBaseSettings bases_with_latency(Duration latency) {
  DrivenBaseSettings bases;
  bases.floor.bases.latency = std::max<Duration>(latency - kMotorResponse, Duration{0});
  bases.latency = latency;
  return bases;
}

DrivenBases::DrivenBases(Bus& bus, const Scenario& scenario, const DrivenBaseSettings& settings,
                         Incarnation incarnation, std::uint64_t seed)
    : scenario_(scenario),
      bases_(bus, scenario, settings.floor, incarnation, seed),
      driver_(bases_, scenario),
      robots_(bus, scenario, roster_of(scenario), incarnation, drive_settings_for(scenario, settings),
              driver_, memory_.path()) {}

void DrivenBases::place(RobotId robot, const Vec2& position_m, double heading_rad) {
  BaseWorld& world = bases_.world_now();
  world.place(base_of(world, scenario_, robot), position_m, heading_rad);
}

void DrivenBases::on_event(LogLevel min_level, const OnLogEvent& callback) {
  bases_.on_event(min_level, callback);
  robots_.on_event(min_level, callback);
}

}  // namespace sidestep
