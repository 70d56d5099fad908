// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/camera/camera_model.hpp"
#include "common/geometry/field.hpp"
#include "common/league/field_geometry.hpp"
#include "simulator/world/cameras.hpp"

namespace sidestep {

/// A field with its FieldMarking, in the league's format. The floor ends at the outer lines.
league::FieldSize league_field(const Field& field);

/// A camera with this view of the floor, up to the height of the robots' tops: 780 x 580 pixels, no
/// distortion, 4 m above the centre of the view.
CameraModel league_camera(const CameraView& view);

/// A camera's calibration in the form in which the league sends it.
league::CameraCalibration calibration_of(const CameraModel& camera, std::uint32_t number);

}  // namespace sidestep
