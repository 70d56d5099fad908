// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/messaging/bus.hpp"
#include "common/time/clock_recovery.hpp"

namespace sidestep {

/// The processes whose clocks this process's clock must agree with.
enum class ClockReference {
  kCoordinators,  ///< reference of all processes except coordinators
  kRobots         ///< reference of coordinators, which cannot set the robots' clocks
};

/// Detects when the host's clock is set, and uses ClockRecovery to decide whether the process must restart
/// with that clock. Costs nothing until the host's clock is set.
class HostClockWatch {
 public:
  static constexpr Duration kPeriod{1'000'000'000};

  struct Callbacks {
    std::function<Duration()> host_ahead;   ///< returns the host's clock minus the process's clock
    std::function<bool()> is_in_use;        ///< whether other processes rely on this process's clock
    std::function<void()> on_adopt;         ///< called once if the process must restart with its host's clock
    std::function<void(Duration)> on_step;  ///< called if the host's clock was set, with host_ahead()
  };

  /// `max_clock_difference`: see ClockRecovery. The bus makes no callbacks after this object's destruction.
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
