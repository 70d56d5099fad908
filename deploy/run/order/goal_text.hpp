// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/protocol/order.hpp"

namespace sidestep {

/// Reads "X,Y" or "X,Y,HEADING", in metres and radians. Throws UsageError.
[[nodiscard]] Goal parse_goal(const std::string& text);

/// Reads "X,Y", in metres. `what` ("corner of a zone") appears in the message. Throws UsageError.
[[nodiscard]] Vec2 parse_place(const std::string& text, const std::string& what);

/// Reads a robot's number, or "all" for kAllRobots. Throws UsageError.
[[nodiscard]] RobotId parse_robots(const std::string& text);

using GoalLists = std::map<RobotId, std::vector<Goal>>;

/// Reads robots' goals from a YAML text such as "3: [[1.2, -0.4], [0, 0, 1.57]]". `file_name` appears in
/// error messages. Throws ConfigError.
[[nodiscard]] GoalLists parse_goal_lists(const std::string& text, const std::string& file_name);

}  // namespace sidestep
