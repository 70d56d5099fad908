// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "common/motion/driving_course.hpp"

namespace sidestep {

/// A course that rests, then drives straight, and stops within its last sample. Both durations are multiples
/// of DrivingCourse::kSample.
inline DrivingCourse straight_course(RobotId robot, Time start, Duration rest, const Vec2& from_m,
                                     const Vec2& velocity_mps, Duration drive) {
  DrivingCourse course;
  course.robot = robot;
  course.planned_at = course.due = course.start = start;
  for (Duration t{0}; t <= rest + drive; t += DrivingCourse::kSample) {
    const bool is_driving = t >= rest && t < rest + drive;
    course.states.push_back({from_m + to_seconds(std::max(t - rest, Duration{0})) * velocity_mps,
                             is_driving ? velocity_mps : Vec2(0, 0)});
  }
  return course;
}

}  // namespace sidestep
