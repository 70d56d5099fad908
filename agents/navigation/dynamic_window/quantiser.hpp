// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace sidestep {

/// Quantises times to at most 256 ascending levels, numbered by one byte. A time is stored as the number of
/// the last level that is not after it. So the stored time is never later than the true time, and the numbers
/// have the same order as the times.
class Quantiser {
 public:
  static constexpr std::size_t kLevels = 256;

  /// Evenly spaced levels from 0 to the horizon. Throws std::invalid_argument if the horizon is not positive
  /// and finite.
  static Quantiser uniform(float horizon_s);
  /// At most `levels` levels for these times (Lloyd 1982, Max 1960): intervals whose boundaries lie halfway
  /// between the means of neighbouring intervals. Unlike the original, each interval is represented by its
  /// minimum (Philippsen, EPFL thesis 3146, ch. 3). The first level is 0. The last level is the horizon,
  /// which represents all later times. Throws std::invalid_argument if there are fewer than three levels or
  /// more than kLevels, or a time is negative.
  static Quantiser lloyd_max(std::span<const float> times_s, float horizon_s, std::size_t levels = kLevels);

  /// The number of the last level that is not after the time. Precondition: the time is not negative.
  std::uint8_t encode(float time_s) const;
  float decode(std::uint8_t number) const { return levels_s_[number]; }

  /// The number of levels; the remaining entries repeat the last level.
  std::size_t size() const { return size_; }

 private:
  Quantiser() = default;

  std::array<float, kLevels> levels_s_{};
  std::size_t size_ = 0;
};

}  // namespace sidestep
