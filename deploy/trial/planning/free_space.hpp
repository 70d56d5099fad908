// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "deploy/trial/planning/rounded_shape.hpp"
#include "deploy/trial/planning/worlds.hpp"

namespace sidestep {

/// Decides whether a free path for the disc robot joins two positions, exactly up to rounding. Uses neither
/// planners nor samples, so it is the reference for which queries of a benchmark are solvable.
///
/// The blocked positions form a union of convex sets: the obstacles inflated by the robot's radius, and four
/// half-planes outside of the field. Two free positions are separated exactly if a closed curve in that union
/// winds around one of them and not around the other (Alexander duality), and all such curves are generated
/// by the overlaps between pairs of sets (nerve theorem).
class FreeSpace {
 public:
  /// Copies the data that it needs from the world.
  explicit FreeSpace(const PlanWorld& world);

  /// Whether a free path joins the positions. Precondition: both are free.
  [[nodiscard]] bool connects(const Vec2& a_m, const Vec2& b_m) const;

 private:
  /// Two overlapping sets, with a curve from the anchor of one through a common point to the anchor of the
  /// other.
  struct Overlap {
    std::uint32_t first, second;
    Vec2 common_m;
  };

  void add_field_sides(const PlanWorld& world);

  std::vector<RoundedShape> blocked_;
  std::vector<Overlap> overlaps_;
};

}  // namespace sidestep
