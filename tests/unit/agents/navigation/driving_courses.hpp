// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "agents/planning/joint/fastest_stop.hpp"
#include "common/motion/driving_course.hpp"
#include "common/motion/limits.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep {

/// A robot's course along a trajectory, planned at its start.
inline DrivingCourse course_of(RobotId robot, const Trajectory& trajectory) {
  DrivingCourse course;
  course.robot = robot;
  course.planned_at = course.start = trajectory.start();
  course.due = trajectory.end();
  for (Time t = trajectory.start(); t < trajectory.end(); t += DrivingCourse::kSample)
    course.states.push_back(trajectory.state_at(t));
  course.states.push_back({trajectory.rest_position_m(), {0, 0}});
  return course;
}

/// The course of a robot that drives as fast as it may, without regard to others.
inline DrivingCourse direct_course(RobotId robot, Time start, const State& from, const Vec2& to_m) {
  return course_of(robot, fastest_stop(start, from, to_m, MotionLimits{}));
}

/// A course near the origin. It starts within 0.5 s of `around`.
inline DrivingCourse random_driving_course(RobotId robot, Time around, Rng& rng) {
  DrivingCourse course = course_of(robot, random_trajectory(rng, around));
  course.continues = rng.chance(0.3);
  return course;
}

/// The smallest distance of two robots on their courses from a time on, compared every millisecond.
inline double nearest_m(const DrivingCourse& a, const DrivingCourse& b, Time from) {
  double nearest_m = (a.state_at(from).position_m - b.state_at(from).position_m).norm();
  for (Time t = from; t <= std::max(a.end(), b.end()); t += Duration{1'000'000})
    nearest_m = std::min(nearest_m, (a.state_at(t).position_m - b.state_at(t).position_m).norm());
  return nearest_m;
}

}  // namespace sidestep
