// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/firmware.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kMaxInflation_m = 1;
// A robot without a pose is at rest if its wheels have been slower than this for so long. The velocity
// estimate, which begins at zero, converges in less.
constexpr double kRestSpeed_mps = 0.02;
constexpr Duration kRestTime = std::chrono::milliseconds(100);
// Of the first fix of a robot that has just come to rest, per axis.
constexpr double kFirstFixDeviation_m = 0.002;

}  // namespace

Firmware::Firmware(RobotId robot, const Vec2& start_m, double heading_rad, Time now,
                   const FirmwareSettings& settings)
    : robot_(robot),
      executing_{robot, 0, 0, 0, Trajectory::resting(Time{}, start_m)},
      settings_(settings),
      decay_(std::exp(-kPhysicsStepSeconds / settings.body.lag_s)),
      // A command is held for a whole period and so acts half a period late on average.
      look_ahead_(from_seconds(settings.body.lag_s) + kPhysicsStep / 2),
      max_position_error_m_(settings.body.acceleration_mps2 *
                            std::pow(settings.velocity_gain_ps / settings.position_gain_ps2, 2)),
      estimator_(start_m, heading_rad, now, settings.estimator),
      target_heading_rad_(heading_rad) {}

void Firmware::on_command(const Command& command, Time now) {
  while (switch_next(now)) {
  }
  highest_seen_ =
      std::max({highest_seen_, command.incarnation, command.version ? command.version->number : 0});
  if (command.incarnation < obeyed_) {
    ++counts_.refused_fenced;
    return;
  }
  obey(command.incarnation);
  last_command_ = {command.sent_at, now};
  // A new agent may not know the latest epoch that the robot learned from an earlier agent. Its versions are
  // refused until it learns that epoch from feedback.
  const bool is_old_epoch = command.epoch < obeyed_epoch_;
  obeyed_epoch_ = std::max(obeyed_epoch_, command.epoch);
  target_heading_rad_ = wrapped_rad(command.desired_heading_rad);
  if (command.fix && !has_pose_)
    find_pose(*command.fix, now);
  else if (command.fix)
    estimator_.correct(command.fix->captured_at, command.fix->position_m, command.fix->heading_rad);
  if (!command.version) return;
  if (is_old_epoch) {
    ++counts_.refused_fenced;
  } else {
    take(*command.version, now);
  }
}

void Firmware::on_malformed_command(Time now) {
  while (switch_next(now)) {
  }
  ++counts_.refused_malformed;
}

void Firmware::obey(Incarnation incarnation) {
  if (incarnation == obeyed_) return;
  obeyed_ = incarnation;
  for (int i = pending_count_ - 1; i >= 0; --i) {
    if (pending_[static_cast<std::size_t>(i)].incarnation < obeyed_) {
      remove_pending(i);
      ++counts_.refused_fenced;
    }
  }
}

void Firmware::take(const Version& version, Time now) {
  if (holds(version.number)) return;
  if (version.incarnation < obeyed_) {
    ++counts_.refused_fenced;
  } else if (version.trajectory.start() <= now) {
    ++counts_.refused_late;
  } else if (!may_take(version)) {
    ++counts_.refused_base;  // its base is older than the version being executed
  } else {
    insert(version);
  }
}

bool Firmware::may_take(const Version& version) const {
  if (!has_pose_ || version.number <= highest_executed_) return false;
  const Trajectory& trajectory = version.trajectory;
  const bool is_rest_version = trajectory.phases().empty() && trajectory.at_start().velocity_mps.isZero(0);
  return !is_lifted_ || (version.base == 0 && is_rest_version);
}

void Firmware::insert(const Version& version) {
  const auto later = [](const Version& a, const Version& b) {
    if (a.trajectory.start() != b.trajectory.start()) return a.trajectory.start() > b.trajectory.start();
    return a.number > b.number;
  };
  if (pending_count_ == kMaxPending) {
    ++counts_.refused_base;
    if (!later(pending_.back(), version)) return;
    --pending_count_;
  }
  int place = pending_count_;
  for (; place > 0 && later(pending_[static_cast<std::size_t>(place - 1)], version); --place) {
    pending_[static_cast<std::size_t>(place)] = pending_[static_cast<std::size_t>(place - 1)];
  }
  pending_[static_cast<std::size_t>(place)] = version;
  ++pending_count_;
}

void Firmware::remove_pending(int index) {
  std::move(pending_.begin() + index + 1, pending_.begin() + pending_count_, pending_.begin() + index);
  --pending_count_;
}

bool Firmware::holds(VersionNumber number) const {
  return number == executing_.number ||
         std::any_of(pending_.begin(), pending_.begin() + pending_count_,
                     [number](const Version& held) { return held.number == number; });
}

bool Firmware::switch_next(Time now) {
  while (pending_count_ > 0 && pending_[0].trajectory.start() <= now) {
    const Version due = pending_[0];
    remove_pending(0);
    if (due.base == executing_.number && due.number > highest_executed_) {
      executing_ = due;
      highest_executed_ = due.number;
      has_moved_ = true;
      is_off_reference_ = false;
      ++counts_.activated;
      return true;
    }
    ++counts_.refused_base;
  }
  return false;
}

