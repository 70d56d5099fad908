// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"
#include "idl/disturbance.h"
#include "idl/monitor.h"
#include "idl/robot.h"
#include "simulator/ball.hpp"
#include "simulator/body.hpp"
#include "simulator/contacts.hpp"
#include "simulator/firmware.hpp"
#include "simulator/firmware_monitor.hpp"
#include "simulator/opponents.hpp"

namespace sidestep {

/// The floor: all bodies with their firmware, the ball, the obstacles and the opponents, in steps of
/// kPhysicsStep. Robots go by their index in the scenario's list. Times are by the host's clock; each robot
/// has a clock of its own, which is ahead of it by a constant offset.
class World {
 public:
  World(const Scenario& scenario, Time begin, std::uint64_t seed);

  /// Steps on while a whole step fits before `to`.
  void advance(Time to);
  /// Passes over a time in which nothing is simulated; robots forget what they remembered of their way.
  void skip_to(Time to) { time_ = std::max(time_, to); }
  /// Of the last step.
  Time time() const { return time_; }

  /// A hand does something to a robot; false: it cannot. The message is sound (disturbance_check.hpp).
  bool disturb(std::size_t robot, const msg::Disturbance& what, Time now);

  /// A command reaches a robot at a time not before time(), and less than a step after it.
  void on_command(std::size_t robot, const msg::Command& command, Time now);
  /// A robot's facts, head still to be filled.
  msg::Feedback feedback(std::size_t robot, Time now);

  /// Robots that have switched, broken off, been fenced, lifted or put down since their last clear_news(),
  /// each once.
  std::span<const std::uint32_t> news() const { return news_; }
  void clear_news(std::size_t robot);

  std::size_t robot_count() const { return robots_.size(); }
  RobotId id(std::size_t robot) const { return robots_[robot].id; }
  const Firmware& firmware(std::size_t robot) const { return robots_[robot].firmware; }
  /// When the robot's next held version starts, by the host's clock; Time::max() when none is held.
  Time next_start(std::size_t robot) const;
  std::span<const Body> bodies() const { return bodies_; }
  const std::optional<Ball>& ball() const { return ball_; }
  const ContactTotals& contacts() const { return contacts_.totals(); }
  const Opponents& opponents() const { return opponents_; }
  std::uint64_t firmware_violations() const;
  /// Distance of a body from the version that it executes, by the robot's clock; 0 off the floor.
  double reference_error_m(std::size_t robot) const;

  /// For judges. Everything but the head.
  void fill(msg::GroundTruth& truth) const;

 private:
  struct Robot {
    RobotId id;
    Firmware firmware;
    FirmwareMonitor judge;
    Rng noise;
    double odometry_scale;
    Actuation desired;
    Vec2 last_position_m;
    double last_heading_rad;
    Duration clock_offset;         ///< the robot's clock goes ahead of the host's by so much,
    Time clock;                    ///< but never back
    VersionNumber known_stop = 0;  ///< number of the latest stop of its own that the judge knows
    std::optional<Time> last_hand = std::nullopt;  ///< when one has last done something to its body
    bool has_news = false;
  };
  /// Something that lasts, or waits for its moment.
  struct Effect {
    std::size_t robot;
    msg::DisturbanceKind kind;
    Time until;  ///< when a robot slips no more or its wheel turns again
    Vec2 place_m;
    double heading_rad;
  };
  void step();
  void end_effects();
  bool put_down(const Effect& desired);
  void note_hand(std::size_t robot, Time at);
  /// When the last hand lets go of it.
  std::optional<Time> let_go(std::size_t robot) const;
  void start_effect(const Effect& effect);
  void stop_effects(std::size_t robot, msg::DisturbanceKind kind);
  void lift(std::size_t robot, Time now);
  Time robot_time(std::size_t robot, Time now);
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
  Opponents opponents_;
  std::vector<std::uint32_t> news_;
  std::vector<Effect> effects_;
};

}  // namespace sidestep
