// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// The distance from a position to the nearest obstacle.
struct FreeDistance {
  double distance_m = std::numeric_limits<double>::infinity();
  Vec2 away{0, 0};  ///< unit vector pointing away from the nearest obstacle; 0 if unknown
};

/// Obstacle points, for example from a laser, for distance queries. They are stored in single precision
/// relative to the first robot position passed to set(), which costs at most a micrometre of accuracy within
/// ten metres.
class ObstaclePoints {
 public:
  /// Skips points that are not finite. Does not allocate once warm.
  void set(std::span<const Vec2> points_m, const Vec2& robot_m);

  /// The nearest of the points that are at least `masked_m` away from the robot.
  FreeDistance operator()(const Vec2& at_m, double masked_m) const;

 private:
  static constexpr std::size_t kLanes = 8;
  struct Block {
    float x_m[kLanes], y_m[kLanes], from_robot2_m2[kLanes];
  };
  template <bool kMasks>
  FreeDistance nearest(const Vec2& at_m, float masked2_m2) const;

  Vec2 origin_m_{0, 0};
  std::vector<Block> blocks_;
};

/// A distance query: `distance_m(position)` is the distance to the nearest obstacle. The direction away from
/// it is the gradient, by central differences. Cannot mask obstacles.
template <typename Distance>
class DistanceFunction {
 public:
  explicit DistanceFunction(Distance distance_m) : distance_m_(std::move(distance_m)) {}

  FreeDistance operator()(const Vec2& at_m, double) const {
    constexpr double kStep_m = 1e-4;
    const Vec2 x(kStep_m, 0), y(0, kStep_m);
    const Vec2 gradient(distance_m_(at_m + x) - distance_m_(at_m - x),
                        distance_m_(at_m + y) - distance_m_(at_m - y));
    const double length = gradient.norm();
    const bool is_known = std::isfinite(length) && length > 0;
    return {distance_m_(at_m), is_known ? Vec2(gradient / length) : Vec2(0, 0)};
  }

 private:
  Distance distance_m_;
};

}  // namespace sidestep
