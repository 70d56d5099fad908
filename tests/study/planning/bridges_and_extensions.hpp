// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

struct BridgesAndExtensions {
  std::vector<std::size_t> extensions{1, 2, 4, 8, 32};
  std::vector<std::size_t> bridges{1, 2, 4, 8, 16, 32};
  std::size_t worlds = 50;
  std::size_t queries = 20;  ///< number of queries per world
  double step_m = 0.25;      ///< length of an extension; forty span the 10 m field
};

/// Path lengths and times of two trees (multi-bridge ERRT, Bruce 2006, section 4.3.4) among 64 circles, as
/// functions of the number of extensions towards one target and the number of bridges. There is no waypoint
/// cache, because every query is new.
StudyTable bridges_and_extensions(const BridgesAndExtensions& settings, std::uint64_t seed,
                                  const ProgressCallback& progress);

}  // namespace sidestep
