// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

struct CacheReplans {
  std::size_t replans = 2670;
};

/// Replans among moving obstacles (ReplanCourse) with one tree (ERRT) and with two, each without a waypoint
/// cache and with a cache of 50 waypoints, sampled with probability 0.4 (Bruce 2006, chapter 4). All planners
/// plan in each cycle, in shuffled order.
StudyTable cache_replans(const CacheReplans& settings, std::uint64_t seed, const ProgressCallback& progress);

}  // namespace sidestep
