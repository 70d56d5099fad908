// SPDX-License-Identifier: Apache-2.0
#include "common/collision/time_of_impact.hpp"

#include <limits>

namespace sidestep {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// The fraction of the displacement after which a point outside a disc enters it.
double entry(const Vec2& from, const Vec2& displacement, const Circle& disc) {
  const Vec2 off = from - disc.centre_m;
  const double a = displacement.squaredNorm(), b = off.dot(displacement),
               c = off.squaredNorm() - disc.radius_m * disc.radius_m;
  const double under_root = b * b - a * c;
  if (b >= 0 || under_root < 0) return kInfinite;
  return std::max(0.0, c / (std::sqrt(under_root) - b));
}

/// The fraction of the displacement after which a point that is farther than `reach` from an edge comes
/// within `reach`.
double entry(const Vec2& from, const Vec2& displacement, const Segment& edge, double reach) {
  double first = std::min(entry(from, displacement, {edge.from_m, reach}),
                          entry(from, displacement, {edge.to_m, reach}));
  const Vec2 along = edge.to_m - edge.from_m, off = from - edge.from_m;
  const double length = along.norm();
  if (length == 0) return first;
  const double side = cross(along, off) / length, approach = cross(along, displacement) / length;
  // The point moves towards the edge's line.
  if (side * approach < 0) {
    const double fraction = std::max(0.0, (std::abs(side) - reach) / std::abs(approach));
    const double foot = along.dot(off + fraction * displacement);
    if (foot >= 0 && foot <= length * length) first = std::min(first, fraction);
  }
  return first;
}

double entry(const Sweep& sweep, const Vec2& displacement, const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape))
    return entry(sweep.from_m, displacement, {circle->centre_m, circle->radius_m + sweep.radius_m});
  if (const auto* segment = std::get_if<Segment>(&shape))
    return entry(sweep.from_m, displacement, *segment, sweep.radius_m);
  double first = kInfinite;
  const auto consider = [&](std::span<const Vec2> corners) {
    for (std::size_t i = 0, last = corners.size() - 1; i < corners.size(); last = i++)
      first = std::min(first, entry(sweep.from_m, displacement, {corners[last], corners[i]}, sweep.radius_m));
  };
  if (const auto* box = std::get_if<Box>(&shape))
    consider(corners_of(*box));
  else
    consider(std::get<ConvexPolygon>(shape).corners_m);
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
