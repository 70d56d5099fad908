// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <signal.h>

namespace sidestep {

/// While it lives, SIGINT and SIGTERM call `stop` instead of ending the process. `stop` runs in the signal
/// handler, so it may do no more than DdsBus::stop() does. One at a time in a process.
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
