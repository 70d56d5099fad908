// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/evaluation/study/study_table.hpp"

namespace sidestep {

struct FrameTimes {
  std::size_t rounds = 2000;  ///< frames of each camera
};

/// Processor time from frames to the world's state: 22 robots on a division-A field under one, two and four
/// cameras of 780 x 580 pixels, all of whose frames are read one after the other.
StudyTable frame_times(const FrameTimes& settings, std::uint64_t seed, const StudyAdvance& advance);

}  // namespace sidestep
