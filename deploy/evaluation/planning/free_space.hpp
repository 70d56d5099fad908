// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "deploy/evaluation/planning/rounded_shape.hpp"
#include "deploy/evaluation/planning/worlds.hpp"

namespace sidestep {

/// Decides exactly, up to rounding, whether a path for the disc robot joins two positions. It uses neither
/// planners nor samples, so it decides which queries of a benchmark are solvable.
///
/// The positions that are blocked are a union of convex sets: the obstacles inflated by the robot's radius,
/// and four half-planes outside of the field. Two free positions are separated exactly if a closed curve in
/// that union winds round one of them and not round the other (Alexander duality), and the overlaps between
/// pairs of sets generate all such curves (nerve theorem).
class FreeSpace {
 public:
  /// Copies what it needs of the world.
  explicit FreeSpace(const PlanWorld& world);

  /// Both positions have to be free.
  [[nodiscard]] bool connects(const Vec2& a_m, const Vec2& b_m) const;

 private:
  /// Two sets that overlap, with a curve from one's anchor over a common point to the other's anchor.
  struct Overlap {
    std::uint32_t first, second;
    Vec2 common_m;
  };

  void add_field_sides(const PlanWorld& world);

  std::vector<RoundedShape> blocked_;
  std::vector<Overlap> overlaps_;
};

}  // namespace sidestep
