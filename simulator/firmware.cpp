// SPDX-License-Identifier: Apache-2.0
#include "simulator/firmware.hpp"

#include <algorithm>
#include <cmath>

#include "common/messaging/codec.hpp"

namespace sidestep {
namespace {

constexpr double kFarthest_m = 1e4;  // no floor is larger

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
  if (checked.incarnation == 0 || checked.epoch > kHighestEpoch || !std::isfinite(command.heading_rad()))
    return std::nullopt;
  if (command.has_fix() && !is_sane(command.fix())) return std::nullopt;
  if (command.has_version()) {
    checked.version = decode(command.granted());
    if (!checked.version || checked.version->robot != robot || checked.version->number == 0)
      return std::nullopt;
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
  if (checked->incarnation < obeyed_) {
    ++counts_.refused_fenced;
    return;
  }
  obey(checked->incarnation);
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
  } else if (version.number < executing_.number) {
    ++counts_.refused_base;  // it continues something older still
  } else {
    insert(version);
  }
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
    if (due.base == executing_.number && due.number > executing_.number) {
      executing_ = due;
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
  believed = last_wish_.acceleration_mps2 + (believed - last_wish_.acceleration_mps2) * decay_;
  believed_angular = last_wish_.angular_acceleration_radps2 +
                     (believed_angular - last_wish_.angular_acceleration_radps2) * decay_;
  estimator_.advance(now, odometry, believed, believed_angular);

  // With a motor lag T, p + T v and v + T a move as a double integrator without any lag under the wish.
  const double lag = settings_.body.lag_s;
  const State now_wanted = executing_.trajectory.state_at(now);
  const Trajectory& ahead = planned(now + look_ahead_);
  const Vec2 position_lead = now_wanted.position_m + lag * now_wanted.velocity_mps -
                             (estimator_.position_m() + lag * estimator_.velocity_mps());
  const Vec2 velocity_lead =
      ahead.state_at(now + look_ahead_).velocity_mps - (estimator_.velocity_mps() + lag * believed);
  Vec2 wanted = ahead.acceleration_at(now + look_ahead_) + settings_.position_gain_ps2 * position_lead +
                settings_.velocity_gain_ps * velocity_lead;
  const double most = settings_.body.acceleration_mps2;
  if (wanted.squaredNorm() > most * most) wanted *= most / wanted.norm();

  double turn = heading_goal_rad_ - estimator_.heading_rad();
  if (std::abs(turn) > 3) turn = wrapped_rad(turn);
  const double rate = std::clamp(settings_.heading_gain_ps * turn, -settings_.turning_speed_radps,
                                 settings_.turning_speed_radps);
  const double angular_most = settings_.body.angular_acceleration_radps2;
  last_wish_ = {wanted, std::clamp(settings_.turning_gain_ps * (rate - estimator_.angular_radps()),
                                   -angular_most, angular_most)};
  return last_wish_;
}

msg::Feedback Firmware::feedback(Time now) {
  while (switch_next(now)) {
  }
  const Vec2 position =
      estimator_.position_m() + estimator_.velocity_mps() * to_seconds(now - estimator_.time());
  const Vec2 reference = executing_.trajectory.state_at(now).position_m;
  msg::Feedback facts;
  facts.robot(robot_);
  facts.obeyed_incarnation(obeyed_);
  facts.obeyed_epoch(obeyed_epoch_);
  facts.at_ns(to_ns(now));
  facts.executing(encode(executing_));
  facts.x_m(position.x());
  facts.y_m(position.y());
  facts.vx_mps(estimator_.velocity_mps().x());
  facts.vy_mps(estimator_.velocity_mps().y());
  facts.heading_rad(wrapped_rad(estimator_.heading_rad()));
  facts.tracking_error_m((position - reference).norm());
  facts.taken(counts_.taken);
  facts.refused_late(counts_.refused_late);
  facts.refused_base(counts_.refused_base);
  facts.refused_fenced(counts_.refused_fenced);
  facts.refused_malformed(counts_.refused_malformed);
  return facts;
}

}  // namespace sidestep
