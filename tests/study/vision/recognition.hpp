// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

struct Recognition {
  std::size_t frames = 10000;  ///< number of frames per row
  std::size_t frames_per_scene = 250;
};

/// Measures detection in frames of a camera over a quarter of a division-A field, with 780 x 580 pixels in
/// 4:2:2. The columns are the share of robots found per frame, the number of misidentified robots, and errors
/// of position and heading. The conditions are thresholds learned before colours drift or default ones, good
/// and bad light, and one dot of each robot covered.
[[nodiscard]] StudyTable recognition(const Recognition& settings, std::uint64_t seed,
                                     const ProgressCallback& advance);

}  // namespace sidestep
