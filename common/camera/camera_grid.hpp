// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/camera/overhead_camera.hpp"
#include "common/config/scenario.hpp"

namespace sidestep {

/// The cameras over a scenario's field, row by row from its corner of lowest x and y, along x first: each
/// hangs over its share, and sees it and the overlap. Height, distortion and image size are those of `like`.
/// Throws std::invalid_argument as hang() does.
std::vector<CameraModel> hang_grid(const Field& field, const VisionSpec& spec, const OverheadCamera& like);
/// The same with what the scenario says of images.
std::vector<CameraModel> hang_grid(const Scenario& scenario);

/// A camera's size, height and distortion.
OverheadCamera hanging(const ImageSpec& images);

}  // namespace sidestep
