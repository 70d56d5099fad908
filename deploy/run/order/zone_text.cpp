// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/zone_text.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "common/geometry/vec2.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/process/command_line.hpp"
#include "deploy/run/order/goal_text.hpp"

namespace sidestep {
namespace {

constexpr double kMinWidth_m = 0.001;

/// Whether the convex hull of the corners is wider than kMinWidth_m.
bool has_area(const std::vector<Vec2>& corners_m) {
  const Vec2 first = corners_m.front();
  const Vec2 farthest = *std::ranges::max_element(
      corners_m, {}, [&](const Vec2& corner) { return (corner - first).squaredNorm(); });
  const Vec2 along = farthest - first;
  return std::ranges::any_of(corners_m, [&](const Vec2& corner) {
    return std::abs(cross(along, corner - first)) > kMinWidth_m * along.norm();
  });
}

}  // namespace

Zone parse_zone(const std::vector<std::string>& corners, double radius_m,
                std::optional<double> speed_limit_mps) {
  if (corners.empty()) throw UsageError("CORNER is missing: expected X,Y, or --remove");
  if (corners.size() > kMaxZoneCorners)
    throw UsageError(fmt::format("expected at most {} corners", kMaxZoneCorners));
  Zone zone{{}, radius_m, speed_limit_mps};
  for (const std::string& corner : corners) zone.corners_m.push_back(parse_place(corner, "corner of a zone"));
  if (radius_m == 0 && !has_area(zone.corners_m))
    throw UsageError("the zone covers no area: expected three corners that are not in line, or --radius");
  return zone;
}

}  // namespace sidestep
