// SPDX-License-Identifier: Apache-2.0
#include "common/camera/camera_grid.hpp"

namespace sidestep {

std::vector<CameraModel> hang_grid(const Field& field, const VisionSpec& spec, const HangingCamera& like) {
  const Vec2 corner(-field.length_m / 2, -field.width_m / 2);
  const Vec2 share(field.length_m / spec.columns, field.width_m / spec.rows);
  std::vector<CameraModel> cameras;
  for (int camera = 0; camera < spec.columns * spec.rows; ++camera) {
    const Vec2 low = corner + share.cwiseProduct(Vec2(camera % spec.columns, camera / spec.columns));
    HangingCamera hanging = like;
    hanging.view_m = grown(Box{low, low + share}, spec.overlap_m);
    cameras.push_back(hang(hanging));
  }
  return cameras;
}

}  // namespace sidestep
