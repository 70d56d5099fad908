// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "deploy/evaluation/study/study_table.hpp"

namespace sidestep {

struct PatchErrors {
  std::size_t frames = 300;                     ///< of each row
  std::vector<double> noises{1, 2.5, 4, 6, 8};  ///< of the sensor, in red, green and blue, of 255
};

/// What errors of single dots do to a robot's pose, in frames with more and more noise: the dots' centroid
/// and the heading, measured, and predicted from the dots' own errors as s/sqrt(n) and s/sqrt(sum r²)
/// (common/marking/pose_error.hpp). What a dot is off on average on all robots is no error of single dots and
/// left out: the front dots lie at the robot's edge, and seem 0.7 mm farther ahead before a floor that is
/// brighter than the robot.
StudyTable patch_errors(const PatchErrors& settings, std::uint64_t seed, const StudyAdvance& advance);

}  // namespace sidestep
