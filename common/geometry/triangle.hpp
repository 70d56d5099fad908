// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/vec3.hpp"

namespace sidestep {

/// A triangle in space.
struct Triangle {
  Vec3 a_m, b_m, c_m;
};

/// The square of the distance from a point to the nearest one of a triangle, which may be as thin as a line.
double squared_distance(const Vec3& p, const Triangle& triangle);

/// The square of the smallest distance between points of two segments, each of which may be a point.
double squared_distance(const Vec3& a_from, const Vec3& a_to, const Vec3& b_from, const Vec3& b_to);

/// The square of the smallest distance between points of a segment and a triangle, 0 where they meet.
double squared_distance(const Vec3& from, const Vec3& to, const Triangle& triangle);

}  // namespace sidestep
