// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/driving_course.hpp"
#include "common/motion/version.hpp"
#include "common/protocol/order.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// A robot that drives, and when it is due at its goal according to its intent or its course.
struct DueRobot {
  RobotId robot = 0;
  Time due{};
};

/// A robot that is overdue for longer counts as having just set out: robots before which it goes may be
/// unable to pass it.
inline constexpr Duration kMaxOverdue{10'000'000'000};

/// Whether `self` must yield to `other` while both drive. All robots must agree on who yields: if every robot
/// yields to every other, their choices oscillate. The robot that is due earlier goes first: a robot that is
/// nearly there loses most of its time by a detour. Robots whose due times are in the same quarter of a
/// second go by their ids, which count up for ten seconds of due times and then down. A robot without a due
/// time goes first.
[[nodiscard]] bool goes_first(const DueRobot& other, const DueRobot& self);

/// Whether a robot with course `b` has to avoid course `a`: whether the robot of `a` goes first. When the
/// courses were planned does not matter.
[[nodiscard]] bool precedes(const DrivingCourse& a, const DrivingCourse& b);

/// A robot that wants to pass, with the number of its order. The number is a clock reading, so older orders
/// have smaller numbers.
struct PassageContender {
  RobotId robot = 0;
  OrderNumber order = 0;
};

/// Whether `other` may pass before `self` where robots cannot pass each other and may have to wait for whole
/// periods. The older order goes first: no robot waits for more orders than were given before its own. Robots
/// with the same number, and in every fourth period all robots, go in a random order that is drawn again in
/// each period, because the robot with the oldest order may be unable to drive.
[[nodiscard]] bool other_passes_first(const PassageContender& other, const PassageContender& self, Time t,
                                      Duration period);

}  // namespace sidestep