const Trajectory& Firmware::planned(Time t) const {
  const Version* planned = &executing_;
  for (int i = 0; i < pending_count_; ++i) {
    const Version& held = pending_[static_cast<std::size_t>(i)];
    if (held.trajectory.start() > t) break;
    if (held.base == planned->number) planned = &held;
  }
  return planned->trajectory;
}

Actuation Firmware::tick(Time now, const Odometry& odometry) {
  while (switch_next(now)) {
  }
  auto& modelled = modelled_.acceleration_mps2;
  auto& modelled_angular = modelled_.angular_acceleration_radps2;
  modelled = last_actuation_.acceleration_mps2 + (modelled - last_actuation_.acceleration_mps2) * decay_;
  modelled_angular = last_actuation_.angular_acceleration_radps2 +
                     (modelled_angular - last_actuation_.angular_acceleration_radps2) * decay_;
  estimator_.advance(now, odometry, modelled, modelled_angular);

  if (is_lifted_) return last_actuation_ = {};
  if (!has_pose_) return last_actuation_ = brake_by_wheels(now);
  const bool may_stop = now > last_fact_ && now > executing_.trajectory.start();
  if (is_rebooting_ && may_stop) restart(now);

  State reference = executing_.trajectory.state_at(now);
  const auto reason = must_stop(estimator_.position_m() - reference.position_m, now);
  if (reason && may_stop) {
    start_own_stop(*reason, now);
    reference = executing_.trajectory.at_start();
  }

  // With a motor lag T, p + T v and v + T a respond to the commanded acceleration as a double integrator
  // without lag.
  const double lag = settings_.body.lag_s;
  const Motion ahead = planned(now + look_ahead_).motion_at(now + look_ahead_);
  Vec2 position_error = reference.position_m + lag * reference.velocity_mps -
                        (estimator_.position_m() + lag * estimator_.velocity_mps());
  // With these gains both the speed of the approach and its deceleration are proportional to the distance.
  // The distance is clamped so that the motors can provide that deceleration; without the clamp a robot far
  // from its reference would overshoot and oscillate about it.
  if (position_error.squaredNorm() > max_position_error_m_ * max_position_error_m_)
    position_error *= max_position_error_m_ / position_error.norm();
  const Vec2 velocity_error = ahead.state.velocity_mps - (estimator_.velocity_mps() + lag * modelled);
  Vec2 acceleration = ahead.acceleration_mps2 + settings_.position_gain_ps2 * position_error +
                      settings_.velocity_gain_ps * velocity_error;
  const double max_acceleration = settings_.body.acceleration_mps2;
  if (acceleration.squaredNorm() > max_acceleration * max_acceleration)
    acceleration *= max_acceleration / acceleration.norm();

  double heading_error = target_heading_rad_ - estimator_.heading_rad();
  if (std::abs(heading_error) > 3) heading_error = wrapped_rad(heading_error);
  const double turn_rate = std::clamp(settings_.heading_gain_ps * heading_error,
                                      -settings_.turning_speed_radps, settings_.turning_speed_radps);
  const double max_angular = settings_.body.angular_acceleration_radps2;
  last_actuation_ = {acceleration,
                     std::clamp(settings_.turning_gain_ps * (turn_rate - estimator_.angular_radps()),
                                -max_angular, max_angular)};
  return last_actuation_;
}

// The uncertainty counts for at most half of the bound, so that a robot is not off its reference merely
// because no camera sees it.
bool Firmware::is_beyond(double bound_m, const Vec2& error_m) const {
  const double half_m = 0.5 * bound_m;
  if (error_m.squaredNorm() < half_m * half_m) return false;
  return error_m.norm() + std::min(2 * estimator_.position_error_rms_m(), half_m) >
         bound_m + executing_.inflation_m;
}

// A fix may reveal all drift since the last one at once. The control corrects it before a message could reach
// the other robots, and an unexpected stop would endanger them. So the robot stops only for an error that the
// control cannot correct in time, or that the margin does not cover.
std::optional<OwnStopReason> Firmware::must_stop(const Vec2& error_m, Time now) {
  // Inflation covers where the robot may be, not the way back to its reference.
  const double drift_m = drift_bound_m(settings_.tracking_bound_m);
  if (estimator_.jump_m() > 0 && error_m.norm() > drift_m) return OwnStopReason::kDisplaced;
  if (!is_beyond(drift_m, error_m)) {
    drifted_since_ = Time::max();
    return std::nullopt;
  }
  drifted_since_ = std::min(drifted_since_, now);
  if (is_beyond(settings_.tracking_bound_m, error_m)) return OwnStopReason::kOffReference;
  if (estimator_.jump_m() > 0) return OwnStopReason::kDisplaced;
  if (now - drifted_since_ >= kMaxRecovery) return OwnStopReason::kDrifted;
  return std::nullopt;
}

