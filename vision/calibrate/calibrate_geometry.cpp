// SPDX-License-Identifier: Apache-2.0
#include "vision/calibrate/calibrate_geometry.hpp"

#include <fmt/format.h>

namespace sidestep {

std::vector<CalibratedCamera> calibrate_geometry(const std::vector<CameraPoints>& cameras) {
  std::vector<CalibratedCamera> calibrated;
  for (const CameraPoints& camera : cameras) {
    CalibrationResult result = calibrate_camera(camera.points, camera.initial, camera.settings);
    if (!result.error.empty()) camera.location.fail(result.error);
    calibrated.push_back({{camera.id, result.camera},
                          camera.points.size(),
                          result,
                          camera.point_locations[result.worst_index]});
  }
  return calibrated;
}

std::string describe(const CalibratedCamera& camera) {
  const CalibrationResult& result = camera.result;
  return fmt::format(
      "camera {}: {} points, residual {:.2f} px RMS ({:.1f} mm), largest {:.2f} px at {}:{}, predicted error "
      "{:.2f} px at the height of robots",
      camera.camera.id, camera.point_count, result.rms_px, 1e3 * result.rms_m, result.max_px,
      camera.worst_point.file, camera.worst_point.line, result.robot_top_sd_px);
}

}  // namespace sidestep
