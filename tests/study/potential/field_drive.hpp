// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "common/collision/obstacle_world.hpp"
#include "common/motion/limits.hpp"
#include "deploy/trial/planning/worlds.hpp"

namespace sidestep {

enum class DriveEnd { kArrived, kLocalMinimum, kContact, kTimeLimit };

struct FieldDrive {
  DriveEnd end = DriveEnd::kTimeLimit;
  double seconds = 0;
  double length_m = 0;
  int reversals = 0;
  std::vector<Vec2> path_m;  ///< one position per cycle, beginning at the start
};

/// Returns the direction in which to drive from a position, as a unit vector; zero: stop.
using DriveDirection = std::function<Vec2(const Vec2&)>;

/// Drives a disc with limited acceleration to the goal of the world's query. In each cycle the disc
/// accelerates towards its target speed in the method's direction. It slows down before the goal. `obstacles`
/// are the world's obstacles.
[[nodiscard]] FieldDrive drive_by_direction(const DriveDirection& direction, const PlanWorld& world,
                                            const ObstacleWorld& obstacles);

}  // namespace sidestep
