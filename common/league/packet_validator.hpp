// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "common/geometry/coordinate_bound.hpp"
#include "common/league/decode_error.hpp"
#include "common/time/time.hpp"

namespace sidestep::league {

inline constexpr double kMaxHeading_rad =
    7;  // more than one turn in either direction, because senders use different ranges
inline constexpr double kMaxTime_s = 8589934592.0;  // 2^33; fits into 64 bits as nanoseconds
inline constexpr double kMinSenderTime_s = -3600;   // simulators begin a few seconds before 0
inline constexpr std::size_t kMaxTextLength = 256;

/// Checks the values of a packet during decoding and keeps the first error. Values decoded after an error are
/// meaningless.
class PacketValidator {
 public:
  void require(bool is_valid, DecodeError error) {
    if (!is_valid && error_ == DecodeError::kNone) error_ = error;
  }
  // Comparisons with NaN are false, so NaN is rejected.
  double within(double value, double low, double high) {
    require(value >= low && value <= high, DecodeError::kNumber);
    return value;
  }
  double within(double value, double bound) { return within(value, -bound, bound); }
  double probability(double value) { return within(value, 0, 1); }
  Duration time(double seconds) { return time_since(0, seconds); }
  /// A time by the clock of a sender of vision packets, which may count from any time.
  Duration sender_time(double seconds) { return time_since(kMinSenderTime_s, seconds); }
  template <typename List>
  void at_most(const List& list, int max_count) {
    require(list.size() <= max_count, DecodeError::kTooMany);
  }
  template <typename Text>
  const Text& text(const Text& text) {
    require(text.size() <= kMaxTextLength, DecodeError::kText);
    return text;
  }
  bool is_valid() const { return error_ == DecodeError::kNone; }
  DecodeError error() const { return error_; }

 private:
  Duration time_since(double min_s, double seconds) {
    const bool is_valid = seconds >= min_s && seconds <= kMaxTime_s;
    require(is_valid, DecodeError::kTime);
    return is_valid ? from_seconds(seconds) : Duration{0};
  }

  DecodeError error_ = DecodeError::kNone;
};

}  // namespace sidestep::league
