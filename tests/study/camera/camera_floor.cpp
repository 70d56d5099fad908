// SPDX-License-Identifier: Apache-2.0
#include "tests/study/camera/camera_floor.hpp"

#include <algorithm>

#include "common/camera/overhead_camera.hpp"

namespace sidestep {
namespace {

// Distance of free positions and obstacles' centres from the field's border.
constexpr double kBorder_m = 0.3;
constexpr double kFreeAtEnds_m = 0.35;  // clearance of start and target

Vec2 sample_place(double border_m, Rng& rng) {
  const double x =
      rng.uniform(border_m - 0.5 * kGuidedField.length_m, 0.5 * kGuidedField.length_m - border_m);
  const double y = rng.uniform(border_m - 0.5 * kGuidedField.width_m, 0.5 * kGuidedField.width_m - border_m);
  return {x, y};
}

ConvexPolygon sample_block(const Vec2& centre_m, Rng& rng) {
  const double turn = rng.uniform(-3, 3), length_m = rng.uniform(0.2, 0.5), width_m = rng.uniform(0.06, 0.2);
  ConvexPolygon block;
  for (const Vec2& corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)})
    block.corners_m.push_back(centre_m + rotated(corner.cwiseProduct(Vec2(length_m, width_m)), turn));
  return block;
}

}  // namespace

double CameraFloor::clearance_m(const Vec2& p) const {
  double nearest_m = 1e9;
  for (const SceneCylinder& cylinder : cylinders)
    nearest_m = std::min(nearest_m, (p - cylinder.circle.centre_m).norm() - cylinder.circle.radius_m);
  for (const Shape& shape : statics.shapes) nearest_m = std::min(nearest_m, signed_distance(p, shape));
  return nearest_m;
}

Vec2 sample_free_place(const CameraFloor& floor, double clearance_m, Rng& rng) {
  while (true) {
    const Vec2 place_m = sample_place(kBorder_m, rng);
    if (floor.clearance_m(place_m) > clearance_m) return place_m;
  }
}

CameraFloor sample_camera_floor(Rng& rng) {
  CameraFloor floor;
  floor.statics.colour = SceneCylinder{}.colour;
  const auto count = 4 + rng.below(6);
  for (std::uint64_t i = 0; i < count; ++i) {
    const Vec2 centre_m = sample_place(kBorder_m, rng);
    if (rng.chance(0.6)) {
      SceneCylinder cylinder;
      cylinder.circle = {centre_m, rng.uniform(0.08, 0.3)};
      floor.cylinders.push_back(cylinder);
    } else {
      floor.statics.shapes.emplace_back(sample_block(centre_m, rng));
    }
  }
  do {
    floor.start_m = sample_free_place(floor, kFreeAtEnds_m, rng);
    floor.target_m = sample_free_place(floor, kFreeAtEnds_m, rng);
  } while ((floor.start_m - floor.target_m).norm() < 2);
  return floor;
}

CameraModel guiding_camera() {
  OverheadCamera overhead;
  overhead.width_px = 800;
  overhead.height_px = 600;
  return overhead_camera_model(overhead);
}

CameraModel bumped(const CameraModel& camera, double angle_rad, Rng& rng) {
  const double x = rng.normal(), y = rng.normal(), z = rng.normal();
  const Eigen::AngleAxisd turn(angle_rad, Vec3(x, y, z).normalized());
  CameraParameters parameters = camera.parameters();
  parameters.rotation = Eigen::Quaterniond(turn) * parameters.rotation;
  parameters.translation_m = turn * parameters.translation_m;
  return CameraModel(parameters);
}

}  // namespace sidestep
