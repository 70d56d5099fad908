// SPDX-License-Identifier: Apache-2.0
#include "simulator/league/league_geometry.hpp"

#include <numbers>

#include "common/camera/overhead_camera.hpp"
#include "common/geometry/field_marking.hpp"
#include "common/motion/rolling_ball.hpp"

namespace sidestep {
namespace {

// Shape types of the league; the straight lines follow from kFirstLine on, in FieldMarking's order.
constexpr std::uint32_t kCentreCircle = 1, kFirstLine = 2;

void add_markings(league::FieldSize& field, const FieldMarking& marking) {
  std::uint32_t type = kFirstLine;
  for (const MarkedLine& line : marking.lines)
    field.lines.push_back({line.name, line.segment_m.from_m, line.segment_m.to_m, marking.line_m, type++});
  field.arcs.push_back({"CenterCircle",
                        {0, 0},
                        marking.centre_circle_radius_m,
                        0,
                        2 * std::numbers::pi,
                        marking.line_m,
                        kCentreCircle});
}

}  // namespace

league::FieldSize league_field(const Field& field) {
  const FieldMarking marking(field);
  league::FieldSize size;
  size.length_m = field.length_m;
  size.width_m = field.width_m;
  size.goal_width_m = marking.goal_width_m;
  size.goal_depth_m = marking.goal_depth_m;
  size.goal_height_m = marking.goal_height_m;
  size.boundary_width_m = 0;
  size.penalty_area_depth_m = marking.area_depth_m;
  size.penalty_area_width_m = marking.area_width_m;
  size.centre_circle_radius_m = marking.centre_circle_radius_m;
  size.line_thickness_m = marking.line_m;
  size.goal_centre_to_penalty_mark_m = marking.penalty_mark_m;
  size.ball_radius_m = RollingBall::kRadius_m;
  size.max_robot_radius_m = 0.09;
  add_markings(size, marking);
  return size;
}

CameraModel league_camera(const CameraView& view) {
  OverheadCamera camera;
  camera.view_m = {view.low_m, view.high_m};
  camera.distortion = 0;
  return overhead_camera_model(camera);
}

league::CameraCalibration calibration_of(const CameraModel& camera, std::uint32_t number) {
  const CameraParameters& parameters = camera.parameters();
  league::CameraCalibration calibration;
  calibration.camera = number;
  calibration.focal_length_px = parameters.focal_length_px;
  calibration.principal_point_px = parameters.principal_point_px;
  calibration.distortion = parameters.distortion;
  const Eigen::Vector4d& rotation = parameters.rotation.coeffs();
  calibration.rotation = {rotation.x(), rotation.y(), rotation.z(), rotation.w()};
  calibration.translation_m = parameters.translation_m;
  calibration.position_m = camera.position_m();
  calibration.image_width_px = static_cast<std::uint32_t>(parameters.width_px);
  calibration.image_height_px = static_cast<std::uint32_t>(parameters.height_px);
  return calibration;
}

}  // namespace sidestep
