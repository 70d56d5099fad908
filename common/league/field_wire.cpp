// SPDX-License-Identifier: Apache-2.0
#include "common/league/field_wire.hpp"

namespace sidestep::league {
namespace {

constexpr int kMaxMarkings = 256;
constexpr std::uint32_t kMaxImageSide_px = 1 << 16;

std::int32_t in_mm(double length_m) { return static_cast<std::int32_t>(std::lround(length_m * 1e3)); }
float in_float_mm(double length_m) { return static_cast<float>(length_m * 1e3); }

double length(double value_mm, PacketValidator& validator) {
  return validator.within(value_mm * 1e-3, 0, kMaxCoordinate_m);
}

void write(const Vec2& point_m, wire::vision::Point& to) {
  to.set_x(in_float_mm(point_m.x()));
  to.set_y(in_float_mm(point_m.y()));
}

Vec2 read(const wire::vision::Point& from, PacketValidator& validator) {
  return {validator.within(from.x() * 1e-3, kMaxCoordinate_m),
          validator.within(from.y() * 1e-3, kMaxCoordinate_m)};
}

void write(const LineMarking& line, wire::vision::Line& to) {
  to.set_name(line.name);
  write(line.from_m, *to.mutable_p1());
  write(line.to_m, *to.mutable_p2());
  to.set_thickness(in_float_mm(line.thickness_m));
  if (line.type) to.set_type(*line.type);
}

LineMarking read(const wire::vision::Line& from, PacketValidator& validator) {
  LineMarking line{validator.text(from.name()), read(from.p1(), validator), read(from.p2(), validator),
                   length(from.thickness(), validator)};
  if (from.has_type()) line.type = from.type();
  return line;
}

void write(const ArcMarking& arc, wire::vision::Arc& to) {
  to.set_name(arc.name);
  write(arc.centre_m, *to.mutable_center());
  to.set_radius(in_float_mm(arc.radius_m));
  to.set_a1(static_cast<float>(arc.from_rad));
  to.set_a2(static_cast<float>(arc.to_rad));
  to.set_thickness(in_float_mm(arc.thickness_m));
  if (arc.type) to.set_type(*arc.type);
}

ArcMarking read(const wire::vision::Arc& from, PacketValidator& validator) {
  ArcMarking arc{validator.text(from.name()),
                 read(from.center(), validator),
                 length(from.radius(), validator),
                 validator.within(from.a1(), kMaxHeading_rad),
                 validator.within(from.a2(), kMaxHeading_rad),
                 length(from.thickness(), validator)};
  if (from.has_type()) arc.type = from.type();
  return arc;
}

void write(const FieldSize& field, wire::vision::Field& to) {
  to.set_field_length(in_mm(field.length_m));
  to.set_field_width(in_mm(field.width_m));
  to.set_goal_width(in_mm(field.goal_width_m));
  to.set_goal_depth(in_mm(field.goal_depth_m));
  to.set_boundary_width(in_mm(field.boundary_width_m));
  for (const LineMarking& line : field.lines) write(line, *to.add_field_lines());
  for (const ArcMarking& arc : field.arcs) write(arc, *to.add_field_arcs());
  if (field.penalty_area_depth_m) to.set_penalty_area_depth(in_mm(*field.penalty_area_depth_m));
  if (field.penalty_area_width_m) to.set_penalty_area_width(in_mm(*field.penalty_area_width_m));
  if (field.centre_circle_radius_m) to.set_center_circle_radius(in_mm(*field.centre_circle_radius_m));
  if (field.line_thickness_m) to.set_line_thickness(in_mm(*field.line_thickness_m));
  if (field.goal_centre_to_penalty_mark_m) {
    to.set_goal_center_to_penalty_mark(in_mm(*field.goal_centre_to_penalty_mark_m));
  }
  if (field.goal_height_m) to.set_goal_height(in_mm(*field.goal_height_m));
  if (field.ball_radius_m) to.set_ball_radius(in_float_mm(*field.ball_radius_m));
  if (field.max_robot_radius_m) to.set_max_robot_radius(in_float_mm(*field.max_robot_radius_m));
}

FieldSize read(const wire::vision::Field& from, PacketValidator& validator) {
  FieldSize field;
  validator.at_most(from.field_lines(), kMaxMarkings);
  validator.at_most(from.field_arcs(), kMaxMarkings);
  if (!validator.is_valid()) return field;
  validator.require(from.field_length() > 0 && from.field_width() > 0, DecodeError::kNumber);
  field.length_m = length(from.field_length(), validator);
  field.width_m = length(from.field_width(), validator);
  field.goal_width_m = length(from.goal_width(), validator);
  field.goal_depth_m = length(from.goal_depth(), validator);
  field.boundary_width_m = length(from.boundary_width(), validator);
  for (const auto& line : from.field_lines()) field.lines.push_back(read(line, validator));
  for (const auto& arc : from.field_arcs()) field.arcs.push_back(read(arc, validator));
  const auto optional = [&](bool is_present, double value_mm, std::optional<double>& into) {
    if (is_present) into = length(value_mm, validator);
  };
  optional(from.has_penalty_area_depth(), from.penalty_area_depth(), field.penalty_area_depth_m);
  optional(from.has_penalty_area_width(), from.penalty_area_width(), field.penalty_area_width_m);
  optional(from.has_center_circle_radius(), from.center_circle_radius(), field.centre_circle_radius_m);
  optional(from.has_line_thickness(), from.line_thickness(), field.line_thickness_m);
  optional(from.has_goal_center_to_penalty_mark(), from.goal_center_to_penalty_mark(),
           field.goal_centre_to_penalty_mark_m);
  optional(from.has_goal_height(), from.goal_height(), field.goal_height_m);
  optional(from.has_ball_radius(), from.ball_radius(), field.ball_radius_m);
  optional(from.has_max_robot_radius(), from.max_robot_radius(), field.max_robot_radius_m);
  return field;
}

void write(const CameraCalibration& camera, wire::vision::Calibration& to) {
  to.set_camera_id(camera.camera);
  to.set_focal_length(static_cast<float>(camera.focal_length_px));
  to.set_principal_point_x(static_cast<float>(camera.principal_point_px.x()));
  to.set_principal_point_y(static_cast<float>(camera.principal_point_px.y()));
  to.set_distortion(static_cast<float>(camera.distortion));
  to.set_q0(static_cast<float>(camera.rotation[0]));
  to.set_q1(static_cast<float>(camera.rotation[1]));
  to.set_q2(static_cast<float>(camera.rotation[2]));
  to.set_q3(static_cast<float>(camera.rotation[3]));
  to.set_tx(in_float_mm(camera.translation_m.x()));
  to.set_ty(in_float_mm(camera.translation_m.y()));
  to.set_tz(in_float_mm(camera.translation_m.z()));
  if (camera.position_m) {
    to.set_derived_camera_world_tx(in_float_mm(camera.position_m->x()));
    to.set_derived_camera_world_ty(in_float_mm(camera.position_m->y()));
    to.set_derived_camera_world_tz(in_float_mm(camera.position_m->z()));
  }
  if (camera.image_width_px) to.set_pixel_image_width(*camera.image_width_px);
  if (camera.image_height_px) to.set_pixel_image_height(*camera.image_height_px);
}

CameraCalibration read(const wire::vision::Calibration& from, PacketValidator& validator) {
  constexpr double kMaxFocalLength_px = 1e6, kMaxPrincipalPoint_px = 1e5, kMaxDistortion = 100;
  const auto position = [&](double x_mm, double y_mm, double z_mm) {
    return Vec3(validator.within(x_mm * 1e-3, kMaxCoordinate_m),
                validator.within(y_mm * 1e-3, kMaxCoordinate_m),
                validator.within(z_mm * 1e-3, kMaxCoordinate_m));
  };
  CameraCalibration camera;
  validator.require(from.camera_id() < kMaxCameras, DecodeError::kCamera);
  camera.camera = from.camera_id();
  camera.focal_length_px = validator.within(from.focal_length(), 0, kMaxFocalLength_px);
  camera.principal_point_px = {validator.within(from.principal_point_x(), kMaxPrincipalPoint_px),
                               validator.within(from.principal_point_y(), kMaxPrincipalPoint_px)};
  camera.distortion = validator.within(from.distortion(), kMaxDistortion);
  camera.rotation = {validator.within(from.q0(), 2), validator.within(from.q1(), 2),
                     validator.within(from.q2(), 2), validator.within(from.q3(), 2)};
  camera.translation_m = position(from.tx(), from.ty(), from.tz());
  if (from.has_derived_camera_world_tx() && from.has_derived_camera_world_ty() &&
      from.has_derived_camera_world_tz()) {
    camera.position_m = position(from.derived_camera_world_tx(), from.derived_camera_world_ty(),
                                 from.derived_camera_world_tz());
  }
  const auto side = [&](bool is_present, std::uint32_t value_px, std::optional<std::uint32_t>& into) {
    validator.require(!is_present || value_px <= kMaxImageSide_px, DecodeError::kNumber);
    if (is_present) into = value_px;
  };
  side(from.has_pixel_image_width(), from.pixel_image_width(), camera.image_width_px);
  side(from.has_pixel_image_height(), from.pixel_image_height(), camera.image_height_px);
  return camera;
}

}  // namespace

void write(const Geometry& geometry, wire::vision::Geometry& to) {
  write(geometry.field, *to.mutable_field());
  for (const CameraCalibration& camera : geometry.cameras) write(camera, *to.add_calib());
}

Geometry read(const wire::vision::Geometry& from, PacketValidator& validator) {
  Geometry geometry;
  validator.at_most(from.calib(), static_cast<int>(kMaxCameras));
  if (!validator.is_valid()) return geometry;
  geometry.field = read(from.field(), validator);
  for (const auto& camera : from.calib()) geometry.cameras.push_back(read(camera, validator));
  return geometry;
}

}  // namespace sidestep::league
