// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "agents/planning/joint/course.hpp"

namespace sidestep {

/// Interval between the samples of a course. Planners at full speed compare robots at these times.
inline constexpr double kCourseSample_s = 0.05;

/// A robot's positions at multiples of kCourseSample_s, never empty.
struct TimedPositions {
  std::span<const Vec2> at_m;
  bool stays = true;  ///< it rests at the last one; otherwise nobody knows where it will be after that

  const Vec2& at(std::size_t sample) const { return at_m[std::min(sample, at_m.size() - 1)]; }
  bool is_known(std::size_t sample) const { return stays || sample < at_m.size(); }
  double end_s() const { return kCourseSample_s * static_cast<double>(at_m.size() - 1); }
};

/// A course that does not stop between its legs, together with its positions at multiples of
/// kCourseSample_s, from Time{} on.
struct SampledCourse {
  Course course;
  std::vector<Vec2> samples_m;  ///< never empty; the last sample is the position of rest

  double arrival_s() const { return to_seconds(course.end() - Time{}); }
  const Vec2& at(std::size_t sample) const { return samples_m[std::min(sample, samples_m.size() - 1)]; }
  TimedPositions positions() const { return {samples_m}; }
};

/// The maximum distance between a motion and the straight line between two of its samples, for accelerations
/// up to `acceleration_mps2`.
inline double sampling_error_m(double acceleration_mps2) {
  return acceleration_mps2 * kCourseSample_s * kCourseSample_s / 8;
}

}  // namespace sidestep
