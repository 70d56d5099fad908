// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/common/collision/fcl/solid_world.hpp"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/sphere.h>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::solid_world_test {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d at(double x, double y, double z) { return Isometry3d(Eigen::Translation3d(x, y, z)); }

/// A triangle mesh of a wall in the plane x = 0, with a 2 m by 2 m window around the origin.
Solid wall_with_window() {
  std::vector<Vector3d> corners;
  for (const double half : {1.0, 10.0})
    for (const auto& [y, z] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      corners.emplace_back(0, half * y, half * z);
  std::vector<std::array<std::size_t, 3>> triangles;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t next = (i + 1) % 4;
    triangles.push_back({i, next, 4 + i});
    triangles.push_back({next, 4 + next, 4 + i});
  }
  return mesh(corners, triangles);
}

TEST_CASE("a body passes through the window of a mesh but not through its wall") {
  SolidWorld world;
  world.add(wall_with_window(), Isometry3d::Identity());
  const Solid body = std::make_shared<fcl::Boxd>(0.4, 1.0, 1.0);
  CHECK(world.clearance_m(body, at(0, 0, 0)) == Approx(0.5).margin(1e-5));
  CHECK(world.clearance_m(body, at(-5, 0, 0)) > 4.7);
  CHECK_FALSE(world.sweep(body, at(-5, 0, 0), {5, 0, 0}).touches());
  CHECK_FALSE(world.sweep(body, at(-5, 0.3, 0.3), {5, -0.3, 0}).touches());
  CHECK(world.sweep(body, at(-5, 0, 0), {5, 3, 0}).touches());
  CHECK(world.sweep(body, at(-5, 0, 0), {5, 0, 0}, 0.51).touches());
  const auto into_wall = world.sweep(body, at(-5, 4, 0), {5, 4, 0});
  CHECK(into_wall.touches());
  CHECK(into_wall.free_path_m() == Approx(4.8).margin(1e-4));
}

TEST_CASE("sweeping a body finds contact anywhere along its path") {
  const std::uint64_t seed = GENERATE(range(1, 6));
  CAPTURE(seed);
  Rng rng(seed);
  SolidWorld world;
  const auto random_position = [&](double half) {
    const double z = rng.uniform(-half, half), y = rng.uniform(-half, half), x = rng.uniform(-half, half);
    Isometry3d pose = at(x, y, z);
    const double axis_y = rng.uniform(), axis_x = rng.uniform(), angle_rad = rng.uniform(0, 3);
    pose.rotate(Eigen::AngleAxisd(angle_rad, Vector3d(axis_x, axis_y, 1).normalized()));
    return pose;
  };
  for (int i = 0; i < 15; ++i) {
    const Isometry3d pose = random_position(1.5);
    const double width = rng.uniform(0.1, 0.6), length = rng.uniform(0.1, 0.6);
    world.add(std::make_shared<fcl::Boxd>(length, width, 0.3), pose);
  }
  const Solid body = std::make_shared<fcl::Boxd>(0.3, 0.2, 0.1);
  for (int i = 0; i < 20; ++i) {
    const Isometry3d from = random_position(1.5);
    const Vector3d to = random_position(1.5).translation();
    double sampled = 1e9;
    for (int k = 0; k <= 200; ++k) {
      Isometry3d pose = from;
      pose.translation() += k / 200.0 * (to - from.translation());
      sampled = std::min(sampled, world.clearance_m(body, pose));
    }
    const bool touches = world.sweep(body, from, to).touches();
    if (sampled == 0) CHECK(touches);
    if (sampled > (to - from.translation()).norm() / 400 + 1e-5) CHECK_FALSE(touches);
  }
}

TEST_CASE("solids are moved and removed by id") {
  SolidWorld world;
  const Solid ball = std::make_shared<fcl::Sphered>(1);
  CHECK(world.clearance_m(ball, at(0, 0, 0)) == std::numeric_limits<double>::infinity());
  const SolidWorld::Id one = world.add(ball, at(5, 0, 0)), other = world.add(ball, at(0, 9, 0));
  CHECK(world.clearance_m(ball, at(0, 0, 0)) == Approx(3));
  world.move(one, at(0, 0, 4));
  CHECK(world.clearance_m(ball, at(0, 0, 0)) == Approx(2));
  CHECK(world.clearance_m(ball, at(0, 0, 3)) == 0);
  world.remove(one);
  CHECK(world.clearance_m(ball, at(0, 0, 0)) == Approx(7));
  CHECK_THROWS_WITH(world.move(one, at(0, 0, 0)), "there is no solid 0");
  CHECK_THROWS_AS(world.remove(one), std::invalid_argument);
  world.remove(other);
}

TEST_CASE("invalid solids are rejected") {
  const std::vector<Vector3d> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  using Triangles = std::vector<std::array<std::size_t, 3>>;
  CHECK_NOTHROW(mesh(corners, Triangles{{0, 1, 2}}));
  CHECK_THROWS_WITH(mesh(corners, Triangles{}), "a mesh has no triangles");
  CHECK_THROWS_WITH(mesh(corners, Triangles{{0, 1, 3}}),
                    "a mesh triangle refers to a corner that does not exist");
  const std::vector<Vector3d> broken{{0, 0, 0}, {1, 0, 0}, {0, std::nan(""), 0}};
  CHECK_THROWS_AS(mesh(broken, Triangles{{0, 1, 2}}), std::invalid_argument);
  CHECK_THROWS_AS(prism(Circle{{0, 0}, -1}, 1), std::invalid_argument);
  CHECK_THROWS_AS(prism(Circle{{0, 0}, 1}, 0), std::invalid_argument);
}

}  // namespace sidestep::solid_world_test
