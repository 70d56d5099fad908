// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/study_table.hpp"

namespace sidestep {

struct CacheReplans {
  std::size_t replans = 2670;
};

/// Replans among moving obstacles (ReplanCourse) with one tree (ERRT) and with two, each without a cache of
/// way points and with one of 50 that is drawn from with probability 0.4 (Bruce 2006, chapter 4). All plan in
/// each cycle, in turn.
StudyTable cache_replans(const CacheReplans& settings, std::uint64_t seed, const StudyAdvance& advance);

}  // namespace sidestep
