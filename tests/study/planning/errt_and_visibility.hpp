// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

struct ErrtAndVisibility {
  std::vector<std::size_t> obstacles{4, 8, 16, 32, 64, 128, 256, 512};
  std::size_t worlds = 25;   ///< number of worlds of each size
  std::size_t queries = 40;  ///< number of queries in each world
};

/// Compares planners with one and two trees to visibility graphs. The tree planners are ERRT, whose cache is
/// filled by the earlier queries in a world, raw and smoothed, and plain RRT and RRT-Connect without our
/// additions. The visibility graphs are the full graph, either kept for a world or rebuilt for each query as
/// moving obstacles would require, and the lazy graph, which keeps nothing between queries. Times and lengths
/// are functions of the number of circles; the field grows with this number, so that the density is constant.
StudyTable errt_and_visibility(const ErrtAndVisibility& settings, std::uint64_t seed,
                               const ProgressCallback& progress);

}  // namespace sidestep
