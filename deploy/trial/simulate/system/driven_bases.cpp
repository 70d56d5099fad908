// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/system/driven_bases.hpp"

#include <algorithm>

namespace sidestep {

void DirectDriver::send(std::span<const BaseCommand> commands) {
  BaseWorld& world = bases_.world_now();
  for (const BaseCommand& command : commands) {
    const auto robot = world.find(find_robot(scenario_, command.robot)->team, number_in_team(command.robot));
    world.command(*robot, {command.velocity.linear_mps, command.velocity.turn_radps}, bases_.simulated_now());
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
    : bases_(bus, scenario, {.bases = bases_with_latency(latency)}, incarnation, seed),
      driver_(bases_, scenario),
      robots_(bus, scenario, roster_of(scenario), incarnation, drive_settings(scenario, latency), driver_,
              memory_.path()) {}

void DrivenBases::on_event(LogLevel min_level, const OnLogEvent& callback) {
  bases_.on_event(min_level, callback);
  robots_.on_event(min_level, callback);
}

}  // namespace sidestep
