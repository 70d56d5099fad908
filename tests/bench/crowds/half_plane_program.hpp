// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "common/geometry/circle.hpp"
#include "common/geometry/vec2.hpp"

namespace sidestep {

/// The points at the boundary and beyond it, in the direction of the normal.
struct HalfPlane {
  Vec2 point{0, 0};   ///< on the boundary
  Vec2 normal{1, 0};  ///< unit vector

  /// The distance of a position from the boundary, negative outside the half-plane.
  double depth(const Vec2& position) const { return (position - point).dot(normal); }
};

/// The point of the disc and of all half-planes that is nearest to `target`; nullopt if they have no point in
/// common. Adds the half-planes one by one (de Berg et al., Computational Geometry, ch. 4): if their order is
/// random, the expected time is linear in their number.
[[nodiscard]] std::optional<Vec2> nearest_inside(std::span<const HalfPlane> planes, const Circle& disc,
                                                 const Vec2& target);

/// A point of the disc and of all `hard` half-planes that is as little outside of the `soft` half-planes as
/// possible: the largest distance by which it is outside of one of them is minimal. This is the 3-D linear
/// programme for densely packed conditions of van den Berg et al., Reciprocal n-body collision avoidance.
/// nullopt if the disc and the hard half-planes have no point in common.
[[nodiscard]] std::optional<Vec2> least_outside(std::span<const HalfPlane> hard,
                                                std::span<const HalfPlane> soft, const Circle& disc);

}  // namespace sidestep
