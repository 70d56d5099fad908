// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "agents/adapters/driver.hpp"

namespace sidestep {

/// The velocities that a base has been commanded lately, and those that it has by them: it obeys each command
/// after a fixed latency, until the next one.
class CommandedMotion {
 public:
  /// Precondition: 0 <= latency <= kMaxLatency.
  explicit CommandedMotion(Duration latency) : latency_(latency) {}

  /// Precondition: `at` is later than at the last call.
  void add(Time at, const BodyVelocity& velocity);
  /// The mean velocity that the base has from `from` to `to`, both later than the oldest command remembered;
  /// at rest before the first command.
  BodyVelocity mean(Time from, Time to) const;
  /// The earliest time after `time` at which the base obeys another command of those sent; `latest` if that
  /// would be later. Precondition: as for mean().
  Time next_change(Time time, Time latest) const;
  /// The velocity once all commands are obeyed.
  BodyVelocity latest() const;
  Duration latency() const { return latency_; }

  static constexpr Duration kMaxLatency = std::chrono::milliseconds(300);
  static constexpr std::size_t kRemembered = 256;

 private:
  struct Sent {
    Time at{};
    BodyVelocity velocity;
  };
  const Sent& back(std::size_t age) const { return sent_[(count_ - 1 - age) % kRemembered]; }

  Duration latency_;
  std::array<Sent, kRemembered> sent_{};  ///< ring buffer
  std::size_t count_ = 0;
};

}  // namespace sidestep
