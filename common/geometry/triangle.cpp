// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/triangle.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace sidestep {
namespace {

double squared_distance(const Vec3& p, const Vec3& from, const Vec3& to) {
  const Vec3 direction = to - from, off = p - from;
  const double length2 = direction.squaredNorm();
  const double along = length2 > 0 ? std::clamp(off.dot(direction) / length2, 0.0, 1.0) : 0.0;
  return (off - along * direction).squaredNorm();
}

/// Whether the projection of a point onto a triangle's plane lies in the triangle.
bool projects_into(const Vec3& p, const Triangle& t, const Vec3& normal) {
  const auto side = [&](const Vec3& from, const Vec3& to) { return normal.dot((to - from).cross(p - from)); };
  const double ab = side(t.a_m, t.b_m), bc = side(t.b_m, t.c_m), ca = side(t.c_m, t.a_m);
  return ab >= 0 && bc >= 0 && ca >= 0;
}

}  // namespace

double squared_distance(const Vec3& p, const Triangle& t) {
  const Vec3 normal = (t.b_m - t.a_m).cross(t.c_m - t.a_m);
  const double normal2 = normal.squaredNorm();
  if (normal2 > 0 && projects_into(p, t, normal)) {
    const double height = normal.dot(p - t.a_m);
    return height * height / normal2;
  }
  return std::min({squared_distance(p, t.a_m, t.b_m), squared_distance(p, t.b_m, t.c_m),
                   squared_distance(p, t.c_m, t.a_m)});
}

double squared_distance(const Vec3& a_from, const Vec3& a_to, const Vec3& b_from, const Vec3& b_to) {
  const Vec3 u = a_to - a_from, v = b_to - b_from, w = a_from - b_from;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  // Either both nearest points are interior to their segments, or at least one of them is a segment's end.
  double nearest = std::min({squared_distance(a_from, b_from, b_to), squared_distance(a_to, b_from, b_to),
                             squared_distance(b_from, a_from, a_to), squared_distance(b_to, a_from, a_to)});
  if (determinant > 0) {
    const double s = (uv * vw - vv * uw) / determinant, t = (uu * vw - uv * uw) / determinant;
    if (s > 0 && s < 1 && t > 0 && t < 1) nearest = std::min(nearest, (w + s * u - t * v).squaredNorm());
  }
  return nearest;
}

double squared_distance(const Vec3& from, const Vec3& to, const Triangle& t) {
  const Vec3 normal = (t.b_m - t.a_m).cross(t.c_m - t.a_m);
  const double above_from = normal.dot(from - t.a_m), above_to = normal.dot(to - t.a_m);
  if ((above_from < 0) != (above_to < 0)) {
    const double part = above_from / (above_from - above_to);
    if (projects_into(from + part * (to - from), t, normal)) return 0;
  }
  return std::min({squared_distance(from, t), squared_distance(to, t),
                   squared_distance(from, to, t.a_m, t.b_m), squared_distance(from, to, t.b_m, t.c_m),
                   squared_distance(from, to, t.c_m, t.a_m)});
}

}  // namespace sidestep
