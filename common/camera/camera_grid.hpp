// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/camera/overhead_camera.hpp"
#include "common/config/scenario.hpp"

namespace sidestep {

/// The overhead cameras of a field, row by row from the corner with the lowest x and y; x varies fastest.
/// Each camera is mounted above its cell of the grid and sees the cell and the overlap around it. Height,
/// distortion and image size come from `prototype`. Throws std::invalid_argument if overhead_camera_model()
/// does.
std::vector<CameraModel> camera_grid(const Field& field, const VisionSpec& spec,
                                     const OverheadCamera& prototype);
/// The camera grid of a scenario, with the scenario's image settings.
std::vector<CameraModel> camera_grid(const Scenario& scenario);

/// An overhead camera with the image size, height and distortion of a scenario's images.
OverheadCamera overhead_camera_of(const ImageSpec& images);

}  // namespace sidestep
