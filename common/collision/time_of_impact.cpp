// SPDX-License-Identifier: Apache-2.0
#include "common/collision/time_of_impact.hpp"

#include <limits>

namespace sidestep {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// When a point on its way enters a disc that it is not in.
double entry(const Vec2& from, const Vec2& way, const Circle& disc) {
  const Vec2 off = from - disc.centre_m;
  const double a = way.squaredNorm(), b = off.dot(way), c = off.squaredNorm() - disc.radius_m * disc.radius_m;
  const double under_root = b * b - a * c;
  if (b >= 0 || under_root < 0) return kNever;
  return std::max(0.0, c / (std::sqrt(under_root) - b));
}

/// When a point on its way comes so near to an edge that it is not so near to.
double entry(const Vec2& from, const Vec2& way, const Segment& edge, double reach) {
  double first = std::min(entry(from, way, {edge.from_m, reach}), entry(from, way, {edge.to_m, reach}));
  const Vec2 along = edge.to_m - edge.from_m, off = from - edge.from_m;
  const double length = along.norm();
  if (length == 0) return first;
  const double side = cross(along, off) / length, approach = cross(along, way) / length;
  // The line is reached from the side that the point is on.
  if (side * approach < 0) {
    const double part = std::max(0.0, (std::abs(side) - reach) / std::abs(approach));
    const double foot = along.dot(off + part * way);
    if (foot >= 0 && foot <= length * length) first = std::min(first, part);
  }
  return first;
}

double entry(const Sweep& sweep, const Vec2& way, const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape))
    return entry(sweep.from_m, way, {circle->centre_m, circle->radius_m + sweep.radius_m});
  if (const auto* segment = std::get_if<Segment>(&shape))
    return entry(sweep.from_m, way, *segment, sweep.radius_m);
  double first = kNever;
  const auto meet = [&](std::span<const Vec2> corners) {
    for (std::size_t i = 0, last = corners.size() - 1; i < corners.size(); last = i++)
      first = std::min(first, entry(sweep.from_m, way, {corners[last], corners[i]}, sweep.radius_m));
  };
  if (const auto* box = std::get_if<Box>(&shape))
    meet(corners_of(*box));
  else
    meet(std::get<ConvexPolygon>(shape).corners_m);
  return first;
}

}  // namespace

std::optional<double> time_of_impact(const Sweep& sweep, const Shape& shape) {
  if (signed_distance(sweep.from_m, shape) <= sweep.radius_m) return 0;
  const double first = entry(sweep, sweep.to_m - sweep.from_m, shape);
  if (first <= 1) return first;
  return std::nullopt;
}

}  // namespace sidestep
