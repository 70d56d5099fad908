// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

struct RoadmapConnections {
  std::vector<std::size_t> sectors{4, 6, 8, 12, 16};
  std::vector<std::size_t> blocked_per_sector{0, 2, 8};  ///< number of blocked motions kept per sector
  std::vector<std::size_t> neighbours{4, 6, 8, 12, 16};
  std::vector<double> radii_m{1, 1.25, 1.5, 1.75, 2};
  std::vector<double> displacements_m{0, 0.5};  ///< displacement of each obstacle after the roadmap was built
  std::size_t nodes = 200;
  std::size_t worlds = 50;
  std::size_t queries = 20;  ///< number of queries per world
};

/// Compares connection methods of a dynamic roadmap among 64 circles: the nearest node in each sector, the
/// nearest nodes, and all nodes within a radius. Sectors are compared without and with blocked motions. All
/// methods connect the same nodes. Every query uses the roadmap as it was built; no samples are added.
StudyTable roadmap_connections(const RoadmapConnections& settings, std::uint64_t seed,
                               const ProgressCallback& progress);

}  // namespace sidestep
