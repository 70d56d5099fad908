// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/audit_shape.hpp"

#include <algorithm>
#include <cmath>

#include "common/messaging/version_codec.hpp"
#include "common/motion/clearance.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::audit_shape_test {

/// A counter-clockwise polygon with three to six corners.
ConvexPolygon random_polygon(Rng& rng) {
  const auto corners = static_cast<int>(3 + rng.below(4));
  const Vec2 centre = random_vector(rng, 1);
  const double radius_m = rng.uniform(0.1, 0.6), turned_rad = rng.uniform(0, 6);
  ConvexPolygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle_rad = turned_rad + (i + rng.uniform(0, 0.4)) * 2 * std::numbers::pi / corners;
    polygon.corners_m.push_back(centre + rotated({radius_m, 0}, angle_rad));
  }
  return polygon;
}

/// One shape of each kind, and a segment of zero length.
std::vector<Shape> random_shapes(Rng& rng) {
  const Vec2 corner = random_vector(rng, 1), point = random_vector(rng, 1);
  return {Circle{random_vector(rng, 1), rng.uniform(0.05, 0.5)},
          Box{corner, corner + Vec2(rng.uniform(0.05, 1), rng.uniform(0.05, 1))}, random_polygon(rng),
          Segment{random_vector(rng, 1), random_vector(rng, 1)}, Segment{point, point}};
}

double distance_from_edge_m(const Vec2& p, const Shape& shape) {
  return std::max(0.0, signed_distance(p, shape));
}

TEST_CASE("the distance of a point from a shape agrees with the system's own") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    for (const Shape& shape : random_shapes(rng)) {
      CAPTURE(shape.index());
      const AuditShape audited(shape);
      for (int i = 0; i < 50; ++i) {
        const Vec2 p = random_vector(rng, 2);
        CHECK(audited.distance_m(p.x(), p.y()) == Approx(distance_from_edge_m(p, shape)).margin(1e-12));
      }
    }
  }
}

TEST_CASE("the closest approach to a shape is found to micrometres below the cutoff, with its time") {
  int near = 0, inside = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Version version{0, 1, 2, 0, random_trajectory(rng), 0};
    const AuditPath path(encode(version));
    for (const Shape& shape : random_shapes(rng)) {
      CAPTURE(shape.index());
      const double cutoff_m = rng.uniform(0.01, 0.3);
      const double expected_m = std::max(0.0, clearance_m(version.trajectory, shape, 0));
      const ClosestApproach found = closest_approach(path, AuditShape(shape), cutoff_m);
      const Vec2 there_m = version.trajectory.state_at(time_from_ns(found.at_ns)).position_m;
      CHECK(distance_from_edge_m(there_m, shape) == Approx(found.distance_m).margin(1e-7));
      if (expected_m < cutoff_m) {
        ++near;
        inside += expected_m == 0;
        CHECK(found.distance_m == Approx(expected_m).margin(1e-6));
      } else {
        CHECK(found.distance_m >= cutoff_m - 1e-9);
      }
    }
  }
  CHECK(near > 60);
  CHECK(inside > 20);
}

}  // namespace sidestep::audit_shape_test
