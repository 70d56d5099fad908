// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "common/time/time.hpp"

namespace sidestep {

/// The share of a time in which every one of several sources was heard. A source counts as heard for as long
/// as it is silent for at most kMaxSilence. Memory is bounded by the number of sources.
class HeardTime {
 public:
  static constexpr Duration kMaxSilence{200'000'000};

  explicit HeardTime(std::size_t sources) : sources_(sources) {}

  /// The time begins. What was heard earlier does not count.
  void begin(Time now);
  /// The source is heard. If it was silent for longer than kMaxSilence, the last `unheard` of its silence
  /// counts as unheard. Precondition: times never decrease.
  void hear(std::size_t source, Time now, Duration unheard);
  /// The next silence of this source does not count.
  void expect_silence(std::size_t source) { sources_[source].is_silence_expected = true; }

  /// Share of the time from its beginning until now, 0 before its beginning. `counts_last_silence`: a source
  /// that has now been silent for longer than kMaxSilence counts as unheard since it was last heard.
  [[nodiscard]] double share(Time now, bool counts_last_silence) const;

 private:
  static constexpr std::size_t kMaxGaps = 64;

  struct Source {
    Time heard_at{};
    bool is_silence_expected = false;
  };
  struct Gap {
    Time from, to;
  };

  bool has_begun_ = false;
  Time begun_at_{};
  std::vector<Source> sources_;
  std::deque<Gap> gaps_;      ///< the latest ones, disjoint, in order
  Duration earlier_gaps_{0};  ///< sum of those before; a gap that overlaps them counts twice
};

}  // namespace sidestep
