// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/camera/camera_model.hpp"
#include "common/geometry/field.hpp"
#include "common/league/field_geometry.hpp"
#include "simulator/cameras.hpp"

namespace sidestep {

/// The field with its FieldMarking. The floor ends at its lines.
league::FieldSize league_field(const Field& field);

/// The camera that would see this part of the floor, up to the robots' tops: 780 x 580 pixels, without
/// distortion, hanging 4 m over its middle.
CameraModel league_camera(const CameraView& view);

/// What the league is told of it.
league::CameraCalibration calibration_of(const CameraModel& camera, std::uint32_t number);

}  // namespace sidestep
