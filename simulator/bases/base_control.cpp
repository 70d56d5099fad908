// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/base_control.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr double kBaseAcceleration_mps2 = 4.7;
constexpr double kBaseTurnAcceleration_radps2 = 50, kBaseTurnSpeed_radps = 20;

// Time constant with which the motors reach a commanded velocity.
constexpr double kResponse_s = 0.02;
// Maximum number of commands whose latency has not passed yet. It keeps a flood of commands from filling the
// memory.
constexpr std::size_t kMaxWaiting = 1000;

}  // namespace

BodySettings body_settings(const BaseSettings& settings) {
  BodySettings body;
  body.lag_s = 0.005;
  body.acceleration_mps2 = std::max(kBaseAcceleration_mps2, settings.braking_mps2);
  body.speed_mps = BaseControl::kMaxSpeed_mps;
  body.angular_acceleration_radps2 = kBaseTurnAcceleration_radps2;
  body.angular_speed_radps = kBaseTurnSpeed_radps;
  return body;
}

void BaseControl::command(const BaseVelocity& velocity, Time now) {
  if (waiting_.size() == kMaxWaiting) waiting_.pop_front();
  waiting_.push_back({now + settings_.latency, velocity});
}

Actuation BaseControl::actuation(const Body& body, Time now) {
  while (!waiting_.empty() && waiting_.front().effective_at <= now) {
    current_ = waiting_.front().velocity;
    braking_begins_at_ = waiting_.front().effective_at + settings_.silence_timeout;
    waiting_.pop_front();
  }
  if (now >= braking_begins_at_) current_ = {};
  const Vec2& commanded = current_.linear_mps;
  const Vec2 target = current_.is_global ? commanded : rotated(commanded, body.heading_rad());
  Actuation actuation;
  actuation.acceleration_mps2 = (target - body.velocity_mps()) / kResponse_s;
  const bool is_braking = target.squaredNorm() < body.velocity_mps().squaredNorm();
  const double max = is_braking ? settings_.braking_mps2 : kBaseAcceleration_mps2;
  const double norm = actuation.acceleration_mps2.norm();
  if (norm > max) actuation.acceleration_mps2 *= max / norm;
  actuation.angular_acceleration_radps2 = (current_.turn_radps - body.angular_radps()) / kResponse_s;
  return actuation;
}

}  // namespace sidestep
