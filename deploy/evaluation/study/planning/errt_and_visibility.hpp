// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/study_table.hpp"

namespace sidestep {

struct ErrtAndVisibility {
  std::vector<std::size_t> obstacles{4, 8, 16, 32, 64, 128, 256, 512};
  std::size_t worlds = 5;    ///< of each size
  std::size_t queries = 40;  ///< in each world
};

/// One tree and two (ERRT, its cache filled by the earlier queries in a world), as they are and smoothed,
/// against visibility graphs: the full one, kept for a world or built anew for each query as it has to be
/// when obstacles move, and the lazy one, which keeps nothing. Times and lengths over the number of circles;
/// the field grows with it, so that they are always as dense.
StudyTable errt_and_visibility(const ErrtAndVisibility& settings, std::uint64_t seed,
                               const StudyAdvance& advance);

}  // namespace sidestep
