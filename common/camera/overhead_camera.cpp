// SPDX-License-Identifier: Apache-2.0
#include "common/camera/overhead_camera.hpp"

#include <algorithm>
#include <stdexcept>

namespace sidestep {
namespace {

constexpr int kPointsPerSide = 64;

/// The rotation from world to camera; its rows are the camera's axes in world coordinates.
Eigen::Matrix3d axes_of(const OverheadCamera& camera, const Vec3& position_m, const Vec2& centre_m) {
  const Vec2 size_m = camera.view_m.max_m - camera.view_m.min_m;
  const bool is_landscape = camera.width_px >= camera.height_px;
  const bool is_wide = size_m.x() >= size_m.y();
  const Vec3 right = is_landscape == is_wide ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitY());
  const Vec3 ahead = (Vec3(centre_m.x(), centre_m.y(), 0) - position_m).normalized();
  const Vec3 down = ahead.cross(right).normalized();
  Eigen::Matrix3d axes;
  axes << down.cross(ahead).transpose(), down.transpose(), ahead.transpose();
  return axes;
}

/// The maximum focal length that keeps a point in the image. Precondition: the focal length of the model
/// is 1.
double max_focal_length(const CameraModel& model, const Vec3& point_m) {
  const std::optional<Vec2> pixel = model.pixel_of(point_m);
  if (!pixel)
    throw std::invalid_argument(
        "overhead camera: the view rectangle exceeds the domain of the lens distortion");
  const CameraParameters& p = model.parameters();
  const Vec2 offset = (*pixel - p.principal_point_px).cwiseAbs();
  return std::min(p.width_px / 2.0 / offset.x(), p.height_px / 2.0 / offset.y());
}

}  // namespace

CameraModel overhead_camera_model(const OverheadCamera& camera) {
  const Vec2 size_m = camera.view_m.max_m - camera.view_m.min_m;
  if (!(size_m.minCoeff() > 0)) throw std::invalid_argument("overhead camera: the view rectangle is empty");
  if (!(camera.height_m > camera.object_height_m))
    throw std::invalid_argument("overhead camera: the camera is not above the objects in view");
  const Vec2 centre_m = (camera.view_m.min_m + camera.view_m.max_m) / 2;
  const Vec2 mount_m = centre_m + camera.lateral_offset_m;
  const Vec3 position_m(mount_m.x(), mount_m.y(), camera.height_m);

  CameraParameters result;
  result.width_px = camera.width_px;
  result.height_px = camera.height_px;
  result.principal_point_px = Vec2(camera.width_px - 1, camera.height_px - 1) / 2;
  result.distortion = camera.distortion;
  const Eigen::Matrix3d axes = axes_of(camera, position_m, centre_m);
  result.rotation = Eigen::Quaterniond(axes);
  result.translation_m = -(axes * position_m);
  result.focal_length_px = 1;

  const CameraModel model(result);
  double focal_length_px = 1e6;
  const auto corners = corners_of(camera.view_m);
  for (std::size_t side = 0; side < corners.size(); ++side) {
    const Vec2& from = corners[side];
    const Vec2& to = corners[(side + 1) % corners.size()];
    for (int i = 0; i < kPointsPerSide; ++i) {
      const Vec2 p = from + (to - from) * i / kPointsPerSide;
      for (const double z : {0.0, camera.object_height_m})
        focal_length_px = std::min(focal_length_px, max_focal_length(model, Vec3(p.x(), p.y(), z)));
    }
  }
  result.focal_length_px = focal_length_px;
  return CameraModel(result);
}

}  // namespace sidestep
