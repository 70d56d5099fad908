// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/body.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

Vec2 limited(const Vec2& v, double max) {
  const double square = v.squaredNorm();
  if (square <= max * max) return v;
  return std::isfinite(square) ? Vec2(v * (max / std::sqrt(square))) : Vec2(0, 0);
}

double limited(double v, double max) { return std::isfinite(v) ? std::clamp(v, -max, max) : 0.0; }

}  // namespace

Body::Body(const Vec2& position_m, double heading_rad, const BodySettings& settings)
    : state_{position_m, Vec2::Zero()},
      heading_rad_(heading_rad),
      settings_(settings),
      decay_(std::exp(-kPhysicsStepSeconds / settings.lag_s)) {}

void Body::step(const Actuation& command) {
  if (is_rolling_) {
    roll(command);
  } else if (carried_mps_) {
    state_.position_m += *carried_mps_ * kPhysicsStepSeconds;
    total_slip_m_ += *carried_mps_ * kPhysicsStepSeconds;
  } else if (is_on_floor_ && !is_powered_) {
    coast();
  } else if (is_on_floor_) {
    slide(command);
  }
}

void Body::coast() {
  constexpr double dt = kPhysicsStepSeconds;
  const double speed = state_.velocity_mps.norm();
  const double lost = kRolling_mps2 * dt;
  const Vec2 before = state_.velocity_mps;
  state_.velocity_mps *= speed > lost ? 1 - lost / speed : 0;
  state_.position_m += 0.5 * dt * (before + state_.velocity_mps);
}

void Body::roll(const Actuation& command) {
  constexpr double dt = kPhysicsStepSeconds;
  const double lag = settings_.lag_s;
  const double gained = 1 - decay_;

  const Vec2 target = limited(command.acceleration_mps2, settings_.acceleration_mps2);
  const Vec2 residual = acceleration_mps2_ - target;
  state_.position_m +=
      state_.velocity_mps * dt + target * (0.5 * dt * dt) + residual * (lag * (dt - lag * gained));
  state_.velocity_mps += target * dt + residual * (lag * gained);
  acceleration_mps2_ = target + residual * decay_;
  state_.velocity_mps = limited(state_.velocity_mps, settings_.speed_mps);

  const double angular_target =
      limited(command.angular_acceleration_radps2, settings_.angular_acceleration_radps2);
  const double angular_residual = angular_acceleration_radps2_ - angular_target;
  const double before = angular_radps_;
  angular_radps_ = limited(before + angular_target * dt + angular_residual * (lag * gained),
                           settings_.angular_speed_radps);
  angular_acceleration_radps2_ = angular_target + angular_residual * decay_;
  heading_rad_ += 0.5 * (before + angular_radps_) * dt;
}

void Body::displace(const Vec2& shift_m, const Vec2& velocity_change_mps) {
  state_.position_m += shift_m;
  state_.velocity_mps = limited(state_.velocity_mps + velocity_change_mps, settings_.speed_mps);
}

// Advances a slipping body: its wheels follow the command, but the grip transmits only a fraction of their
// acceleration and of friction to the body.
void Body::slide(const Actuation& command) {
  constexpr double dt = kPhysicsStepSeconds;
  const State before = state_;
  state_.velocity_mps -= slip_mps_;
  const Vec2 wheels_before = state_.velocity_mps;
  roll(command);
  Vec2 wheels = state_.velocity_mps;
  Vec2 rolled = state_.position_m - before.position_m;
  const Vec2 gained = wheels - wheels_before;
  if (blocked_rad_) {
    const Vec2 blocked = rotated(Vec2(1, 0), heading_rad_ + *blocked_rad_);
    wheels -= blocked * wheels.dot(blocked);
    rolled -= blocked * rolled.dot(blocked);
    acceleration_mps2_ -= blocked * acceleration_mps2_.dot(blocked);
  }
  slip_mps_ = before.velocity_mps + grip_ * gained - wheels;
  const double slip = slip_mps_.norm();
  const double pulled = grip_ * settings_.friction_mps2 * dt;
  slip_mps_ = pulled < slip ? Vec2(slip_mps_ * (1 - pulled / slip)) : Vec2(0, 0);

  state_.velocity_mps = limited(wheels + slip_mps_, settings_.speed_mps);
  slip_mps_ = state_.velocity_mps - wheels;
  const Vec2 moved = 0.5 * dt * (before.velocity_mps + state_.velocity_mps);
  state_.position_m = before.position_m + moved;
  total_slip_m_ += moved - rolled;
  update_rolling();
}

bool Body::is_sliding() const { return grip_ < 1 || blocked_rad_ || !slip_mps_.isZero(0); }

void Body::update_rolling() { is_rolling_ = is_on_floor_ && is_powered_ && !carried_mps_ && !is_sliding(); }

void Body::set_powered(bool is_powered) {
  is_powered_ = is_powered;
  acceleration_mps2_.setZero();
  slip_mps_.setZero();
  angular_radps_ = angular_acceleration_radps2_ = 0;
  update_rolling();
}

void Body::carry(const std::optional<Vec2>& velocity_mps) {
  carried_mps_ = velocity_mps;
  state_.velocity_mps = velocity_mps.value_or(Vec2(0, 0));
  acceleration_mps2_.setZero();
  slip_mps_.setZero();
  angular_radps_ = angular_acceleration_radps2_ = 0;
  update_rolling();
}

void Body::push(const Vec2& velocity_change_mps) {
  const Vec2 wheels = state_.velocity_mps - slip_mps_;
  state_.velocity_mps = limited(state_.velocity_mps + velocity_change_mps, settings_.speed_mps);
  slip_mps_ = state_.velocity_mps - wheels;
  update_rolling();
}

void Body::set_grip(double share) {
  grip_ = share;
  update_rolling();
}

void Body::set_blocked_wheel(std::optional<double> direction_rad) {
  blocked_rad_ = direction_rad;
  update_rolling();
}

void Body::lift() {
  state_.velocity_mps.setZero();
  acceleration_mps2_.setZero();
  slip_mps_.setZero();
  angular_radps_ = angular_acceleration_radps2_ = 0;
  carried_mps_.reset();
  is_rolling_ = is_on_floor_ = false;
}

void Body::put_down(const Vec2& position_m, double heading_rad) {
  state_.position_m = position_m;
  heading_rad_ = heading_rad;
  is_on_floor_ = true;
  update_rolling();
}

}  // namespace sidestep
