// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "idl/monitor.h"
#include "idl/robot.h"
#include "simulator/ball.hpp"
#include "simulator/body.hpp"
#include "simulator/contacts.hpp"
#include "simulator/firmware.hpp"
#include "simulator/firmware_judge.hpp"

namespace sidestep {

/// The floor: all bodies with their firmware, the ball and the obstacles, in steps of kPhysicsStep. Robots go
/// by their index in the scenario's list.
class World {
 public:
  World(const Scenario& scenario, Time begin, std::uint64_t seed);

  /// Steps on while a whole step fits before `to`.
  void advance(Time to);
  /// Passes over a time in which nothing is simulated; robots forget what they remembered of their way.
  void skip_to(Time to) { time_ = std::max(time_, to); }
  /// Of the last step.
  Time time() const { return time_; }

  /// A command reaches a robot at a time not before time(), and less than a step after it.
  void on_command(std::size_t robot, const msg::Command& command, Time now);
  /// A robot's facts, head still to be filled.
  msg::Feedback feedback(std::size_t robot, Time now);

  /// Robots that have switched or been fenced since their last clear_news(), each once.
  std::span<const std::uint32_t> news() const { return news_; }
  void clear_news(std::size_t robot);

  std::size_t robot_count() const { return robots_.size(); }
  RobotId id(std::size_t robot) const { return robots_[robot].id; }
  const Firmware& firmware(std::size_t robot) const { return robots_[robot].firmware; }
  std::span<const Body> bodies() const { return bodies_; }
  const std::optional<Ball>& ball() const { return ball_; }
  const ContactTotals& contacts() const { return contacts_.totals(); }
  std::uint64_t firmware_violations() const;
  /// Distance of a body from the version that it executes.
  double reference_error_m(std::size_t robot) const;

  /// For judges. Everything but the head.
  void fill(msg::GroundTruth& truth) const;

 private:
  struct Robot {
    RobotId id;
    Firmware firmware;
    FirmwareJudge judge;
    Rng noise;
    double odometry_scale;
    Actuation wish;
    Vec2 last_position_m;
    double last_heading_rad;
    bool has_news = false;
  };
  void step();
  void switch_versions(std::size_t robot, Time now);
  void note_news(std::size_t robot);
  Odometry measure(std::size_t robot);

  Field field_;
  std::vector<Circle> obstacles_;
  double radius_m_;
  double velocity_noise_mps_;
  Time time_;
  std::vector<Body> bodies_;
  std::vector<Robot> robots_;
  std::optional<Ball> ball_;
  Contacts contacts_;
  std::vector<std::uint32_t> news_;
};

}  // namespace sidestep
