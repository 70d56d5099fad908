// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/geometry/vec3.hpp"

namespace sidestep::league {

struct LineMarking {
  std::string name;
  Vec2 from_m{0, 0};
  Vec2 to_m{0, 0};
  double thickness_m = 0;
  std::optional<std::uint32_t> type{};  ///< the league's number: 1 centre circle, 2 top touch line, ...
};

struct ArcMarking {
  std::string name;
  Vec2 centre_m{0, 0};
  double radius_m = 0;
  double from_rad = 0;  ///< start angle
  double to_rad = 0;    ///< end angle, counter-clockwise
  double thickness_m = 0;
  std::optional<std::uint32_t> type{};
};

/// SSL_GeometryFieldSize: whole millimetres on the wire.
struct FieldSize {
  double length_m = 0;  ///< between the goal lines
  double width_m = 0;   ///< between the touch lines
  double goal_width_m = 0;
  double goal_depth_m = 0;
  double boundary_width_m = 0;
  std::vector<LineMarking> lines;
  std::vector<ArcMarking> arcs;
  std::optional<double> penalty_area_depth_m;
  std::optional<double> penalty_area_width_m;
  std::optional<double> centre_circle_radius_m;
  std::optional<double> line_thickness_m;
  std::optional<double> goal_centre_to_penalty_mark_m;
  std::optional<double> goal_height_m;
  std::optional<double> ball_radius_m;
  std::optional<double> max_robot_radius_m;
};

/// SSL_GeometryCameraCalibration: a world point p has the camera coordinates R p + t with z along the optical
/// axis, and is projected to x / z and y / z, which are then radially distorted and scaled by the focal
/// length, relative to the principal point.
struct CameraCalibration {
  std::uint32_t camera = 0;
  double focal_length_px = 0;
  Vec2 principal_point_px{0, 0};
  double distortion = 0;
  std::array<double, 4> rotation{};  ///< the rotation R as a unit quaternion: x, y, z, w
  Vec3 translation_m{0, 0, 0};       ///< the translation t
  std::optional<Vec3> position_m;    ///< position of the camera: -R^T t
  std::optional<std::uint32_t> image_width_px;
  std::optional<std::uint32_t> image_height_px;
};

/// SSL_GeometryData without the optional ball models.
struct Geometry {
  FieldSize field;
  std::vector<CameraCalibration> cameras;
};

}  // namespace sidestep::league
