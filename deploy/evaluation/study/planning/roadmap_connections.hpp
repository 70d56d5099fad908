// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/study_table.hpp"

namespace sidestep {

struct RoadmapConnections {
  std::vector<std::size_t> sectors{4, 6, 8, 12, 16};
  std::vector<std::size_t> neighbours{4, 6, 8, 12, 16};
  std::vector<double> radii_m{1, 1.25, 1.5, 1.75, 2};
  std::vector<double> moved_m{0, 0.5};  ///< by what each obstacle has moved since the roadmap was built
  std::size_t nodes = 200;
  std::size_t worlds = 10;
  std::size_t queries = 20;  ///< in each world
};

/// The ways to connect a dynamic roadmap among 64 circles: the nearest in each sector, the nearest, all
/// within a radius. All join the same states; every query gets the roadmap as it was built, and may not draw
/// more.
StudyTable roadmap_connections(const RoadmapConnections& settings, std::uint64_t seed,
                               const StudyAdvance& advance);

}  // namespace sidestep
