// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/motion/version.hpp"
#include "deploy/inspect/floor/floor_state.hpp"

namespace sidestep {

/// Two robots and the distance between their edges.
struct ClosestPair {
  double clearance_m = 0;
  RobotId first = 0, second = 0;
  Time at{};
};

/// The position of a robot's centre.
struct RobotPlace {
  RobotId id = 0;
  Vec2 position_m{0, 0};
};

/// The two robots that are closest; nullopt if there are fewer than two.
[[nodiscard]] std::optional<ClosestPair> closest_pair(std::vector<RobotPlace> robots, double radius_m,
                                                      Time now);

/// The positions of the robots on the floor: from ground truth if it is received, otherwise from vision.
[[nodiscard]] std::vector<RobotPlace> places_of(const FloorState& floor, Time now);

}  // namespace sidestep
