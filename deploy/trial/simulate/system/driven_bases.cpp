// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/system/driven_bases.hpp"

#include <algorithm>

namespace sidestep {

namespace {

/// The index of the robot's base.
std::size_t base_of(const BaseWorld& world, const Scenario& scenario, RobotId robot) {
  return *world.find(find_robot(scenario, robot)->team, number_in_team(robot));
}

}  // namespace

void DirectDriver::send(std::span<const BaseCommand> commands) {
  BaseWorld& world = bases_.world_now();
  for (const BaseCommand& command : commands) {
    const std::size_t robot = base_of(world, scenario_, command.robot);
    world.command(robot, {command.velocity.linear_mps, command.velocity.turn_radps}, bases_.simulated_now());
  }
}

BaseSettings bases_with_latency(Duration latency) {
  // The motors need this long to reach a commanded velocity.
  constexpr Duration kResponse = std::chrono::milliseconds(18);
  BaseSettings bases;
  bases.latency = std::max<Duration>(latency - kResponse, Duration{0});
  return bases;
}

DrivenBases::DrivenBases(Bus& bus, const Scenario& scenario, Duration latency, Incarnation incarnation,
                         std::uint64_t seed)
    : scenario_(scenario),
      bases_(bus, scenario, {.bases = bases_with_latency(latency)}, incarnation, seed),
      driver_(bases_, scenario),
      robots_(bus, scenario, roster_of(scenario), incarnation, drive_settings(scenario, latency), driver_,
              memory_.path()) {}

void DrivenBases::place(RobotId robot, const Vec2& position_m, double heading_rad) {
  BaseWorld& world = bases_.world_now();
  world.place(base_of(world, scenario_, robot), position_m, heading_rad);
}

void DrivenBases::on_event(LogLevel min_level, const OnLogEvent& callback) {
  bases_.on_event(min_level, callback);
  robots_.on_event(min_level, callback);
}

}  // namespace sidestep