void Firmware::start_own_stop(OwnStopReason reason, Time now) {
  own_stop_reason_ = reason;
  drifted_since_ = Time::max();
  Version stop;
  stop.robot = robot_;
  stop.incarnation = obeyed_;
  highest_seen_ = std::max(highest_seen_, highest_executed_) + kOwnNumberGap;
  stop.number = highest_seen_;
  stop.base = executing_.number;
  stop.trajectory = Trajectory(now, {estimator_.position_m(), estimator_.velocity_mps()});
  append_stop(stop.trajectory, settings_.deceleration_mps2);
  // Includes the last displacement, because its cause may act again before the next fix.
  stop.inflation_m = std::min(2 * estimator_.position_error_rms_m() + estimator_.jump_m(), kMaxInflation_m);
  executing_ = stop;
  highest_executed_ = stop.number;
  is_off_reference_ = true;
  pending_count_ = 0;
  ++own_stops_;
}

void Firmware::lift(Time now) {
  is_lifted_ = true;
  is_rebooting_ = false;
  has_pose_ = true;  // a lifted robot needs none until it is put down
  is_off_reference_ = false;
  pending_count_ = 0;
  executing_ = {robot_, 0, 0, highest_executed_, Trajectory::resting(now, estimator_.position_m()), 0};
}

void Firmware::put_down(double heading_rad, Time now) {
  is_lifted_ = false;
  target_heading_rad_ = heading_rad;
  estimator_ = PoseEstimator(executing_.trajectory.rest_position_m(), heading_rad, now, settings_.estimator);
  last_actuation_ = modelled_ = {};
}

void Firmware::switch_on(Time now) {
  estimator_ = PoseEstimator(estimator_.position_m(), estimator_.heading_rad(), now, settings_.estimator);
  last_actuation_ = modelled_ = {};
  pending_count_ = 0;
  is_rebooting_ = !is_lifted_ && has_pose_;
  moved_at_ = now;
}

void Firmware::forget_pose(Time now) {
  estimator_ = PoseEstimator(Vec2(0, 0), 0, now, settings_.estimator);
  last_actuation_ = modelled_ = {};
  pending_count_ = 0;
  is_rebooting_ = false;
  has_pose_ = false;
  moved_at_ = now;
}

Actuation Firmware::brake_by_wheels(Time now) {
  const Vec2& velocity = estimator_.velocity_mps();
  if (velocity.norm() > kRestSpeed_mps) moved_at_ = now;
  const double lag = settings_.body.lag_s;
  Vec2 braking = -settings_.velocity_gain_ps * (velocity + lag * modelled_.acceleration_mps2);
  if (braking.norm() > settings_.deceleration_mps2) braking *= settings_.deceleration_mps2 / braking.norm();
  const double max_angular = settings_.body.angular_acceleration_radps2;
  return {braking,
          std::clamp(-settings_.turning_gain_ps * estimator_.angular_radps(), -max_angular, max_angular)};
}

void Firmware::find_pose(const PoseFix& fix, Time now) {
  const bool is_usable = fix.position_m.allFinite() && std::isfinite(fix.heading_rad) &&
                         fix.captured_at > moved_at_ + kRestTime && fix.captured_at <= now;
  if (!is_usable) return;
  estimator_ = PoseEstimator(fix.position_m, fix.heading_rad, now, settings_.estimator, kFirstFixDeviation_m);
  has_pose_ = true;
  is_rebooting_ = true;
}

void Firmware::restart(Time now) {
  Firmware again(robot_, estimator_.position_m(), estimator_.heading_rad(), now, settings_);
  again.estimator_ = estimator_;
  again.obeyed_ = obeyed_;
  again.obeyed_epoch_ = obeyed_epoch_;
  again.highest_seen_ = highest_seen_;
  again.highest_executed_ = highest_executed_;
  again.has_moved_ = has_moved_;
  again.executing_ = executing_;
  again.last_fact_ = last_fact_;
  again.counts_ = counts_;
  again.counts_.activated = 0;
  *this = again;
  start_own_stop(OwnStopReason::kRestart, now);
}

Feedback Firmware::feedback(Time now) {
  while (switch_next(now)) {
  }
  last_fact_ = std::max(last_fact_, now);
  const Vec2 position =
      estimator_.position_m() + estimator_.velocity_mps() * to_seconds(now - estimator_.time());
  const Vec2 reference = executing_.trajectory.state_at(now).position_m;
  Feedback facts;
  facts.robot = robot_;
  facts.obeyed_incarnation = obeyed_;
  facts.obeyed_epoch = obeyed_epoch_;
  facts.valid_at = now;
  facts.executing = executing_;
  facts.is_off_reference = is_off_reference_;
  facts.is_lifted = is_lifted_;
  facts.command = last_command_;
  facts.estimate = {position, estimator_.velocity_mps()};
  facts.heading_rad = wrapped_rad(estimator_.heading_rad());
  facts.tracking_error_m = (position - reference).norm();
  facts.uncertainty = {estimator_.position_error_rms_m(), estimator_.odometry_scale_stddev()};
  facts.has_moved = has_moved_;
  facts.activated = counts_.activated;
  return facts;
}

}  // namespace sidestep
