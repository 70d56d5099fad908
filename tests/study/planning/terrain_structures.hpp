// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

struct TerrainStructures {
  std::vector<std::size_t> squares{4, 8, 16, 32, 64, 128};  ///< grid squares along each side
  std::size_t queries = 1000;
  std::size_t rounds = 9;
  std::size_t max_linear_triangles = 2048;  ///< larger terrains are not timed with the linear list
};

/// Compares structures for the collision of a moving ball with terrain and for its clearance: TerrainTree,
/// FCL's tree over the same mesh with both of its solvers, and a linear list of triangles. Times are
/// functions of the number of triangles: medians over rounds in which all structures get the same queries, in
/// shuffled order. Answers are checked against the linear list's.
StudyTable terrain_structures(const TerrainStructures& settings, std::uint64_t seed,
                              const ProgressCallback& progress);

}  // namespace sidestep
