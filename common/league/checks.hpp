// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "common/league/refusal.hpp"
#include "common/time/time.hpp"

namespace sidestep::league {

inline constexpr double kMaxPosition_m = 100;
inline constexpr double kMaxHeading_rad = 7;        // one turn either way, whatever range the sender prefers
inline constexpr double kMaxTime_s = 8589934592.0;  // 2^33; as nanoseconds it fits into 64 bits
inline constexpr std::size_t kLongestText = 256;

/// Collects what is wrong with a packet while its numbers are taken over; the first reason counts. What is
/// taken over after that is of no use to anybody.
class Checks {
 public:
  void require(bool is_sound, Refusal otherwise) {
    if (!is_sound && refusal_ == Refusal::kNone) refusal_ = otherwise;
  }
  // Comparisons with NaN are false, so these refuse it.
  double within(double value, double low, double high) {
    require(value >= low && value <= high, Refusal::kNumber);
    return value;
  }
  double within(double value, double bound) { return within(value, -bound, bound); }
  double probability(double value) { return within(value, 0, 1); }
  Duration time(double seconds) {
    const bool is_sound = seconds >= 0 && seconds <= kMaxTime_s;
    require(is_sound, Refusal::kTime);
    return is_sound ? from_seconds(seconds) : Duration{0};
  }
  template <typename List>
  void at_most(const List& list, int most) {
    require(list.size() <= most, Refusal::kTooMany);
  }
  template <typename Text>
  const Text& text(const Text& text) {
    require(text.size() <= kLongestText, Refusal::kText);
    return text;
  }
  bool is_sound() const { return refusal_ == Refusal::kNone; }
  Refusal refusal() const { return refusal_; }

 private:
  Refusal refusal_ = Refusal::kNone;
};

}  // namespace sidestep::league
