// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/table/study_table.hpp"

namespace sidestep {

struct Recognition {
  std::size_t frames = 10000;  ///< per row
  std::size_t frames_per_scene = 250;
};

/// Detection in frames of a camera over a quarter of a division-A field, 780 x 580 pixels in 4:2:2, with
/// thresholds learned before colours drift and with the default ones: share of robots found per frame, number
/// of misidentified robots, and errors of position and heading, in good and bad light and with one dot of
/// each robot covered.
[[nodiscard]] StudyTable recognition(const Recognition& settings, std::uint64_t seed,
                                     const ProgressCallback& advance);

}  // namespace sidestep
