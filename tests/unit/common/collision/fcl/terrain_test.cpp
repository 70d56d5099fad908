// SPDX-License-Identifier: Apache-2.0
#include <fcl/geometry/shape/capsule.h>

#include "tests/catch.hpp"
#include "tests/unit/common/collision/fcl/solid_world.hpp"
#include "tests/unit/common/collision/random_terrain.hpp"

namespace sidestep::terrain_test {

TEST_CASE("distances to terrain agree with FCL's distances to the same mesh") {
  const std::uint64_t seed = GENERATE(range(1, 4));
  CAPTURE(seed);
  Rng rng(seed);
  std::vector<Vec3> points;
  std::vector<TerrainTree::Corners> triangles;
  std::vector<std::array<std::size_t, 3>> faces;
  const HeightField field = random_terrain(rng, 9, 7);
  for (std::uint32_t i = 0; i < field.heights_m.size(); ++i) {
    points.emplace_back(i % field.columns, i / field.columns, field.heights_m[i]);
    if (i % field.columns + 1 == field.columns || i / field.columns + 1 == field.rows) continue;
    const auto columns = static_cast<std::uint32_t>(field.columns);
    triangles.push_back({i, i + 1, i + columns});
    triangles.push_back({i + 1, i + columns + 1, i + columns});
  }
  for (const auto& [a, b, c] : triangles) faces.push_back({a, b, c});
  const TerrainTree tree(points, triangles);
  SolidWorld world;
  world.add(mesh(points, faces), Eigen::Isometry3d::Identity());
  for (int i = 0; i < 100; ++i) {
    const double z = rng.uniform(2, 8), y = rng.uniform(-1, 7), x = rng.uniform(-1, 9);
    const double dz = rng.uniform(-2, 2), dy = rng.uniform(-3, 3), dx = rng.uniform(-3, 3);
    const Vec3 from(x, y, z), displacement(dx, dy, dz);
    Eigen::Isometry3d pose(Eigen::Translation3d(from + 0.5 * displacement));
    pose.rotate(Eigen::Quaterniond::FromTwoVectors(Vec3(0, 0, 1), displacement));
    const double radius = 0.05;
    const double in_fcl =
        world.clearance_m(std::make_shared<fcl::Capsuled>(radius, displacement.norm()), pose);
    CAPTURE(from.transpose(), displacement.transpose());
    CHECK(std::max(0.0, tree.distance_m(from, from + displacement) - radius) == Approx(in_fcl).margin(2e-6));
  }
}

}  // namespace sidestep::terrain_test
