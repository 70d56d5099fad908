// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

struct CollisionStructures {
  std::vector<std::size_t> obstacles{4, 16, 64, 256, 1024, 4096, 16384};
  std::size_t queries = 20'000;
  std::size_t rounds = 9;
};

/// Query times of structures that decide whether a moving disc touches anything (Bruce 2006, chapter 3), and
/// of FCL, as functions of the number of circles: medians over rounds in which all structures get the same
/// queries, in shuffled order.
StudyTable collision_structures(const CollisionStructures& settings, std::uint64_t seed,
                                const ProgressCallback& progress);

}  // namespace sidestep
