// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tests/study/table/study_table.hpp"

namespace sidestep {

struct MarkerErrors {
  std::size_t frames = 300;                     ///< number of frames per row
  std::vector<double> noises{1, 2.5, 4, 6, 8};  ///< noise of the sensor per channel, in levels of 255
  std::size_t frames_per_scene = 10;
};

/// Measures how errors of single dots propagate to a robot's pose, in frames with increasing noise (Bruce,
/// CMU-CS-06-181, appendices A.2.1 and A.2.2): errors of the dots' centroid and of the heading, measured, and
/// predicted from the errors of the dots as s/sqrt(n) and s/sqrt(sum r²) (common/marking/pose_error.hpp). The
/// mean error of each dot over all robots is a bias and is subtracted: the front dots lie at the robot's edge
/// and appear 0.7 mm too far forward if the floor is brighter than the robot.
[[nodiscard]] StudyTable marker_errors(const MarkerErrors& settings, std::uint64_t seed,
                                       const ProgressCallback& advance);

}  // namespace sidestep
