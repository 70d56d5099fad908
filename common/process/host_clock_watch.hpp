// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/messaging/bus.hpp"
#include "common/time/clock_recovery.hpp"

namespace sidestep {

/// Whose clocks a process's clock must agree with.
enum class ClockReference {
  kCoordinators,  ///< for all but coordinators
  kRobots         ///< for coordinators: they serve the robots, whose clocks they cannot set
};

/// Notices that the host's clock has been set, and decides with ClockRecovery whether the process begins anew
/// by it. Costs nothing as long as the host's clock is not set.
class HostClockWatch {
 public:
  static constexpr Duration kPeriod{1'000'000'000};

  struct Callbacks {
    std::function<Duration()> host_ahead;   ///< reads the host's clock - the process's
    std::function<bool()> is_in_use;        ///< the process works by its clock with others
    std::function<void()> on_adopt;         ///< called once: the process must begin anew by its host's clock
    std::function<void(Duration)> on_step;  ///< the host's clock has been set: it is this far ahead
  };

  /// The bus makes no callbacks after this object's destruction. `max_clock_difference`: see ClockRecovery.
  HostClockWatch(Bus& bus, ClockReference reference, Duration max_clock_difference, Callbacks callbacks);
  HostClockWatch(const HostClockWatch&) = delete;
  HostClockWatch& operator=(const HostClockWatch&) = delete;

 private:
  void check();
  void watch_references();

  Bus& bus_;
  const ClockReference reference_;
  const Callbacks callbacks_;
  ClockRecovery recovery_;
  Duration host_ahead_{0};
  bool is_watching_ = false;
};

}  // namespace sidestep
