// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"
#include "simulator/world/body.hpp"

namespace sidestep {

/// Properties of bases that follow velocity commands. The defaults match the league's simulators and robots.
struct BaseSettings {
  Duration latency = std::chrono::milliseconds(100);  ///< delay from a command to the first motion
  /// The base brakes after this time without a command.
  Duration silence_timeout = std::chrono::milliseconds(100);
  double braking_mps2 = 5.9;
};

/// The velocity command of a base.
struct BaseVelocity {
  Vec2 linear_mps{0, 0};
  double turn_radps = 0;
  bool is_global = false;  ///< linear_mps is in the world frame instead of the base's frame
};

BodySettings body_settings(const BaseSettings& settings);

/// The velocity control of a simulated base. It follows the latest command whose latency has passed, within
/// the base's acceleration limits, and brakes if no commands arrive.
class BaseControl {
 public:
  static constexpr double kMaxSpeed_mps = 3.7;

  explicit BaseControl(const BaseSettings& settings) : settings_(settings) {}

  void command(const BaseVelocity& velocity, Time now);
  /// The accelerations for the physics step that begins now.
  Actuation actuation(const Body& body, Time now);
  void reset() { *this = BaseControl(settings_); }

 private:
  struct Received {
    Time effective_at{};
    BaseVelocity velocity;
  };
  BaseSettings settings_;
  std::deque<Received> waiting_;
  BaseVelocity current_;
  Time braking_begins_at_{};  ///< time at which the base brakes unless another command takes effect
};

}  // namespace sidestep
