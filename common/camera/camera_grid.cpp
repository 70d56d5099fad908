// SPDX-License-Identifier: Apache-2.0
#include "common/camera/camera_grid.hpp"

namespace sidestep {

std::vector<CameraModel> camera_grid(const Field& field, const VisionSpec& spec,
                                     const OverheadCamera& prototype) {
  const Vec2 corner(-field.length_m / 2, -field.width_m / 2);
  const Vec2 cell(field.length_m / spec.columns, field.width_m / spec.rows);
  std::vector<CameraModel> cameras;
  for (int index = 0; index < spec.columns * spec.rows; ++index) {
    const Vec2 low = corner + cell.cwiseProduct(Vec2(index % spec.columns, index / spec.columns));
    OverheadCamera camera = prototype;
    camera.view_m = inflated(Box{low, low + cell}, spec.overlap_m);
    cameras.push_back(overhead_camera_model(camera));
  }
  return cameras;
}

std::vector<CameraModel> camera_grid(const Scenario& scenario) {
  return camera_grid(scenario.field, scenario.vision,
                     overhead_camera_of(scenario.vision.images.value_or(ImageSpec())));
}

OverheadCamera overhead_camera_of(const ImageSpec& images) {
  OverheadCamera camera;
  camera.height_m = images.camera_height_m;
  camera.width_px = images.width_px;
  camera.height_px = images.height_px;
  camera.distortion = images.distortion;
  return camera;
}

}  // namespace sidestep
