// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"
#include "simulator/world/body.hpp"

namespace sidestep {

/// The traits of bases that follow velocities. Defaults are those of the league's simulators and robots.
struct BaseSettings {
  Duration latency = std::chrono::milliseconds(100);          ///< from a command to first motion
  Duration silence_timeout = std::chrono::milliseconds(100);  ///< after this without a command it brakes
  double acceleration_mps2 = 4.7;
  double braking_mps2 = 5.9;
  double speed_mps = 3.7;
  double turn_acceleration_radps2 = 50;
  double turn_speed_radps = 20;
  double scale = 1;  ///< the speed that it reaches relative to the commanded one
};

/// What a base is commanded.
struct BaseVelocity {
  Vec2 linear_mps{0, 0};
  double turn_radps = 0;
  bool is_global = false;  ///< linear_mps is in the world's frame instead of the base's
};

BodySettings body_settings(const BaseSettings& settings);

/// The velocity control of a simulated base: it follows the latest command that is older than its latency,
/// within its acceleration, and brakes when commands stay out.
class BaseControl {
 public:
  explicit BaseControl(const BaseSettings& settings) : settings_(settings) {}

  void command(const BaseVelocity& velocity, Time now);
  /// The accelerations for the physics step that begins now.
  Actuation actuation(const Body& body, Time now);
  void reset() { *this = BaseControl(settings_); }

 private:
  struct Received {
    Time obeyed_at{};
    BaseVelocity velocity;
  };
  BaseSettings settings_;
  std::deque<Received> waiting_;
  BaseVelocity current_;
  Time silent_from_{};  ///< by then it brakes if no further command is obeyed
};

}  // namespace sidestep
