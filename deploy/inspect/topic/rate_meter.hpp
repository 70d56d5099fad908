// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/time/time.hpp"

namespace sidestep {

/// Statistics of the samples in a span of time.
struct Rate {
  std::uint64_t samples = 0;
  double rate_hz = 0;  ///< gaps per second from the first to the last sample; 0 for fewer than two samples
  std::optional<Duration> min_gap;  ///< nullopt for fewer than two samples
  std::optional<Duration> max_gap;
  double bytes_per_second = 0;               ///< payload of all samples except the first, per second
  std::size_t min_bytes = 0, max_bytes = 0;  ///< payload size of a sample
  double mean_bytes = 0;
};

/// Rate, gaps and bandwidth of a stream of samples, since the start and since the last call.
class RateMeter {
 public:
  void add(Time received, std::size_t bytes);
  Rate total() const { return total_.rate(); }
  /// The rate since the last call. A gap that spans two calls counts for the later one.
  Rate take_recent();

 private:
  struct Span {
    void add(Time received, std::size_t bytes);
    Rate rate() const;

    std::uint64_t samples = 0;
    Time first{};
    Time last{};
    bool has_last = false;  ///< `last` is a sample in this span or the previous one
    std::uint64_t gaps = 0;
    Duration min_gap = Duration::max();
    Duration max_gap{0};
    std::uint64_t bytes = 0;  ///< since `first`
    std::uint64_t all_bytes = 0;
    std::size_t min_bytes = 0, max_bytes = 0;
  };

  Span total_;
  Span recent_;
};

}  // namespace sidestep
