// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/picture/shown_part.hpp"

#include <algorithm>
#include <optional>

namespace sidestep {
namespace {

constexpr double kMarginShare = 0.06;    // of the larger side
constexpr double kMarginRadii = 4;       // minimum margin, in radii of a robot
constexpr double kNearEdgeShare = 0.06;  // of the field: strips narrower than this are shown, too
constexpr double kMinAspect = 0.5, kMaxAspect = 2.5;  // width over height

std::optional<Box> used_part(const FloorTrace& trace) {
  std::optional<Box> part;
  const auto add = [&part](const Vec2& p, double radius_m) {
    const Box disc = inflated(Box{p, p}, radius_m);
    part = part ? united(*part, disc) : disc;
  };
  for (const FloorTrace::Robot& robot : trace.robots) {
    add(robot.start_m, trace.radius_m);
    for (const Vec2& goal : robot.goals_m) add(goal, trace.radius_m);
    for (const FloorTrace::Point& point : robot.path) add(point.position_m, trace.radius_m);
  }
  for (const OpponentSpec& opponent : trace.opponents)
    for (const Vec2& point : opponent.path_m) add(point, opponent.radius_m);
  return part;
}

/// Extends one axis of the part to an edge of the field that is near.
void extend_to_edges(double& min, double& max, double field_min, double field_max) {
  const double near = kNearEdgeShare * (field_max - field_min);
  if (min - field_min < near) min = std::min(min, field_min);
  if (field_max - max < near) max = std::max(max, field_max);
}

/// Extends one axis of the part to this length, within the field as far as possible.
void extend_to_length(double& min, double& max, double length, double field_min, double field_max) {
  const double missing = std::min(length, std::max(field_max - field_min, max - min)) - (max - min);
  if (missing <= 0) return;
  min -= missing / 2;
  max += missing / 2;
  const double shift = std::max(0.0, field_min - min) - std::max(0.0, max - field_max);
  min += shift;
  max += shift;
}

}  // namespace

Box field_box(const Field& field) {
  return {{-field.length_m / 2, -field.width_m / 2}, {field.length_m / 2, field.width_m / 2}};
}

Box shown_part(const FloorTrace& trace) {
  const Box field = field_box(trace.field);
  const auto used = used_part(trace);
  if (!used) return field;
  const Vec2 used_size = used->max_m - used->min_m;
  const double margin_m = std::max(kMarginShare * used_size.maxCoeff(), kMarginRadii * trace.radius_m);
  Box part = inflated(*used, margin_m);
  for (const Shape& obstacle : trace.obstacles) {
    const Box box = bounds(obstacle);
    // A long wall would make everything else small.
    const bool is_small = ((box.max_m - box.min_m).array() < used_size.array() / 2).all();
    if (is_small && overlap(box, part)) part = united(part, inflated(box, trace.radius_m));
  }
  // The margin ends at the field's edge.
  part.min_m = part.min_m.cwiseMax(field.min_m.cwiseMin(used->min_m));
  part.max_m = part.max_m.cwiseMin(field.max_m.cwiseMax(used->max_m));
  for (const int axis : {0, 1})
    extend_to_edges(part.min_m[axis], part.max_m[axis], field.min_m[axis], field.max_m[axis]);
  const Vec2 size = part.max_m - part.min_m;
  extend_to_length(part.min_m.x(), part.max_m.x(), kMinAspect * size.y(), field.min_m.x(), field.max_m.x());
  extend_to_length(part.min_m.y(), part.max_m.y(), size.x() / kMaxAspect, field.min_m.y(), field.max_m.y());
  return part;
}

}  // namespace sidestep
