// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "agents/agent/displaced_obstacles.hpp"
#include "agents/agent/neighbours.hpp"
#include "agents/agent/observed_obstacles.hpp"
#include "agents/agent/own_reports.hpp"
#include "agents/agent/robot_laser.hpp"
#include "agents/agent/wait_reason.hpp"

namespace sidestep {

/// Everything that an agent knows about its robot and the robot's surroundings. Inputs: reports of the robot,
/// world states and lists of obstacles from vision, scans of the robot's laser, and ledger pages and
/// heartbeats from the coordinator. Outputs: the latest state of each of these, and which of them is too old
/// to drive by. All times are by the robot's clock; `now` is an upper bound of the time.
class Observations {
 public:
  /// `rules` must outlive this object.
  Observations(const FloorSpec& floor, const RobotSpec& robot, const FloorRules& rules);

  void on_robot_report(const RobotReport& robot_report);
  /// Processes a world state. If there is no recent measurement of the robot's clock, the observation is only
  /// forwarded, because a robot that has lost its pose reports nothing until it gets a pose.
  void on_world_state(const WorldObservations& world, Time now, bool is_robot_clock_known);
  void on_obstacles(const ObstacleObservations& list, Time now) {
    obstacles_.on_list(list, own_.estimate().position_m, now);
  }
  /// Precondition: the robot has a laser.
  void on_scan(const LaserScan& scan, Time now) { laser_->on_scan(scan, neighbours_, now); }
  void on_page(const ReceivedPage& page) { neighbours_.on_page(page); }
  /// How far away neighbours are noticed from the next report on. At least page_horizon_m().
  void set_view(double view_m) { view_m_ = view_m; }
  /// Processes a heartbeat of the coordinator in charge.
  void on_heartbeat(const CoordinatorHeartbeat& heartbeat, Time now);

  /// The first reason in WaitReason, from kNotSeen on, why the robot must not drive; kNone if all
  /// observations are recent.
  WaitReason wait_reason(Time now) const;
  /// Whether vision works, but the coordinator does not receive it.
  bool is_coordinator_without_vision(Time now) const;
  /// Whether the robot is at rest at the end of `base`, and vision agrees with the robot's own position
  /// estimate. A version that starts there needs no inflation.
  bool may_end_inflation(const Version& base, Time start) const;
  /// Removes and returns the latest observation of the robot.
  std::optional<PoseFix> take_fix() { return std::exchange(fix_, std::nullopt); }

  const OwnReports& own() const { return own_; }
  Neighbours& neighbours() { return neighbours_; }
  ObservedObstacles& obstacles() { return obstacles_; }
  DisplacedObstacles& displaced() { return displaced_; }
  /// nullptr if the robot has no laser.
  const RobotLaser* laser() const { return laser_ ? &*laser_ : nullptr; }

  void count_drops(DropCounters& drops) const;

 private:
  bool is_seen(Time now) const;
  bool is_watched(Time now) const;

  Duration max_clock_difference_;  // of two clocks that both stay within the clock bound
  double view_m_;
  OwnReports own_;
  Neighbours neighbours_;
  ObservedObstacles obstacles_;
  DisplacedObstacles displaced_;
  std::optional<RobotLaser> laser_;
  std::optional<PoseFix> fix_;  // observed but not yet forwarded
  Time last_fix_{};
  Vec2 last_fix_m_{0, 0};
  bool is_seen_elsewhere_ = false;  // vision's latest observations of the robot agree on another place
  Time watched_until_{};            // last time at which the coordinator compared robots with their versions
  std::uint64_t invalid_ = 0;       // number of observations from the future
};

}  // namespace sidestep
