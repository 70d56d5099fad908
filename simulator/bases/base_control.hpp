// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"
#include "simulator/world/body.hpp"

namespace sidestep {

/// Properties of bases that follow velocity commands. The defaults match the league's simulators and robots.
struct BaseSettings {
  Duration latency = std::chrono::milliseconds(100);  ///< delay from a command to the first motion
  /// The base follows its last command for this time, and comes to rest if no other command takes effect.
  Duration silence_timeout = std::chrono::milliseconds(100);
  /// Time in which the base then coasts to rest, at an even deceleration. 0: it brakes.
  Duration coast{0};
  double braking_mps2 = 5.9;
  double drag_per_s = 0;  ///< deceleration by drag, as a multiple of the velocity
  double max_turn_radps = 20;
};

/// The velocity command of a base.
struct BaseVelocity {
  Vec2 linear_mps{0, 0};
  double turn_radps = 0;
  bool is_global = false;  ///< linear_mps is in the world frame instead of the base's frame
};

BodySettings body_settings(const BaseSettings& settings);

/// The velocity control of a simulated base. It follows the latest command whose latency has passed, within
/// the base's acceleration limits, and comes to rest if no commands arrive.
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
  /// The velocity to reach, in the world frame.
  BaseVelocity target(const Body& body, Time now);

  BaseSettings settings_;
  std::deque<Received> waiting_;
  BaseVelocity current_;
  Time silent_from_{};  ///< time from which the base comes to rest unless another command takes effect
  std::optional<BaseVelocity> coasting_from_;  ///< velocity at silent_from_, in the world frame
};

}  // namespace sidestep
