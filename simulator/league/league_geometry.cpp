// SPDX-License-Identifier: Apache-2.0
#include "simulator/league/league_geometry.hpp"

#include <algorithm>
#include <numbers>

#include "common/camera/hanging_camera.hpp"

namespace sidestep {
namespace {

struct Division {
  double goal_width_m, goal_depth_m, area_width_m, area_depth_m, penalty_mark_m;
};
constexpr Division kDivisionA{1.8, 0.18, 3.6, 1.8, 8};
constexpr Division kDivisionB{1, 0.18, 2, 1, 6};
constexpr double kShortestA_m = 10.5;
constexpr double kCentreCircle_m = 0.5, kLine_m = 0.01;

enum ShapeType : std::uint32_t {
  kCentreCircle = 1,
  kTopTouchLine,
  kBottomTouchLine,
  kLeftGoalLine,
  kRightGoalLine,
  kHalfwayLine,
  kCentreLine,
  kLeftPenaltyStretch,
  kRightPenaltyStretch,
  kLeftFieldLeftPenaltyStretch,
  kLeftFieldRightPenaltyStretch,
  kRightFieldLeftPenaltyStretch,
  kRightFieldRightPenaltyStretch
};

void mark(league::FieldSize& field) {
  const double x = field.length_m / 2, y = field.width_m / 2;
  const double area_x = x - *field.penalty_area_depth_m, area_y = *field.penalty_area_width_m / 2;
  const auto line = [&](const char* name, const Vec2& from_m, const Vec2& to_m, ShapeType type) {
    field.lines.push_back({name, from_m, to_m, kLine_m, type});
  };
  line("TopTouchLine", {-x, y}, {x, y}, kTopTouchLine);
  line("BottomTouchLine", {-x, -y}, {x, -y}, kBottomTouchLine);
  line("LeftGoalLine", {-x, -y}, {-x, y}, kLeftGoalLine);
  line("RightGoalLine", {x, -y}, {x, y}, kRightGoalLine);
  line("HalfwayLine", {0, -y}, {0, y}, kHalfwayLine);
  line("CenterLine", {-x, 0}, {x, 0}, kCentreLine);
  line("LeftPenaltyStretch", {-area_x, -area_y}, {-area_x, area_y}, kLeftPenaltyStretch);
  line("RightPenaltyStretch", {area_x, -area_y}, {area_x, area_y}, kRightPenaltyStretch);
  line("LeftFieldLeftPenaltyStretch", {-x, -area_y}, {-area_x, -area_y}, kLeftFieldLeftPenaltyStretch);
  line("LeftFieldRightPenaltyStretch", {-x, area_y}, {-area_x, area_y}, kLeftFieldRightPenaltyStretch);
  line("RightFieldLeftPenaltyStretch", {x, area_y}, {area_x, area_y}, kRightFieldLeftPenaltyStretch);
  line("RightFieldRightPenaltyStretch", {x, -area_y}, {area_x, -area_y}, kRightFieldRightPenaltyStretch);
  field.arcs.push_back({"CenterCircle",
                        {0, 0},
                        *field.centre_circle_radius_m,
                        0,
                        2 * std::numbers::pi,
                        kLine_m,
                        kCentreCircle});
}

}  // namespace

league::FieldSize league_field(const Field& field) {
  const Division& division = field.length_m >= kShortestA_m ? kDivisionA : kDivisionB;
  league::FieldSize size;
  size.length_m = field.length_m;
  size.width_m = field.width_m;
  size.goal_width_m = std::min(division.goal_width_m, field.width_m / 3);
  size.goal_depth_m = division.goal_depth_m;
  size.boundary_width_m = 0;
  size.penalty_area_depth_m = std::min(division.area_depth_m, field.length_m / 4);
  size.penalty_area_width_m = std::min(division.area_width_m, field.width_m / 2);
  size.centre_circle_radius_m = std::min(kCentreCircle_m, field.width_m / 4);
  size.line_thickness_m = kLine_m;
  size.goal_centre_to_penalty_mark_m = std::min(division.penalty_mark_m, field.length_m * 2 / 3);
  size.goal_height_m = 0.155;
  size.ball_radius_m = 0.0215;
  size.max_robot_radius_m = 0.09;
  mark(size);
  return size;
}

CameraModel league_camera(const CameraView& view) {
  HangingCamera camera;
  camera.view_m = {view.low_m, view.high_m};
  camera.distortion = 0;
  return hang(camera);
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
