// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>

#include "common/motion/driving_course.hpp"
#include "common/motion/floor_rules.hpp"
#include "common/motion/trajectory.hpp"
#include "deploy/inspect/floor/floor_state.hpp"

namespace sidestep {

/// For each waiting robot, the robot that it waits for.
using Waits = std::map<RobotId, RobotId>;

/// A robot as waits_among() needs it.
struct PlannedRobot {
  RobotId id = 0;
  const DrivingCourse* course = nullptr;                       ///< not over; nullptr: none
  std::optional<Trajectory> version{};                         ///< used if there is no course
  double speed_mps = std::numeric_limits<double>::infinity();  ///< infinite: unknown
  double speed_limit_mps = 0;
};

/// For whom robots wait. A robot with a course waits if its course is slower than half of its speed limit, or
/// if the robot stands, unless it is at its goal. It waits for the robot that will be nearest in half a
/// second to the place where the waiting robot would then be if it drove on along its course at full speed,
/// if the distance of the two is below `separation_m`, the required distance of centres, plus 5 cm. It waits
/// for nobody if there is no such robot. Robots do not tell for whom they wait: this is an estimate.
[[nodiscard]] Waits waits_among(std::span<const PlannedRobot> robots, double separation_m, Time now);

/// For whom the robots of a floor wait. Speed limits are those of the rules, and lower ones due to clocks;
/// zones and orders are not considered.
[[nodiscard]] Waits waits_on(const FloorState& floor, const FloorRules& rules, Time now);

}  // namespace sidestep
