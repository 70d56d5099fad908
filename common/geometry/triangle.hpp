// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec3.hpp"

namespace sidestep {

/// A triangle in space.
struct Triangle {
  Vec3 a_m, b_m, c_m;
};

/// The squared distance from a point to a triangle, which may be degenerate.
double squared_distance(const Vec3& p, const Triangle& triangle);

/// The squared distance between two segments, each of which may be a point.
double squared_distance(const Vec3& a_from, const Vec3& a_to, const Vec3& b_from, const Vec3& b_to);

/// The squared distance between a segment and a triangle, 0 if they intersect.
double squared_distance(const Vec3& from, const Vec3& to, const Triangle& triangle);

}  // namespace sidestep
