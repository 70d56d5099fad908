// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/time/time.hpp"

namespace sidestep {

/// Admits a burst of up to `burst` events, and then one event per period.
class RateLimit {
 public:
  constexpr RateLimit(int burst, Duration period) : period_(period), tolerance_((burst - 1) * period) {}

  [[nodiscard]] constexpr bool admit(Time now) {
    // due_ is this far ahead only if the clock has been set back.
    if (due_ - now > tolerance_ + period_) due_ = now;
    const Time due = std::max(due_, now);
    if (due - now > tolerance_) return false;
    due_ = due + period_;
    return true;
  }
  /// Takes back an admitted event, so that it does not count.
  constexpr void refund() { due_ -= period_; }

 private:
  Duration period_, tolerance_;
  Time due_ = Time{};  ///< time at which the next event would be due at a rate of one per period
};

}  // namespace sidestep
