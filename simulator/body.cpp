// SPDX-License-Identifier: Apache-2.0
#include "simulator/body.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

Vec2 limited(const Vec2& v, double most) {
  const double square = v.squaredNorm();
  if (square <= most * most) return v;
  return std::isfinite(square) ? Vec2(v * (most / std::sqrt(square))) : Vec2(0, 0);
}

double limited(double v, double most) { return std::isfinite(v) ? std::clamp(v, -most, most) : 0.0; }

}  // namespace

Body::Body(const Vec2& position_m, double heading_rad, const BodySettings& settings)
    : state_{position_m, Vec2::Zero()},
      heading_rad_(heading_rad),
      settings_(settings),
      decay_(std::exp(-kPhysicsStepSeconds / settings.lag_s)) {}

void Body::step(const Actuation& wanted) {
  constexpr double dt = kPhysicsStepSeconds;
  const double lag = settings_.lag_s;
  const double gained = 1 - decay_;

  const Vec2 goal = limited(wanted.acceleration_mps2, settings_.acceleration_mps2);
  const Vec2 missing = acceleration_mps2_ - goal;
  state_.position_m +=
      state_.velocity_mps * dt + goal * (0.5 * dt * dt) + missing * (lag * (dt - lag * gained));
  state_.velocity_mps += goal * dt + missing * (lag * gained);
  acceleration_mps2_ = goal + missing * decay_;
  state_.velocity_mps = limited(state_.velocity_mps, settings_.speed_mps);

  const double angular_goal =
      limited(wanted.angular_acceleration_radps2, settings_.angular_acceleration_radps2);
  const double angular_missing = angular_acceleration_radps2_ - angular_goal;
  const double before = angular_radps_;
  angular_radps_ =
      limited(before + angular_goal * dt + angular_missing * (lag * gained), settings_.angular_speed_radps);
  angular_acceleration_radps2_ = angular_goal + angular_missing * decay_;
  heading_rad_ += 0.5 * (before + angular_radps_) * dt;
}

void Body::push(const Vec2& shift_m, const Vec2& velocity_change_mps) {
  state_.position_m += shift_m;
  state_.velocity_mps = limited(state_.velocity_mps + velocity_change_mps, settings_.speed_mps);
}

}  // namespace sidestep
