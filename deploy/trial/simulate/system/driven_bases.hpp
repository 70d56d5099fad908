// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/adapters/robot_driver_node.hpp"
#include "common/file/temporary_folder.hpp"
#include "simulator/bases/velocity_robot_sim_node.hpp"

namespace sidestep {

/// Drives simulated bases directly, without a protocol in between, as if by cable.
class DirectDriver : public Driver {
 public:
  /// `bases` must outlive the driver.
  DirectDriver(VelocityRobotSimNode& bases, const Scenario& scenario) : bases_(bases), scenario_(scenario) {}

  void send(std::span<const BaseCommand> commands) override;

 private:
  VelocityRobotSimNode& bases_;
  const Scenario scenario_;
};

/// The motors of simulated bases need about this long to reach a commanded velocity.
inline constexpr Duration kMotorResponse = std::chrono::milliseconds(18);

/// Bases, and what the process that drives them is told about them.
struct DrivenBaseSettings {
  BaseFloorSettings floor{};
  Duration latency = DriveSettings{}.latency;
  double turn_radps = DriveSettings{}.turn_radps;
};

/// Bases that reach their commanded velocity this long after the command, as far as their acceleration
/// permits, driven with that latency.
DrivenBaseSettings bases_with_latency(Duration latency);

/// Robots without firmware, in one process with the code that sidestep-robot runs for them: they obey their
/// commands after a latency. Their memory ends with the process.
class DrivenBases {
 public:
  /// The bus must make no callback after the destruction.
  DrivenBases(Bus& bus, const Scenario& scenario, const DrivenBaseSettings& settings, Incarnation incarnation,
              std::uint64_t seed);

  /// Puts a base elsewhere, at rest; neither the robot nor its odometry notices it.
  void place(RobotId robot, const Vec2& position_m, double heading_rad);
  void on_event(LogLevel min_level, const OnLogEvent& callback);

 private:
  const Scenario scenario_;
  TemporaryFolder memory_;
  VelocityRobotSimNode bases_;
  DirectDriver driver_;
  RobotDriverNode robots_;
};

}  // namespace sidestep
