// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/time/time.hpp"

namespace sidestep {

/// What a RateMeter has seen over some span.
struct Rate {
  std::uint64_t samples = 0;
  double rate_hz = 0;  ///< gaps per second between the first and the last sample; 0 below two
  std::optional<Duration> shortest_gap;  ///< none below two samples
  std::optional<Duration> longest_gap;
  double bytes_per_second = 0;  ///< of payload: sizes of all but the first sample over the span
};

/// Rate, gaps and bandwidth of a stream of samples, since the start and since the last look.
class RateMeter {
 public:
  void add(Time received, std::size_t bytes);
  Rate total() const { return total_.rate(); }
  /// Since the last call; the gap that spans two looks counts for the later one.
  Rate take_recent();

 private:
  struct Span {
    void add(Time received, std::size_t bytes);
    Rate rate() const;

    std::uint64_t samples = 0;
    Time first{};
    Time last{};
    bool has_last = false;  ///< `last` is a sample of this span or of the one before
    std::uint64_t gaps = 0;
    Duration shortest = Duration::max();
    Duration longest{0};
    std::uint64_t bytes = 0;  ///< since `first`
  };

  Span total_;
  Span recent_;
};

}  // namespace sidestep
