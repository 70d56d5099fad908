// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/config/scenario.hpp"
#include "idl/monitor.hpp"
#include "simulator/bases/base_control.hpp"
#include "simulator/world/ball.hpp"
#include "simulator/world/body.hpp"
#include "simulator/world/contacts.hpp"

namespace sidestep {

/// A floor whose robots have no firmware and are driven by velocity commands from external programs. It
/// contains the robots of a scenario, and opponents that fill up the teams. Time advances in steps of
/// kPhysicsStep.
class BaseWorld {
 public:
  /// Creates the scenario's robots, and opponents at the field's upper edge until each team has `team_size`
  /// robots. Throws std::invalid_argument if two robots have the same team and number.
  BaseWorld(const Scenario& scenario, std::uint32_t team_size, const BaseSettings& settings, Time begin);

  void advance(Time to);
  Time time() const { return time_; }

  /// The scenario with the opponents among its robots.
  const Scenario& floor() const { return floor_; }
  /// Number of the scenario's robots; they come before the opponents.
  std::size_t scenario_robot_count() const { return scenario_robot_count_; }
  std::optional<std::size_t> find(Team team, std::uint32_t number) const;
  void command(std::size_t robot, const BaseVelocity& velocity, Time now) {
    controls_[robot].command(velocity, now);
  }
  /// Puts a robot elsewhere, at rest. Ground truth reports it as disturbed at that time.
  void place(std::size_t robot, const Vec2& position_m, double heading_rad);
  void remove(std::size_t robot);
  void set_ball(const State& state);
  /// Kicks the ball if it is at the robot's front. Returns whether it was kicked.
  bool kick(std::size_t robot, double speed_mps);
  bool has_ball(std::size_t robot) const;

  std::span<const Body> bodies() const { return bodies_; }
  const std::optional<Ball>& ball() const { return ball_; }

  /// Fills in everything except the header. Counts contacts of the scenario's robots with each other and with
  /// obstacles, and crashes of these robots with opponents. Only for metrics and audit.
  void fill(msg::GroundTruth& truth) const;

 private:
  void step();
  void measure_clearance();
  void count_contacts(const std::vector<double>& speeds_mps);
  bool is_ours(std::size_t robot) const { return robot < scenario_robot_count_; }

  std::size_t scenario_robot_count_;  ///< the scenario's robots come first
  Scenario floor_;
  BaseSettings settings_;
  Time time_;
  std::vector<Body> bodies_;
  std::vector<BaseControl> controls_;
  std::vector<Time> pushed_at_;                 ///< time at which an opponent last touched each robot
  std::vector<std::optional<Time>> placed_at_;  ///< time at which each robot was last put elsewhere
  std::optional<Ball> ball_;
  Contacts contacts_;
  std::uint64_t seen_contacts_ = 0;
  std::vector<double> speeds_mps_;
  std::uint64_t contact_count_ = 0, crashes_ = 0, moving_crashes_ = 0;
  std::array<ContactPair, msg::MAX_CONTACTS> recent_contacts_{};
  std::array<RobotId, msg::MAX_CONTACTS> recent_moving_crashes_{};
  double max_crash_mps_ = 0;
  double min_clearance_m_ = 1;  ///< minimum clearance between the scenario's robots
};

}  // namespace sidestep
