// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "common/messaging/bus.hpp"
#include "common/time/rate_limit.hpp"

namespace sidestep {

/// Answers clock probes with the time at which the probe arrived and the time at which the answer was sent,
/// by this process's clock. Probes beyond a rate limit, which all senders share, are ignored, so no sender
/// can overload the process.
class ClockResponder {
 public:
  /// The process's description in each answer.
  struct Identity {
    std::uint32_t process = 0;
    Incarnation incarnation = 0;
    double clock_bound_s = 0;
    std::string host, scenario;
  };
  /// Maximum number of probes answered in a burst; further probes are answered at a rate of one per kPeriod.
  static constexpr int kBurst = 20;
  static constexpr Duration kPeriod{10'000'000};

  /// `host_ahead` returns how far the host's clock is ahead of the process's.
  ClockResponder(Bus& bus, const Identity& identity, std::function<Duration()> host_ahead);
  ClockResponder(const ClockResponder&) = delete;
  ClockResponder& operator=(const ClockResponder&) = delete;

 private:
  void answer(const msg::ClockProbe& probe);

  Bus& bus_;
  const std::function<Duration()> host_ahead_;
  RateLimit limit_{kBurst, kPeriod};
  Writer<msg::ClockReading> writer_;
  msg::ClockReading reading_;
};

}  // namespace sidestep
