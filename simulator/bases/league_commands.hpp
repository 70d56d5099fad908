// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/league/control_packet.hpp"
#include "simulator/bases/base_world.hpp"

namespace sidestep {

/// Applies the commands of the league's simulation protocol to a world.
class LeagueCommands {
 public:
  /// `accepts_global` also allows velocities in the world frame. The league's simulators accept only local
  /// velocities.
  LeagueCommands(BaseWorld& world, bool accepts_global) : world_(world), accepts_global_(accepts_global) {}

  league::TeamResponse on_team(Team team, const league::TeamCommands& commands, Time now);
  /// `speed` is set if the command changes the simulation's speed.
  league::SimulatorResponse on_control(const league::SimulatorCommand& command, std::optional<double>& speed);

 private:
  void teleport(const league::RobotTeleport& teleport, std::vector<league::SimulatorError>& errors);

  BaseWorld& world_;
  bool accepts_global_;
};

}  // namespace sidestep
