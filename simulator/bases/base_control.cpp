// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/base_control.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr double kBaseAcceleration_mps2 = 4.7;
constexpr double kBaseTurnAcceleration_radps2 = 50;

// Time constant with which the motors reach a commanded velocity.
constexpr double kResponse_s = 0.02;
// Maximum number of commands whose latency has not passed yet. It keeps a flood of commands from filling the
// memory.
constexpr std::size_t kMaxWaiting = 1000;

}  // namespace

BodySettings body_settings(const BaseSettings& settings) {
  BodySettings body;
  body.lag_s = 0.005;
  body.acceleration_mps2 = std::max(kBaseAcceleration_mps2, settings.braking_mps2) +
                           settings.drag_per_s * BaseControl::kMaxSpeed_mps;
  body.speed_mps = BaseControl::kMaxSpeed_mps;
  body.angular_acceleration_radps2 = kBaseTurnAcceleration_radps2;
  body.angular_speed_radps = settings.max_turn_radps;
  return body;
}

void BaseControl::command(const BaseVelocity& velocity, Time now) {
  if (waiting_.size() == kMaxWaiting) waiting_.pop_front();
  waiting_.push_back({now + settings_.latency, velocity});
}

BaseVelocity BaseControl::target(const Body& body, Time now) {
  if (now < silent_from_) {
    coasting_from_.reset();
    if (current_.is_global) return current_;
    return {rotated(current_.linear_mps, body.heading_rad()), current_.turn_radps, true};
  }
  if (!coasting_from_) coasting_from_ = {body.velocity_mps(), body.angular_radps(), true};
  const Duration silent = now - silent_from_;
  if (silent >= settings_.coast) return {};
  const double left = 1 - to_seconds(silent) / to_seconds(settings_.coast);
  return {left * coasting_from_->linear_mps, left * coasting_from_->turn_radps, true};
}

Actuation BaseControl::actuation(const Body& body, Time now) {
  while (!waiting_.empty() && waiting_.front().effective_at <= now) {
    current_ = waiting_.front().velocity;
    silent_from_ = waiting_.front().effective_at + settings_.silence_timeout;
    waiting_.pop_front();
  }
  const BaseVelocity wanted = target(body, now);
  Actuation actuation;
  actuation.acceleration_mps2 = (wanted.linear_mps - body.velocity_mps()) / kResponse_s;
  const bool is_braking = wanted.linear_mps.squaredNorm() < body.velocity_mps().squaredNorm();
  const double max = is_braking ? settings_.braking_mps2 : kBaseAcceleration_mps2;
  const double norm = actuation.acceleration_mps2.norm();
  if (norm > max) actuation.acceleration_mps2 *= max / norm;
  actuation.acceleration_mps2 -= settings_.drag_per_s * body.velocity_mps();
  actuation.angular_acceleration_radps2 = (wanted.turn_radps - body.angular_radps()) / kResponse_s;
  return actuation;
}

}  // namespace sidestep
