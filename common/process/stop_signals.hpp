// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <signal.h>

namespace sidestep {

/// Calls `stop` on SIGINT and SIGTERM instead of ending the process, for the lifetime of the object. `stop`
/// runs in the signal handler, so it has to be async-signal-safe, as DdsBus::stop() is. At most one object
/// per process at a time.
class StopSignals {
 public:
  explicit StopSignals(std::function<void()> stop);
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  struct sigaction old_int_ {};
  struct sigaction old_term_ {};
};

}  // namespace sidestep
