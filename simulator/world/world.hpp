// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/protocol/drop_counters.hpp"
#include "common/protocol/robot_disturbance.hpp"
#include "common/random/rng.hpp"
#include "common/time/clock_error.hpp"
#include "idl/monitor.hpp"
#include "simulator/world/ball.hpp"
#include "simulator/world/body.hpp"
#include "simulator/world/contacts.hpp"
#include "simulator/world/firmware.hpp"
#include "simulator/world/firmware_monitor.hpp"
#include "simulator/world/opponents.hpp"
#include "simulator/world/vision_fault.hpp"

namespace sidestep {

/// The simulated floor: all bodies with their firmware, the ball, the obstacles and the opponents, in steps
/// of kPhysicsStep. Robots are addressed by their index in the scenario. Times are by the host's clock, but
/// continue to increase if that clock is set back. Each robot has its own clock.
class World {
 public:
  World(const Scenario& scenario, Time begin, std::uint64_t seed);

  /// Advances in complete steps; the last one ends no later than `to`.
  void advance(Time to);
  /// Skips time without simulating it; pose estimators then discard their odometry history.
  void skip_to(Time to) { time_ = std::max(time_, to); }
  /// The time of the last step.
  Time time() const { return time_; }

  /// Applies a disturbance. Returns false if the robot's state does not allow it. Precondition: the fields
  /// that its kind uses are in range (disturbance_codec.hpp).
  [[nodiscard]] bool disturb(std::size_t robot, const RobotDisturbance& disturbance, Time now);
  /// Whether the robot's state allows the disturbance (FAULT_APPLIED), or why it does not.
  [[nodiscard]] msg::DisturbanceResult check_disturbance(std::size_t robot,
                                                         const RobotDisturbance& disturbance) const;

  /// Delivers a command to a robot. Precondition: time() <= now < time() + kPhysicsStep.
  void on_command(std::size_t robot, const Command& command, Time now);
  /// Delivers a command that could not be decoded, with the same precondition.
  void on_malformed_command(std::size_t robot, Time now);
  /// The robot's clock. If it has gone back by more than the clock bound, the robot begins a new incarnation.
  Time robot_time(std::size_t robot, Time now);
  /// The robot's facts; robot_incarnation is the number of times that the robot has started a new
  /// incarnation.
  RobotReport robot_report(std::size_t robot, Time now);
  /// The host's clock, and with it the clocks of all robots, was set back by this duration. The time of this
  /// world continues.
  void on_host_clock_set_back(Duration by);
  /// The reading of the host's clock at a time of this world.
  Time host_time(Time t) const { return t - host_setback_; }
  /// The time of this world when the host's clock reads `shown`.
  Time world_time(Time shown) const { return shown + host_setback_; }

  /// Robots that have changed version, agent or epoch, or have been lifted or put down, since their last
  /// clear_pending_report(); each listed once.
  std::span<const std::uint32_t> pending_reports() const { return pending_reports_; }
  void clear_pending_report(std::size_t robot);

  std::size_t robot_count() const { return robots_.size(); }
  RobotId id(std::size_t robot) const { return robots_[robot].id; }
  /// Whether the robot has power and a version at its position; otherwise it reports nothing.
  bool may_report(std::size_t robot) const {
    return robots_[robot].is_powered && robots_[robot].firmware.may_report();
  }
  const Firmware& firmware(std::size_t robot) const { return robots_[robot].firmware; }
  /// The start of the robot's next pending version, by the host's clock; Time::max() if none is pending.
  Time next_start(std::size_t robot) const;
  std::span<const Body> bodies() const { return bodies_; }
  /// Faults in how cameras see the robots.
  std::span<const VisionFault> vision_faults() const { return vision_faults_; }
  const std::optional<Ball>& ball() const { return ball_; }
  const ContactTotals& contacts() const { return contacts_.totals(); }
  const Opponents& opponents() const { return opponents_; }
  std::uint64_t firmware_violations() const;
  /// Adds the counts of messages that the robots have refused.
  void count_drops(DropCounters& drops) const;
  /// Distance between a body and the version that it executes, by the robot's clock; 0 off the floor.
  double reference_error_m(std::size_t robot) const;

  /// Fills in everything except the header. Only for metrics and audit.
  void fill(msg::GroundTruth& truth) const;

 private:
  struct Robot {
    RobotId id;
    Firmware firmware;
    FirmwareMonitor monitor;
    Rng noise;
    double odometry_scale;
    Actuation actuation;
    Vec2 last_position_m;  ///< position without slip at the last odometry measurement
    double last_heading_rad;
    ClockError clock_error;      ///< error of the robot's clock relative to the host's
    Time clock;                  ///< latest reading of the robot's clock
    Time read_at = Time::min();  ///< latest time at which the clock was read
    std::uint64_t clock_setbacks = 0;
    VersionNumber last_own_stop = 0;
    /// Time at which the body was last disturbed; active disturbances may end later.
    std::optional<Time> last_disturbance = std::nullopt;
    bool has_pending_report = false;
    bool is_powered = true;
  };
  /// A disturbance with a duration, or a placement that waits for its rest version.
  struct ActiveDisturbance {
    std::size_t robot;
    msg::DisturbanceKind kind;
    Time end;
    Vec2 place_m;
    double heading_rad;
  };
  void step();
  void end_disturbances();
  bool try_put_down(const ActiveDisturbance& request);
  void record_disturbance(std::size_t robot, Time at);
  /// The end, past or future, of the latest disturbance of the robot's body; nullopt if there was none.
  std::optional<Time> disturbance_end(std::size_t robot) const;
  void start_disturbance(const ActiveDisturbance& disturbance);
  void cancel_disturbances(std::size_t robot, msg::DisturbanceKind kind);
  void lift(std::size_t robot, Time now);
  void switch_off(std::size_t robot, Time now);
  void switch_on(std::size_t robot, Time now);
  void set_clock(std::size_t robot, Duration offset, Time now);
  void start_seen_beside(std::size_t robot, const RobotDisturbance& disturbance, Time now);
  /// The index of the other robot of a confusion by cameras; nullopt if they cannot be confused now.
  std::optional<std::size_t> confusable_with(std::size_t robot, const RobotDisturbance& disturbance) const;
  void start_seen_as(std::size_t robot, const RobotDisturbance& disturbance, Time now);
  void start_seen_frozen(std::size_t robot, const RobotDisturbance& disturbance, Time now);
  void end(const ActiveDisturbance& disturbance);
  /// Whether cameras have shown the robot at a wrong place, with no fix at its true place since then.
  bool is_misled_by_cameras(const ActiveDisturbance& disturbance) const;
  /// Whether the disturbance may take the body off its reference.
  bool affects_body(const ActiveDisturbance& disturbance) const;
  void carry(std::size_t robot, const RobotDisturbance& disturbance, Time now);
  void switch_versions(std::size_t robot, Time now);
  void request_report(std::size_t robot);
  Odometry measure(std::size_t robot);

  Field field_;
  std::vector<Shape> obstacles_;
  std::shared_ptr<const FloorMap> map_;
  double radius_m_;
  double velocity_noise_mps_;
  Duration clock_bound_;
  double tracking_bound_m_;
  Time time_;
  Duration host_setback_{0};  ///< total time by which the host's clock has been set back
  std::vector<Body> bodies_;
  std::vector<VisionFault> vision_faults_;
  std::vector<Robot> robots_;
  std::optional<Ball> ball_;
  Contacts contacts_;
  Opponents opponents_;
  std::vector<std::uint32_t> pending_reports_;
  std::vector<ActiveDisturbance> active_disturbances_;
};

}  // namespace sidestep
