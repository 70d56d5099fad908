// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace sidestep {

using Vec2 = Eigen::Vector2d;

/// The z component of the cross product: positive if b lies to the left of a.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// a rotated by 90 degrees to the left.
inline Vec2 left_of(const Vec2& a) { return {-a.y(), a.x()}; }

/// a rotated to the left by `angle_rad`.
inline Vec2 rotated(const Vec2& a, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * a.x() - s * a.y(), s * a.x() + c * a.y()};
}

/// The equivalent angle in [-pi, pi].
inline double wrapped_rad(double angle_rad) { return std::remainder(angle_rad, 2 * std::numbers::pi); }

}  // namespace sidestep
