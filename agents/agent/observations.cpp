// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/observations.hpp"

#include <algorithm>

#include "agents/agent/planning_distances.hpp"
#include "common/time/clock_bounds.hpp"

namespace sidestep {
namespace {

/// A robot stops if, for longer than this, vision has not observed it or its agent has received no list of
/// obstacles.
constexpr Duration kMaxFixAge{300'000'000};
/// A robot stops if the coordinator has not compared any robots with their versions for longer than this.
constexpr Duration kMaxWatchAge{600'000'000};

/// Whether a time is recent. A time ahead by more than `max_lead` means that a clock has been set.
bool is_recent(Time t, Time now, Duration max_age, Duration max_lead) {
  return t <= now + max_lead && now - t <= max_age;
}

}  // namespace

Observations::Observations(const FloorSpec& floor, const RobotSpec& robot, const FloorRules& rules)
    : max_clock_difference_(max_clock_difference(floor.clock_bound_s)),
      view_m_(page_horizon_m(rules)),
      own_({robot.start_m, Vec2::Zero()}, drift_bound_m(floor.tracking_bound_m)),
      neighbours_(robot.id),
      obstacles_(floor.max_opponent_speed_mps, max_clock_difference_),
      displaced_(robot.id, floor.radius_m, floor.margin_m,
                 std::max(floor.max_opponent_speed_mps, floor.limits.speed_mps), max_clock_difference_) {
  neighbours_.set_horizon(robot.start_m, view_m_);
  if (floor.laser) laser_.emplace(floor, rules);
}

void Observations::on_robot_report(const RobotReport& robot_report) {
  own_.on_robot_report(robot_report);
  neighbours_.set_horizon(own_.estimate().position_m, view_m_);
}

void Observations::on_world_state(const WorldObservations& world, Time now, bool is_robot_clock_known) {
  // The robot's clock was ahead when the last fix was accepted.
  if (is_robot_clock_known && last_fix_ > now + max_clock_difference_) last_fix_ = {};
  if (!world.self) return;
  const Time captured_at = world.self->captured_at;
  const bool is_ahead =
      is_robot_clock_known ? captured_at > now + max_clock_difference_ : !is_plausible(captured_at, now);
  if (is_ahead) {
    ++invalid_;
    return;
  }
  obstacles_.on_world_state(world);
  // World states may overtake each other: only a later observation of the robot at its own place reassures.
  if (captured_at > last_fix_) is_seen_elsewhere_ = false;
  if (captured_at >= last_fix_) is_seen_elsewhere_ |= world.is_self_seen_elsewhere;
  if (captured_at <= last_fix_) return;
  fix_ = world.self;
  if (!is_robot_clock_known) return;
  last_fix_ = captured_at;
  last_fix_m_ = fix_->position_m;
}

void Observations::on_heartbeat(const CoordinatorHeartbeat& heartbeat, Time now) {
  displaced_.on_heartbeat(heartbeat, now);
  watched_until_ = heartbeat.watched_until;
}

bool Observations::is_seen(Time now) const {
  return is_recent(last_fix_, now, kMaxFixAge, max_clock_difference_);
}

bool Observations::is_watched(Time now) const {
  return is_recent(watched_until_, now, kMaxWatchAge, max_clock_difference_);
}

WaitReason Observations::wait_reason(Time now) const {
  if (!is_seen(now)) return WaitReason::kNotSeen;
  if (is_seen_elsewhere_) return WaitReason::kSeenElsewhere;
  if (laser_ && !is_recent(laser_->sight().captured_at(), now, kMaxFixAge, max_clock_difference_))
    return WaitReason::kNoScan;
  if (!laser_ &&
      !is_recent(obstacles_.complete_at(), now, kMaxFixAge, max_vision_lead(max_clock_difference_)))
    return WaitReason::kNoObstacleList;
  return is_watched(now) ? WaitReason::kNone : WaitReason::kNotWatched;
}

bool Observations::is_coordinator_without_vision(Time now) const { return is_seen(now) && !is_watched(now); }

bool Observations::may_end_inflation(const Version& base, Time start) const {
  const bool is_at_rest = start >= base.trajectory.end();
  const bool was_observed_at_rest = last_fix_ > base.trajectory.end();
  const bool agrees = own_.agrees_with(last_fix_m_);
  return is_at_rest && was_observed_at_rest && agrees;
}

void Observations::count_drops(DropCounters& drops) const {
  const std::uint64_t future_scans = laser_ ? laser_->invalid() : 0;
  drops.count(DropReason::kFutureObservation, std::nullopt, invalid_);
  drops.count(DropReason::kFutureObstacles, std::nullopt, obstacles_.invalid() + future_scans);
  neighbours_.count_drops(drops);
}

}  // namespace sidestep
