// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

struct CollisionDomains {
  std::size_t obstacles = 64;  ///< a square number
  std::size_t queries = 1000;
  std::size_t repetitions = 1000;  ///< number of repetitions of each query in a row
  std::size_t rounds = 5;
};

/// Measures the distribution of query times in two domains with the same number of circles as in the thesis
/// (Bruce 2006, figures 3.8 and 3.9): at random positions and on a grid. A query's time is the median, over
/// rounds in shuffled order, of its mean over repetitions, with predicted branches and cached obstacles.
StudyTable collision_domains(const CollisionDomains& settings, std::uint64_t seed,
                             const ProgressCallback& progress);

}  // namespace sidestep
