// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <signal.h>

namespace sidestep {

/// Calls `stop` on SIGINT and SIGTERM instead of ending the process, for the lifetime of the object. Both
/// callbacks run in the signal handler, so they have to be async-signal-safe, as DdsBus::stop() is. At most
/// one object per process at a time.
class StopSignals {
 public:
  /// A SIGINT sooner than this after the first signal is the same request: some programs send a signal both
  /// to a process and to its group.
  static constexpr std::chrono::milliseconds kSameRequest{200};

  /// `give_up`, if set, is called instead of `stop` on a SIGINT that follows another signal: the user does
  /// not want to wait. SIGTERM never gives up, because supervisors repeat it.
  explicit StopSignals(std::function<void()> stop, std::function<void()> give_up = {});
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  struct sigaction old_int_ {};
  struct sigaction old_term_ {};
};

}  // namespace sidestep
