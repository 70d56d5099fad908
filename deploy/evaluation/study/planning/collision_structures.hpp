// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/table/study_table.hpp"

namespace sidestep {

struct CollisionStructures {
  std::vector<std::size_t> obstacles{4, 16, 64, 256, 1024, 4096, 16384};
  std::size_t queries = 20'000;
  std::size_t rounds = 9;
};

/// Structures that decide whether a moving disc touches anything (Bruce 2006, chapter 3), and FCL's, over the
/// number of circles: times of a query, medians of rounds in which all get the same queries, in shuffled
/// order.
StudyTable collision_structures(const CollisionStructures& settings, std::uint64_t seed,
                                const ProgressCallback& progress);

}  // namespace sidestep
