// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "common/time/time.hpp"

namespace sidestep {

/// Measures the fraction of a period in which all of several sources were heard. A source counts as heard as
/// long as it is never silent for more than kMaxSilence. Memory is bounded by the number of sources.
class ReceptionCoverage {
 public:
  static constexpr Duration kMaxSilence{200'000'000};

  explicit ReceptionCoverage(std::size_t sources) : sources_(sources) {}

  /// Starts the period. Anything heard earlier does not count.
  void begin(Time now);
  /// Records that the source is heard. If it was silent for longer than kMaxSilence, the last part of that
  /// silence, as long as `unheard`, counts as unheard. Precondition: times never decrease.
  void hear(std::size_t source, Time now, Duration unheard);
  /// Excuses the next silence of this source.
  void expect_silence(std::size_t source) { sources_[source].is_silence_expected = true; }

  /// Fraction of the period from its start until now; 0 before its start. If `counts_last_silence`, a source
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
  std::deque<Gap> gaps_;      ///< the latest gaps, disjoint and in order
  Duration earlier_gaps_{0};  ///< total of the earlier gaps; a gap that overlaps them counts twice
};

}  // namespace sidestep
