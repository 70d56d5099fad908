// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/study_table.hpp"

namespace sidestep {

struct BridgesAndExtensions {
  std::vector<std::size_t> extensions{1, 2, 4, 8, 32};
  std::vector<std::size_t> bridges{1, 2, 4, 8, 16, 32};
  std::size_t worlds = 20;
  std::size_t queries = 20;  ///< in each world
  double step_m = 0.25;      ///< of an extension: a ten-metre field is crossed in forty
};

/// Two trees (multi-bridge ERRT without cache: every query is new) over how often a tree is extended towards
/// one target, and how many bridges are waited for: lengths of ways and times, among 64 circles.
StudyTable bridges_and_extensions(const BridgesAndExtensions& settings, std::uint64_t seed,
                                  const StudyAdvance& advance);

}  // namespace sidestep
