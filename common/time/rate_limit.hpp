// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/time/time.hpp"

namespace sidestep {

/// Admits up to `burst` events at once, and then one per period.
class RateLimit {
 public:
  constexpr RateLimit(int burst, Duration period) : period_(period), tolerance_((burst - 1) * period) {}

  [[nodiscard]] constexpr bool admit(Time now) {
    // No clock but one that was set back since shows a later time for the next event.
    if (due_ - now > tolerance_ + period_) due_ = now;
    const Time due = std::max(due_, now);
    if (due - now > tolerance_) return false;
    due_ = due + period_;
    return true;
  }
  /// An event that was admitted does not count after all.
  constexpr void give_back() { due_ -= period_; }

 private:
  Duration period_, tolerance_;
  Time due_ = Time{};  ///< when the next event would be due at one per period
};

}  // namespace sidestep
