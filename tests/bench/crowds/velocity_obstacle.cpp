// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/velocity_obstacle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/convex_polygon.hpp"

namespace sidestep {
namespace {

/// Collects points of the boundary of a velocity obstacle, and keeps the one nearest to a velocity.
class NearestBoundary {
 public:
  explicit NearestBoundary(const Vec2& velocity) : velocity_(velocity) {}

  void add(const HalfPlane& outside) {
    const double distance2 = (outside.point - velocity_).squaredNorm();
    if (distance2 >= distance2_) return;
    distance2_ = distance2;
    nearest_ = outside;
  }
  const HalfPlane& nearest() const { return nearest_; }

 private:
  Vec2 velocity_;
  HalfPlane nearest_;
  double distance2_ = std::numeric_limits<double>::infinity();
};

/// Adds the part of the boundary around a corner: an arc at which the robot is just at the separation when
/// the horizon ends.
void add_arc(const RelativeObstacle& obstacle, const Vec2& corner, double horizon, const Vec2& velocity,
             NearestBoundary& boundary) {
  const Vec2 from_corner = horizon * velocity - corner;
  const double distance = from_corner.norm();
  if (distance == 0) return;
  const Vec2 normal = from_corner / distance;
  const Vec2 point = corner + obstacle.separation_m * normal;
  if (point.dot(normal) >= 0) return;  // on the far side
  for (const Vec2& other : obstacle.corners_m)
    if ((other - corner).dot(normal) > 0) return;  // nearer to an edge or to the other corner
  boundary.add({point / horizon, normal});
}

/// Adds the straight part of the boundary in front of an edge.
void add_edge(const RelativeObstacle& obstacle, const Segment& edge, double horizon, const Vec2& velocity,
              NearestBoundary& boundary) {
  const Vec2 along = edge.to_m - edge.from_m;
  const double length = along.norm();
  if (length == 0) return;
  const Vec2 direction = along / length, normal = -left_of(direction);
  const Vec2 corner = edge.from_m + obstacle.separation_m * normal;
  if (corner.dot(normal) >= 0) return;  // on the far side
  const double place = (horizon * velocity - corner).dot(direction);
  if (place < 0 || place > length) return;
  boundary.add({(corner + place * direction) / horizon, normal});
}

/// Adds the rays on both sides: velocities at which the robot passes the obstacle at the separation.
void add_sides(const RelativeObstacle& obstacle, double horizon, const Vec2& velocity,
               NearestBoundary& boundary) {
  for (const double side : {1.0, -1.0}) {
    Vec2 ray(0, 0);
    double begin = 0;  // distance to the point where the ray touches the obstacle
    for (const Vec2& corner : obstacle.corners_m) {
      const double distance2 = corner.squaredNorm(), r = obstacle.separation_m;
      const double touch = std::sqrt(std::max(0.0, distance2 - r * r));
      const Vec2 tangent = (touch * corner + side * r * left_of(corner)) / distance2;
      const double turn = side * cross(ray, tangent);
      if (begin > 0 && (turn < 0 || (turn == 0 && touch >= begin))) continue;
      ray = tangent;
      begin = touch;
    }
    const double place = velocity.dot(ray);
    if (place * horizon >= begin) boundary.add({place * ray, side * left_of(ray)});
  }
}

}  // namespace

Vec2 nearest_point_m(const RelativeObstacle& obstacle) {
  const std::span<const Vec2> corners = obstacle.corners_m;
  const Vec2 centre(0, 0);
  if (corners.size() > 2 && signed_distance(centre, corners) <= 0) return centre;
  return nearest_edge_point(centre, corners);
}

HalfPlane outside_velocity_obstacle(const RelativeObstacle& obstacle, double horizon_s,
                                    const Vec2& velocity_mps) {
  NearestBoundary boundary(velocity_mps);
  // The boundary's point nearest to rest is on the boundary whatever the velocity is.
  const Vec2 nearest = nearest_point_m(obstacle);
  const double distance = nearest.norm();
  const Vec2 away = -nearest / distance;
  boundary.add({away * ((obstacle.separation_m - distance) / horizon_s), away});
  const std::span<const Vec2> corners = obstacle.corners_m;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    add_arc(obstacle, corners[i], horizon_s, velocity_mps, boundary);
    if (corners.size() > 1)
      add_edge(obstacle, {corners[i], corners[(i + 1) % corners.size()]}, horizon_s, velocity_mps, boundary);
  }
  add_sides(obstacle, horizon_s, velocity_mps, boundary);
  return boundary.nearest();
}

HalfPlane separating_velocities(const Vec2& offset_m, double separation_m, double within_s,
                                const Vec2& velocity_mps) {
  const Vec2 displacement = within_s * velocity_mps - offset_m;
  const double distance = displacement.norm();
  const Vec2 normal = distance > 0 ? Vec2(displacement / distance) : Vec2(1, 0);
  return {(offset_m + separation_m * normal) / within_s, normal};
}

}  // namespace sidestep
