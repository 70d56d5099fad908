// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/adapters/driven_robot.hpp"
#include "common/motion/robot_model.hpp"
#include "common/random/rng.hpp"
#include "tests/unit/common/robot/test_memory.hpp"

namespace sidestep::test {

inline constexpr RobotId kDrivenRobot = 3;
inline constexpr Time kSceneBegin = time_from_ns(1'700'000'000'000'000'000);

/// A driven robot with its agent, and a base that executes commands after the latency.
class DrivenScene {
 public:
  explicit DrivenScene(Duration latency = std::chrono::milliseconds(100))
      : commanded(latency), robot(kDrivenRobot, settings_of(latency), {}, kSceneBegin) {}

  /// Simulates one control period.
  void step() {
    now += DrivenRobot::kPeriod;
    const BodyVelocity command = robot.tick(now, memory);
    commanded.add(now, command);
    const double s = to_seconds(DrivenRobot::kPeriod);
    const BodyVelocity obeyed = commanded.mean(now - DrivenRobot::kPeriod, now);
    velocity_mps = obeyed_fraction * rotated(obeyed.linear_mps, heading_rad + 0.5 * s * obeyed.turn_radps);
    turn_radps = obeyed.turn_radps;
    position_m += s * velocity_mps;
    heading_rad += s * turn_radps;
    if (sees) fix();
  }
  void run(Duration duration) {
    for (const Time end = now + duration; now < end;) step();
  }
  void fix() {
    Command command = bare();
    constexpr Duration kAge = std::chrono::milliseconds(5);
    const double s = to_seconds(kAge);
    command.fix = PoseFix{now - kAge, position_m - s * velocity_mps, heading_rad - s * turn_radps};
    robot.on_command(command, now, memory);
  }
  Command bare() const {
    Command command;
    command.robot = kDrivenRobot;
    command.incarnation = agent;
    command.epoch = epoch;
    command.sent_at = now;
    command.desired_heading_rad = desired_heading_rad;
    return command;
  }
  /// The base reports its odometry, relative to its own frame, with a timestamp that may be wrong.
  void report_odometry(Duration timestamp_error = {}, Duration ago = {}) {
    const double s = to_seconds(ago);
    const Vec2 place_m = rotated(position_m - s * velocity_mps, 1.1) + Vec2(7, 8);
    const double turned_rad = heading_rad - s * turn_radps + 1.1;
    robot.on_odometry({kDrivenRobot, now - ago + timestamp_error, place_m, turned_rad}, now - ago);
  }
  /// Sends a command, which only fences if it contains no version.
  void send(const std::optional<Version>& version) {
    Command command = bare();
    command.version = version;
    robot.on_command(command, now, memory);
  }
  RobotReport robot_report() { return robot.robot_report(now); }

  Time now = kSceneBegin;
  Incarnation agent = 100;
  Epoch epoch = 1;
  double desired_heading_rad = 0.4;
  CommandedMotion commanded;
  robot::test::TestMemory memory;
  DrivenRobot robot;
  Vec2 position_m{1.5, -0.7};
  double heading_rad = 0.4;
  Vec2 velocity_mps{0, 0};  ///< mean over the last period
  double turn_radps = 0;
  double obeyed_fraction = 1;  ///< fraction of the commanded velocity that the base executes
  bool sees = true;            ///< vision sees the robot, and the agent forwards its observations

 private:
  static DriveSettings settings_of(Duration latency) {
    DriveSettings settings;
    settings.latency = latency;
    return settings;
  }
};

/// A version by `agent` that continues `base`: it holds an acceleration, then stops.
inline Version continuation(const Version& base, Incarnation agent, VersionNumber number, Time start,
                            const Vec2& acceleration_mps2, Duration held) {
  const MotionLimits limits;
  const State from = base.trajectory.state_at(start);
  Trajectory trajectory(start, from);
  trajectory.append(held, limit_acceleration(acceleration_mps2, from.velocity_mps, limits, held));
  append_stop(trajectory, limits.deceleration_mps2);
  return {kDrivenRobot, agent, number, base.number, trajectory, base.inflation_m};
}

/// The distance of `position_m` from the version's position at `at`, minus the version's inflation.
inline double beyond_m(const Version& version, const Vec2& position_m, Time at) {
  return (position_m - version.trajectory.state_at(at).position_m).norm() - version.inflation_m;
}

}  // namespace sidestep::test
