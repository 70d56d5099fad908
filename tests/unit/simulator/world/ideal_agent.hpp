// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <deque>
#include <optional>

#include "common/config/scenario.hpp"
#include "common/motion/robot_model.hpp"
#include "common/random/rng.hpp"
#include "simulator/world/world.hpp"

namespace sidestep::test {

/// Acts as vision and as an agent without communication delay for one robot of a World. Forwards noisy,
/// delayed fixes. Continues the executed version with random ones, or lets the robot rest. Grants a rest
/// version at `place_m` if the robot is lifted.
class IdealAgent {
 public:
  IdealAgent(const Scenario& scenario, World& world, std::size_t robot, std::uint64_t seed)
      : scenario_(scenario),
        world_(world),
        robot_(robot),
        rng_(seed),
        due_(world.time() + from_seconds(rng_.uniform(0.0, 0.016))),
        home_m_(world.bodies()[robot].position_m()) {}

  bool drives = true;
  Vec2 place_m{0, 0};

  /// Must be called in every step.
  void act(Time now) {
    if (now < due_) return;
    due_ += scenario_.cycle;
    capture(now);
    Command command;
    command.robot = world_.id(robot_);
    command.incarnation = 1;
    command.sent_at = now;
    const auto seen = std::find_if(seen_.rbegin(), seen_.rend(), [&](const PoseFix& fix) {
      return fix.captured_at + scenario_.vision.delay <= now;
    });
    const bool is_missed =
        scenario_.vision.miss_probability > 0 && rng_.chance(scenario_.vision.miss_probability);
    if (seen != seen_.rend() && !is_missed) command.fix = *seen;
    command.version = next_version(world_.robot_report(robot_, now));
    world_.on_command(robot_, command, now);
  }

 private:
  void capture(Time now) {
    const Body& body = world_.bodies()[robot_];
    if (!body.is_on_floor()) return seen_.clear();
    const double sigma = scenario_.vision.position_noise_m;
    PoseFix fix;
    fix.captured_at = now;
    fix.position_m.x() = body.position_m().x() + sigma * rng_.normal();
    fix.position_m.y() = body.position_m().y() + sigma * rng_.normal();
    fix.heading_rad = body.heading_rad() + scenario_.vision.heading_noise_rad * rng_.normal();
    seen_.push_back(fix);
    if (seen_.size() > 100) seen_.pop_front();
  }

  std::optional<Version> next_version(const RobotReport& robot_report) {
    const Version& executing = robot_report.executing;
    const Time start = robot_report.valid_at + scenario_.cycle - 2 * kPhysicsStep;
    newest_ = std::max(newest_, executing.number) + 1;
    if (robot_report.is_lifted) {
      if (executing.number > 0) return std::nullopt;
      return Version{world_.id(robot_), 1, newest_, 0, Trajectory::resting(start, place_m)};
    }
    if (!drives) return std::nullopt;
    const State state = executing.trajectory.state_at(start);
    if (rng_.chance(0.1)) {
      const double angle_rad = rng_.uniform(-3.14159, 3.14159);
      desired_acceleration_ = rotated(Vec2(rng_.uniform(0, 4), 0), angle_rad);
    }
    if ((state.position_m - home_m_).norm() > 3)
      desired_acceleration_ = (home_m_ - state.position_m).normalized() * 3;
    Trajectory trajectory(start, state);
    trajectory.append(scenario_.cycle, limit_acceleration(desired_acceleration_, state.velocity_mps,
                                                          scenario_.limits, scenario_.cycle));
    append_stop(trajectory, scenario_.limits.deceleration_mps2);
    const double inflation_m = state.velocity_mps.isZero() ? 0 : executing.inflation_m;
    return Version{world_.id(robot_), 1, newest_, executing.number, trajectory, inflation_m};
  }

  const Scenario& scenario_;
  World& world_;
  std::size_t robot_;
  Rng rng_;
  Time due_;
  Vec2 home_m_;
  Vec2 desired_acceleration_{0, 0};
  VersionNumber newest_ = 1;
  std::deque<PoseFix> seen_;
};

inline RobotDisturbance disturbance(RobotId robot, msg::DisturbanceKind kind) {
  RobotDisturbance disturbance;
  disturbance.robot = robot;
  disturbance.kind = kind;
  return disturbance;
}

}  // namespace sidestep::test
