// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

struct CacheStrategies {
  std::vector<double> waypoint_probabilities{0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
  std::size_t courses = 3;
  std::size_t replans = 890;  ///< number of replans in each course
};

/// Replan times with the four replacement strategies of the waypoint cache of one tree (ERRT), as functions
/// of the probability of growing towards a waypoint. In each cycle among moving obstacles all strategies
/// replan, in shuffled order.
StudyTable cache_strategies(const CacheStrategies& settings, std::uint64_t seed,
                            const ProgressCallback& progress);

}  // namespace sidestep
