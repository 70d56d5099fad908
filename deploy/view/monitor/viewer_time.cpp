// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/viewer_time.hpp"

#include <algorithm>

namespace sidestep {

Time ViewerTime::update(const History& history, Time clock) {
  const Time begin = history.first().at, end = history.last().at;
  if (mode_ == Mode::kLive) return end;
  if (mode_ == Mode::kPlaying) {
    const Time moment = shown_ + from_seconds(speed_ * to_seconds(clock - started_));
    const bool is_at_end = speed_ > 0 ? moment >= end : moment <= begin;
    if (!is_at_end) return std::clamp(moment, begin, end);
    mode_ = Mode::kPaused;
    shown_ = moment;
  }
  shown_ = std::clamp(shown_, begin, end);
  return shown_;
}

}  // namespace sidestep
