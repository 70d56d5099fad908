// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/study/table/study_table.hpp"

namespace sidestep {

struct FrameTimes {
  std::size_t rounds = 2000;  ///< frames per camera
  std::size_t frames_per_scene = 250;
};

/// Measures the processor time from frames to the world state: 22 robots on a division-A field under one, two
/// and four cameras of 780 x 580 pixels, whose frames are processed one after another.
[[nodiscard]] StudyTable frame_times(const FrameTimes& settings, std::uint64_t seed,
                                     const ProgressCallback& advance);

}  // namespace sidestep
