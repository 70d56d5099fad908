// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/motion/driving_course.hpp"
#include "idl/course.hpp"

namespace sidestep {

/// Decodes an untrusted course. Returns nullopt unless an agent of the course's robot sent it or a
/// coordinator relayed it, all numbers are finite and physically plausible, its times are plausible
/// (is_plausible()) at `now`, by the local clock, and its last point is at rest. Of an empty course only
/// robot and planned_at are checked and decoded.
[[nodiscard]] std::optional<DrivingCourse> decode(const msg::Course& message, Time now);
/// Decodes an untrusted offer of a course, with the same checks of the course. Returns nullopt also if the
/// course is empty, and unless an agent of the robot that offers it sent the offer or a coordinator relayed
/// it.
[[nodiscard]] std::optional<CourseOffer> decode(const msg::CourseOffer& message, Time now);

/// Encodes a course without the header's incarnation, message_number and stamp_ns; its sender is the robot's
/// agent. Positions and velocities are rounded to single precision. Precondition: at most MAX_COURSE_POINTS
/// states.
msg::Course encode(const DrivingCourse& course);
/// Encodes an offer, likewise; its sender is the agent that offers it.
msg::CourseOffer encode(const CourseOffer& offer);

}  // namespace sidestep
