// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/geometry/field.hpp"
#include "common/map/floor_map.hpp"
#include "common/motion/limits.hpp"

namespace sidestep {

/// Constraints that every version must satisfy, regardless of other robots.
struct FloorRules {
  Field field;
  std::vector<Shape> obstacles;
  MotionLimits limits;
  double radius_m = 0.09;
  double margin_m = 0.014;
  std::shared_ptr<const FloorMap> map{};  ///< additional obstacles; null: none

  /// Minimum distance between the centres of two robots, without inflation.
  double min_separation_m() const { return 2 * radius_m + margin_m; }
};

}  // namespace sidestep
