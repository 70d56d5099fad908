// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"
#include "deploy/view/monitor/history.hpp"

namespace sidestep {

/// The time that one viewer sees: now, or a moment of the past, paused or playing.
class ViewerTime {
 public:
  enum class Mode : std::uint8_t { kLive, kPaused, kPlaying };

  Mode mode() const { return mode_; }
  double speed() const { return speed_; }

  void go_live() { mode_ = Mode::kLive; }
  void pause_at(Time shown) { mode_ = Mode::kPaused, shown_ = shown; }
  /// Plays from a moment on, at `speed` times real time; negative: backwards. `clock` is the current real
  /// time.
  void play(Time from, double speed, Time clock) {
    mode_ = Mode::kPlaying, shown_ = from, speed_ = speed, started_ = clock;
  }
  /// The moment to show. Playing stops at the end of the history that it moves towards. Precondition: the
  /// history is not empty.
  Time update(const History& history, Time clock);

 private:
  Mode mode_ = Mode::kLive;
  Time shown_{};    // the moment shown at `started_`
  Time started_{};  // by the real-time clock
  double speed_ = 1;
};

}  // namespace sidestep
