// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <sys/types.h>

#include "common/process/stop_signals.hpp"

namespace sidestep {

/// The user's requests to end by SIGINT and SIGTERM, which descriptors show, for the lifetime of the object.
/// See StopSignals.
class StopRequests {
 public:
  /// Throws std::runtime_error if the system has no more descriptors.
  StopRequests();
  ~StopRequests();
  StopRequests(const StopRequests&) = delete;
  StopRequests& operator=(const StopRequests&) = delete;

  /// Is readable after the first request.
  int stop() const { return stop_; }
  /// Is readable after a repeated Ctrl-C.
  int give_up() const { return give_up_; }

 private:
  const int stop_, give_up_;
  std::optional<StopSignals> signals_;
};

/// Passes a request on to a child as a signal, repeatedly, because a child that has just started does not
/// handle signals yet.
class PassedSignal {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `request`: descriptor that is readable once the signal must be passed.
  PassedSignal(int signal, int request) : signal_(signal), request_(request) {}

  int request() const { return request_; }
  /// When the signal was first passed.
  std::optional<Time> first_at() const { return first_at_; }
  void update(pid_t child, Time now);

 private:
  int signal_, request_;
  std::optional<Time> first_at_, last_at_;
};

bool is_readable(int descriptor);

}  // namespace sidestep
