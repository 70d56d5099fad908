// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "agents/planning/joint/course.hpp"

namespace sidestep {

/// Interval between the samples of a course. Planners at full speed compare robots at these times.
inline constexpr double kCourseSample_s = 0.05;

/// A course that does not stop between its legs, together with its positions at multiples of
/// kCourseSample_s, from Time{} on.
struct SampledCourse {
  Course course;
  std::vector<Vec2> samples_m;  ///< never empty; the last sample is the position of rest

  double arrival_s() const { return to_seconds(course.end() - Time{}); }
  const Vec2& at(std::size_t sample) const { return samples_m[std::min(sample, samples_m.size() - 1)]; }
};

/// The maximum distance between a motion and the straight line between two of its samples, for accelerations
/// up to `acceleration_mps2`.
inline double sampling_error_m(double acceleration_mps2) {
  return acceleration_mps2 * kCourseSample_s * kCourseSample_s / 8;
}

}  // namespace sidestep
