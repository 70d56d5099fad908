// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/motion/robot_model.hpp"
#include "common/random/rng.hpp"
#include "simulator/world/world.hpp"

namespace sidestep::test {

/// Acts as agent, coordinator and vision for one robot of a World. In every cycle, sends a random version 0.3
/// to 15 ms before its start. Loses some versions, and forwards noisy fixes.
class RandomDrive {
 public:
  RandomDrive(const Scenario& scenario, World& world, std::size_t robot, std::uint64_t seed)
      : scenario_(scenario),
        world_(world),
        robot_(robot),
        rng_(seed),
        begin_(world.time()),
        frame_due_(begin_) {
    held_ = world.firmware(robot).executing();
    home_m_ = world.bodies()[robot].position_m();
    plan_next();
  }

  /// Time at which the next call of act() is due.
  Time due() const { return std::min(send_at_, frame_due_); }

  void act(Time now) {
    if (frame_due_ <= now) capture();
    if (send_at_ <= now) {
      send(now);
      plan_next();
    }
  }

 private:
  void capture() {
    if (!rng_.chance(scenario_.vision.miss_probability)) {
      const Body& body = world_.bodies()[robot_];
      const double sigma = scenario_.vision.position_noise_m;
      PoseFix fix;
      fix.captured_at = world_.time();
      fix.position_m.x() = body.position_m().x() + sigma * rng_.normal();
      fix.position_m.y() = body.position_m().y() + sigma * rng_.normal();
      fix.heading_rad = body.heading_rad() + scenario_.vision.heading_noise_rad * rng_.normal();
      seen_.push_back(fix);
    }
    frame_due_ += from_seconds(1 / scenario_.vision.rate_hz);
  }

  void plan_next() {
    ++cycle_;
    start_ = begin_ + cycle_ * scenario_.cycle;
    send_at_ = start_ - from_seconds(rng_.uniform(0.0003, 0.015));
  }

  void send(Time now) {
    if (rng_.chance(scenario_.command_loss)) return;
    Command command;
    command.robot = world_.id(robot_);
    command.incarnation = 1;
    while (!seen_.empty() && seen_.front().captured_at + scenario_.vision.delay <= now) {
      command.fix = seen_.front();
      seen_.pop_front();
    }
    command.desired_heading_rad = heading_rad_;
    held_ = next_version();
    command.version = held_;
    world_.on_command(robot_, command, now);
  }

  Version next_version() {
    const State state = held_.trajectory.state_at(start_);
    // The desired acceleration changes rarely, so that the robot reaches its maximum speed. It points home if
    // the robot is far away.
    if (rng_.chance(0.3)) {
      const double angle_rad = rng_.uniform(-3.14159, 3.14159);
      desired_acceleration_ = rotated(Vec2(rng_.chance(0.8) ? 20 : rng_.uniform(0, 5), 0), angle_rad);
      heading_rad_ = rng_.uniform(-3.14159, 3.14159);
    }
    if ((state.position_m - home_m_).norm() > 3)
      desired_acceleration_ = (home_m_ - state.position_m).normalized() * 20;
    Trajectory trajectory(start_, state);
    trajectory.append(scenario_.cycle, limit_acceleration(desired_acceleration_, state.velocity_mps,
                                                          scenario_.limits, scenario_.cycle));
    append_stop(trajectory, scenario_.limits.deceleration_mps2);
    return {world_.id(robot_), 1, held_.number + 1, held_.number, trajectory};
  }

  const Scenario& scenario_;
  World& world_;
  std::size_t robot_;
  Rng rng_;
  Time begin_;
  Time frame_due_;
  Time send_at_;
  Time start_;
  std::int64_t cycle_ = 0;
  Version held_;
  Vec2 home_m_;
  Vec2 desired_acceleration_{0, 0};
  double heading_rad_ = 0;
  std::deque<PoseFix> seen_;
};

/// Robots that are far enough apart to drive without ever meeting.
inline Scenario separated_robots(int count) {
  Scenario scenario;
  scenario.name = "separated";
  scenario.field = {1000, 1000};
  for (int i = 0; i < count; ++i) {
    RobotSpec robot;
    robot.id = static_cast<RobotId>(i);
    robot.start_m = Vec2(10.0 * i - 5.0 * count, 0);
    robot.goals.push_back({robot.start_m, {}});
    scenario.robots.push_back(robot);
  }
  return scenario;
}

}  // namespace sidestep::test
