// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/study_table.hpp"

namespace sidestep {

struct Recognition {
  std::size_t frames = 10000;  ///< of each row
};

/// Frames of a camera over a quarter of a division-A field, 780 x 580 pixels in 4:2:2, with thresholds of
/// colours that were learned before they drift, and with the default ones: how many of the robots are found
/// in each frame, how many names are wrong, and how far positions and headings are off, in good light and
/// bad, and with one dot of each robot covered.
StudyTable recognition(const Recognition& settings, std::uint64_t seed, const StudyAdvance& advance);

}  // namespace sidestep
