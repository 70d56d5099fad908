// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/reception_coverage.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {

void ReceptionCoverage::begin(Time now) {
  has_begun_ = true;
  begun_at_ = now;
  for (Source& source : sources_) source.heard_at = now;
}

void ReceptionCoverage::hear(std::size_t source, Time now, Duration unheard) {
  Source& heard = sources_[source];
  const Duration silence = now - heard.heard_at;
  heard.heard_at = now;
  if (silence <= kMaxSilence) return;
  const bool was_expected = std::exchange(heard.is_silence_expected, false);
  if (!has_begun_ || was_expected || unheard <= Duration{0}) return;
  Gap gap{now - std::min(silence, unheard), now};
  while (!gaps_.empty() && gaps_.back().to >= gap.from) {
    gap.from = std::min(gap.from, gaps_.back().from);
    gap.to = std::max(gap.to, gaps_.back().to);
    gaps_.pop_back();
  }
  gaps_.push_back(gap);
  if (gaps_.size() <= kMaxGaps) return;
  earlier_gaps_ += gaps_.front().to - gaps_.front().from;
  gaps_.pop_front();
}

double ReceptionCoverage::share(Time now, bool counts_last_silence) const {
  if (!has_begun_ || now <= begun_at_) return 0;
  Time last_silence_from = now;
  for (const Source& source : sources_) {
    if (counts_last_silence && !source.is_silence_expected && now - source.heard_at > kMaxSilence)
      last_silence_from = std::min(last_silence_from, source.heard_at);
  }
  Duration unheard = earlier_gaps_ + (now - last_silence_from);
  for (const Gap& gap : gaps_)
    unheard += std::max(Duration{0}, std::min(gap.to, last_silence_from) - gap.from);
  return std::clamp(1 - to_seconds(unheard) / to_seconds(now - begun_at_), 0.0, 1.0);
}

}  // namespace sidestep
