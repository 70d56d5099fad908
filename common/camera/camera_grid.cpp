// SPDX-License-Identifier: Apache-2.0
#include "common/camera/camera_grid.hpp"

namespace sidestep {

std::vector<CameraModel> hang_grid(const Field& field, const VisionSpec& spec, const OverheadCamera& like) {
  const Vec2 corner(-field.length_m / 2, -field.width_m / 2);
  const Vec2 share(field.length_m / spec.columns, field.width_m / spec.rows);
  std::vector<CameraModel> cameras;
  for (int camera = 0; camera < spec.columns * spec.rows; ++camera) {
    const Vec2 low = corner + share.cwiseProduct(Vec2(camera % spec.columns, camera / spec.columns));
    OverheadCamera over = like;
    over.view_m = grown(Box{low, low + share}, spec.overlap_m);
    cameras.push_back(hang(over));
  }
  return cameras;
}

std::vector<CameraModel> hang_grid(const Scenario& scenario) {
  return hang_grid(scenario.field, scenario.vision, hanging(scenario.vision.images.value_or(ImageSpec())));
}

OverheadCamera hanging(const ImageSpec& images) {
  OverheadCamera camera;
  camera.height_m = images.camera_height_m;
  camera.width_px = images.width_px;
  camera.height_px = images.height_px;
  camera.distortion = images.distortion;
  return camera;
}

}  // namespace sidestep
