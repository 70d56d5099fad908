// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/zone_map.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>

#include "common/geometry/convex_hull.hpp"

namespace sidestep {
namespace {

// Number of corners of the polygon around a circle.
constexpr int kCircleCorners = 24;

}  // namespace

Shape outline_of(const Zone& zone) {
  if (zone.corners_m.size() == 1) return Circle{zone.corners_m.front(), zone.radius_m};
  std::vector<Vec2> points;
  const double step_rad = 2 * std::numbers::pi / kCircleCorners;
  const Vec2 first(zone.radius_m / std::cos(step_rad / 2), 0);
  for (const Vec2& corner : zone.corners_m) {
    for (int i = 0; i < (zone.radius_m > 0 ? kCircleCorners : 1); ++i)
      points.push_back(corner + rotated(first, i * step_rad));
  }
  std::vector<Vec2> hull = convex_hull(std::move(points));
  if (hull.size() >= 3) return ConvexPolygon{std::move(hull)};
  return Segment{hull.front(), hull.back()};
}

ZoneMap::ZoneMap(std::span<const Order> orders) {
  for (const Order& order : orders) {
    Shape outline = outline_of(order.zone);
    if (order.zone.speed_limit_mps) {
      speed_zones_.push_back({std::move(outline), *order.zone.speed_limit_mps});
    } else {
      keep_outs_.push_back(std::move(outline));
      keep_out_numbers_.push_back(order.zone_number);
    }
  }
}

std::vector<Circle> ZoneMap::seen_from(const Vec2& position) const {
  std::vector<Circle> circles;
  for (const Shape& zone : keep_outs_) {
    const auto* circle = std::get_if<Circle>(&zone);
    circles.push_back(circle ? *circle : Circle{nearest_boundary_point(position, zone), 0});
  }
  return circles;
}

bool ZoneMap::is_kept_out(const Vec2& position, double radius) const {
  return std::ranges::any_of(keep_outs_,
                             [&](const Shape& zone) { return signed_distance(position, zone) <= radius; });
}

double ZoneMap::max_speed_mps(const Vec2& position, double speed, double radius, Duration reaction,
                              const MotionLimits& limits) const {
  double max_mps = std::numeric_limits<double>::infinity();
  for (const SpeedZone& zone : speed_zones_) {
    const double ahead = signed_distance(position, zone.outline) - radius - speed * to_seconds(reaction);
    const double braked2 = 2 * limits.deceleration_mps2 * std::max(0.0, ahead);
    max_mps = std::min(max_mps, std::sqrt(zone.limit_mps * zone.limit_mps + braked2));
  }
  return max_mps;
}

}  // namespace sidestep
