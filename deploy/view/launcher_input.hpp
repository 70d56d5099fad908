// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// What `sidestep run` tells the monitor that it has started, through the monitor's standard input: the first
/// line is the token for requests that give commands, and may be empty. The line kRunIsOver says that the run
/// is over. The end of the input asks the monitor to end. Unlike arguments and the log, no other user of the
/// machine can read the input.
class LauncherInput {
 public:
  static constexpr const char* kRunIsOver = "the run is over";

  /// Reads from a descriptor, which must outlive this object.
  explicit LauncherInput(int descriptor) : descriptor_(descriptor) {}

  /// Waits for the first line and returns it; empty if the input ends first.
  [[nodiscard]] std::string read_token();
  /// Reads what has arrived since the last call, without waiting.
  void poll();
  bool is_run_over() const { return is_run_over_; }
  bool has_ended() const { return has_ended_; }

 private:
  /// Reads once, after waiting for at most `timeout_ms`; -1: no limit.
  void read_once(int timeout_ms);

  int descriptor_;
  std::string unread_;  ///< the part of a line that has arrived
  bool is_run_over_ = false, has_ended_ = false;
};

}  // namespace sidestep
