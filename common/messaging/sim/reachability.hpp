// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/messaging/reliability.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// The times since which two processes can hear each other, for simulating discovery. They forget each other
/// if either direction is silent for kSilenceLimit.
struct Reachability {
  Time heard_from = Time::min();  ///< both directions are heard from this time until `silent_from`
  Time silent_from = Time::max();
  Time last_silent_from = Time::min();  ///< start of the silence that ended at `heard_from`
  Time reconnected_at = Time::min();    ///< end of the last silence after which they had forgotten each other

  bool is_forgotten(Time now) const { return silent_from <= now && now - silent_from >= kSilenceLimit; }
  void silence(Time now) { silent_from = std::min(silent_from, now); }
  void on_silence_end(Time now) {
    if (is_forgotten(now)) reconnected_at = now;
    last_silent_from = silent_from;
    heard_from = now;
    silent_from = Time::max();
  }
};

/// The reachability of two processes that hear each other only while both `a` and `b` allow it, for example
/// the two directions of their link.
inline Reachability both(const Reachability& a, const Reachability& b) {
  return {std::max(a.heard_from, b.heard_from), std::min(a.silent_from, b.silent_from),
          std::max(a.last_silent_from, b.last_silent_from), std::max(a.reconnected_at, b.reconnected_at)};
}

}  // namespace sidestep
