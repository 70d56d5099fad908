// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/study_table.hpp"

namespace sidestep {

struct CacheStrategies {
  std::vector<double> waypoint_probabilities{0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  std::size_t courses = 3;
  std::size_t replans = 890;  ///< in each course
};

/// The four ways to replace way points in the cache of one tree (ERRT), over how likely it grows towards a
/// way point: replans among moving obstacles, all in each cycle, in turn.
StudyTable cache_strategies(const CacheStrategies& settings, std::uint64_t seed, const StudyAdvance& advance);

}  // namespace sidestep
