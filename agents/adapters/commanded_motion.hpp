// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "agents/adapters/driver.hpp"

namespace sidestep {

/// Predicts the velocity of a base from the velocities recently commanded to it. The base obeys each command
/// after a fixed latency, until the next command takes effect.
class CommandedMotion {
 public:
  /// Precondition: 0 <= latency <= kMaxLatency.
  explicit CommandedMotion(Duration latency) : latency_(latency) {}

  /// Precondition: `at` is later than in the previous call.
  void add(Time at, const BodyVelocity& velocity);
  /// The mean velocity of the base between `from` and `to`. Precondition: both are later than the oldest
  /// remembered command. Before the first command the base is at rest.
  BodyVelocity mean(Time from, Time to) const;
  /// The earliest time after `time` at which a command that was already sent takes effect, but at most
  /// `latest`. Precondition: `time` is later than the oldest remembered command.
  Time next_change(Time time, Time latest) const;
  /// The velocity once all commands are in effect.
  BodyVelocity latest() const;
  Duration latency() const { return latency_; }

  static constexpr Duration kMaxLatency = std::chrono::milliseconds(300);
  static constexpr std::size_t kRemembered = 256;

 private:
  struct SentVelocity {
    Time at{};
    BodyVelocity velocity;
  };
  const SentVelocity& back(std::size_t age) const { return sent_[(count_ - 1 - age) % kRemembered]; }

  Duration latency_;
  std::array<SentVelocity, kRemembered> sent_{};  ///< ring buffer
  std::size_t count_ = 0;
};

}  // namespace sidestep
