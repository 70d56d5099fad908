// SPDX-License-Identifier: Apache-2.0
#include "simulator/firmware.hpp"

#include <algorithm>
#include <cmath>

#include "common/messaging/codec.hpp"

namespace sidestep {
namespace {

constexpr double kFarthest_m = 1e4;  // no floor is larger
constexpr double kMaxInflation_m = 1;
// What claims to be higher would leave no room for numbers above it.
constexpr Incarnation kHighestIncarnation = Incarnation{1} << 62;
constexpr VersionNumber kHighestNumber = VersionNumber{1} << 63;

struct CheckedCommand {
  Incarnation incarnation;
  Epoch epoch;
  std::optional<Version> version;
};

bool is_sane(const msg::PoseFix& fix) {
  return std::abs(fix.x_m()) < kFarthest_m && std::abs(fix.y_m()) < kFarthest_m &&
         std::isfinite(fix.heading_rad());
}

// nullopt when any part of the command makes no sense for this robot.
std::optional<CheckedCommand> check(const msg::Command& command, RobotId robot) {
  CheckedCommand checked{command.head().incarnation(), command.epoch(), std::nullopt};
  if (command.robot() != robot || command.head().sender() != robot) return std::nullopt;
  if (checked.incarnation == 0 || checked.incarnation > kHighestIncarnation) return std::nullopt;
  if (checked.epoch > kHighestEpoch || !std::isfinite(command.heading_rad())) return std::nullopt;
  if (command.has_fix() && !is_sane(command.fix())) return std::nullopt;
  if (command.has_version()) {
    checked.version = decode(command.granted());
    if (!checked.version || checked.version->robot != robot) return std::nullopt;
    if (checked.version->number == 0 || checked.version->number > kHighestNumber) return std::nullopt;
    if (checked.version->incarnation > checked.incarnation) return std::nullopt;
  }
  return checked;
}

}  // namespace

Firmware::Firmware(RobotId robot, const Vec2& mark_m, double heading_rad, Time now,
                   const FirmwareSettings& settings)
    : robot_(robot),
      executing_{robot, 0, 0, 0, Trajectory::resting(Time{}, mark_m)},
      settings_(settings),
      decay_(std::exp(-kPhysicsStepSeconds / settings.body.lag_s)),
      // A wish is in force for a whole period, half a period late on average.
      look_ahead_(from_seconds(settings.body.lag_s) + kPhysicsStep / 2),
      most_lead_m_(settings.body.acceleration_mps2 *
                   std::pow(settings.velocity_gain_ps / settings.position_gain_ps2, 2)),
      estimator_(mark_m, heading_rad, now, settings.estimator),
      heading_goal_rad_(heading_rad) {}

void Firmware::on_command(const msg::Command& command, Time now) {
  while (switch_next(now)) {
  }
  const auto checked = check(command, robot_);
  if (!checked) {
    ++counts_.refused_malformed;
    return;
  }
  highest_ = std::max({highest_, checked->incarnation, checked->version ? checked->version->number : 0});
  if (checked->incarnation < obeyed_) {
    ++counts_.refused_fenced;
    return;
  }
  obey(checked->incarnation);
  heard_stamp_ns_ = command.head().stamp_ns();
  heard_at_ = now;
  // A new agent may not have heard of the epoch that an earlier one has obeyed: it is told, but not obeyed so
  // far.
  const bool is_old_epoch = checked->epoch < obeyed_epoch_;
  obeyed_epoch_ = std::max(obeyed_epoch_, checked->epoch);
  heading_goal_rad_ = wrapped_rad(command.heading_rad());
  if (command.has_fix()) {
    const auto& fix = command.fix();
    estimator_.correct(time_from_ns(fix.captured_at_ns()), {fix.x_m(), fix.y_m()}, fix.heading_rad());
  }
  if (!checked->version) return;
  if (is_old_epoch) {
    ++counts_.refused_fenced;
  } else {
    take(*checked->version, now);
  }
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
  if (knows(version.number)) return;
  if (version.incarnation < obeyed_) {
    ++counts_.refused_fenced;
  } else if (version.trajectory.start() <= now) {
    ++counts_.refused_late;
  } else if (!may_take(version)) {
    ++counts_.refused_base;  // it continues something older still
  } else {
    insert(version);
  }
}

bool Firmware::may_take(const Version& version) const {
  if (version.number <= newest_) return false;
  const Trajectory& trajectory = version.trajectory;
  const bool is_stand = trajectory.phases().empty() && trajectory.at_start().velocity_mps.isZero(0);
  return !is_lifted_ || (version.base == 0 && is_stand);
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

bool Firmware::knows(VersionNumber number) const {
  return number == executing_.number ||
         std::any_of(pending_.begin(), pending_.begin() + pending_count_,
                     [number](const Version& held) { return held.number == number; });
}

bool Firmware::switch_next(Time now) {
  while (pending_count_ > 0 && pending_[0].trajectory.start() <= now) {
    const Version due = pending_[0];
    remove_pending(0);
    if (due.base == executing_.number && due.number > newest_) {
      executing_ = due;
      newest_ = due.number;
      is_off_reference_ = false;
      ++counts_.taken;
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
  auto& believed = believed_.acceleration_mps2;
  auto& believed_angular = believed_.angular_acceleration_radps2;
  believed = last_desired_.acceleration_mps2 + (believed - last_desired_.acceleration_mps2) * decay_;
  believed_angular = last_desired_.angular_acceleration_radps2 +
                     (believed_angular - last_desired_.angular_acceleration_radps2) * decay_;
  estimator_.advance(now, odometry, believed, believed_angular);

  if (is_lifted_) return last_desired_ = {};
  const bool may_break_off = now > last_fact_ && now > executing_.trajectory.start();
  if (is_rebooting_ && may_break_off) start_again(now);

  State now_wanted = executing_.trajectory.state_at(now);
  if (must_break_off(estimator_.position_m() - now_wanted.position_m, now) && may_break_off) {
    break_off(now);
    now_wanted = executing_.trajectory.at_start();
  }

  // With a motor lag T, p + T v and v + T a move as a double integrator without any lag under the wish.
  const double lag = settings_.body.lag_s;
  const Motion ahead = planned(now + look_ahead_).motion_at(now + look_ahead_);
  Vec2 position_lead = now_wanted.position_m + lag * now_wanted.velocity_mps -
                       (estimator_.position_m() + lag * estimator_.velocity_mps());
  // The gains ask for an approach at a speed in proportion to the distance, which brakes in proportion to it
  // too. What the motors can brake from is the most that it comes to, however far off the robot is: otherwise
  // it would overshoot, and swing about its reference.
  if (position_lead.squaredNorm() > most_lead_m_ * most_lead_m_)
    position_lead *= most_lead_m_ / position_lead.norm();
  const Vec2 velocity_lead = ahead.state.velocity_mps - (estimator_.velocity_mps() + lag * believed);
  Vec2 wanted = ahead.acceleration_mps2 + settings_.position_gain_ps2 * position_lead +
                settings_.velocity_gain_ps * velocity_lead;
  const double most = settings_.body.acceleration_mps2;
  if (wanted.squaredNorm() > most * most) wanted *= most / wanted.norm();

  double turn = heading_goal_rad_ - estimator_.heading_rad();
  if (std::abs(turn) > 3) turn = wrapped_rad(turn);
  const double rate = std::clamp(settings_.heading_gain_ps * turn, -settings_.turning_speed_radps,
                                 settings_.turning_speed_radps);
  const double angular_most = settings_.body.angular_acceleration_radps2;
  last_desired_ = {wanted, std::clamp(settings_.turning_gain_ps * (rate - estimator_.angular_radps()),
                                   -angular_most, angular_most)};
  return last_desired_;
}

// The uncertainty counts for half of the bound at most: a robot that nobody sees is not thereby off its
// reference.
bool Firmware::is_beyond_bound(const Vec2& error_m) const {
  const double half = 0.5 * settings_.tracking_bound_m;
  if (error_m.squaredNorm() < half * half) return false;
  const double allowed = settings_.tracking_bound_m + executing_.inflation_m;
  return error_m.norm() + std::min(2 * estimator_.deviation_m(), half) > allowed;
}

// A fix may show in a moment what drift has grown up to it; the control cures that before anybody could be
// told of it, and a robot that brakes where nobody expects it to endangers those around it. What cannot be
// cured is what the bound is for.
bool Firmware::must_break_off(const Vec2& error_m, Time now) {
  if (!is_beyond_bound(error_m)) {
    beyond_since_ = Time::max();
    return false;
  }
  beyond_since_ = std::min(beyond_since_, now);
  return now - beyond_since_ >= kCure || estimator_.jump_m() > 0 ||
         error_m.norm() > 2 * settings_.tracking_bound_m + executing_.inflation_m;
}

void Firmware::break_off(Time now) {
  beyond_since_ = Time::max();
  Version stop;
  stop.robot = robot_;
  stop.incarnation = obeyed_;
  highest_ = std::max(highest_, newest_) + kOwnNumberGap;
  stop.number = highest_;
  stop.base = executing_.number;
  stop.trajectory = Trajectory(now, {estimator_.position_m(), estimator_.velocity_mps()});
  append_stop(stop.trajectory, settings_.deceleration_mps2);
  // What moved it past its wheels may do so again until the next sight.
  stop.inflation_m = std::min(2 * estimator_.deviation_m() + estimator_.jump_m(), kMaxInflation_m);
  executing_ = stop;
  newest_ = stop.number;
  is_off_reference_ = true;
  pending_count_ = 0;
  ++counts_.broke_off;
}

void Firmware::lift(Time now) {
  is_lifted_ = true;
  is_rebooting_ = false;
  is_off_reference_ = false;
  pending_count_ = 0;
  executing_ = {robot_, 0, 0, 0, Trajectory::resting(now, estimator_.position_m()), 0};
}

void Firmware::put_down(double heading_rad, Time now) {
  is_lifted_ = false;
  heading_goal_rad_ = heading_rad;
  estimator_ = PoseEstimator(executing_.trajectory.rest_position_m(), heading_rad, now, settings_.estimator);
  last_desired_ = believed_ = {};
}

void Firmware::start_again(Time now) {
  Firmware again(robot_, estimator_.position_m(), estimator_.heading_rad(), now, settings_);
  again.estimator_ = estimator_;
  again.obeyed_ = obeyed_;
  again.obeyed_epoch_ = obeyed_epoch_;
  again.highest_ = highest_;
  again.newest_ = newest_;
  again.executing_ = executing_;
  again.last_fact_ = last_fact_;
  *this = again;
  break_off(now);
}

msg::Feedback Firmware::feedback(Time now) {
  while (switch_next(now)) {
  }
  last_fact_ = std::max(last_fact_, now);
  const Vec2 position =
      estimator_.position_m() + estimator_.velocity_mps() * to_seconds(now - estimator_.time());
  const Vec2 reference = executing_.trajectory.state_at(now).position_m;
  msg::Feedback facts;
  facts.robot(robot_);
  facts.obeyed_incarnation(obeyed_);
  facts.obeyed_epoch(obeyed_epoch_);
  facts.at_ns(to_ns(now));
  facts.executing(encode(executing_));
  facts.is_off_reference(is_off_reference_);
  facts.is_lifted(is_lifted_);
  facts.heard_stamp_ns(heard_stamp_ns_);
  facts.heard_at_ns(to_ns(heard_at_));
  facts.x_m(position.x());
  facts.y_m(position.y());
  facts.vx_mps(estimator_.velocity_mps().x());
  facts.vy_mps(estimator_.velocity_mps().y());
  facts.heading_rad(wrapped_rad(estimator_.heading_rad()));
  facts.tracking_error_m((position - reference).norm());
  facts.deviation_m(estimator_.deviation_m());
  facts.scale_deviation(estimator_.scale_deviation());
  facts.taken(counts_.taken);
  facts.refused_late(counts_.refused_late);
  facts.refused_base(counts_.refused_base);
  facts.refused_fenced(counts_.refused_fenced);
  facts.refused_malformed(counts_.refused_malformed);
  return facts;
}

}  // namespace sidestep
