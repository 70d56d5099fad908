// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/half_plane_program.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sidestep {
namespace {

/// A point this far outside of a half-plane counts as inside, because of rounding.
constexpr double kTolerance = 1e-9;
/// The sine of the angle below which two boundaries count as parallel.
constexpr double kParallel = 1e-9;

/// The part of a straight line between two distances from its origin, along its direction.
struct LinePart {
  Vec2 origin, direction;
  double from, to;

  Vec2 at(double distance) const { return origin + distance * direction; }
};

/// The part of a half-plane's boundary that lies in the disc and in the other half-planes; nullopt if it is
/// empty.
std::optional<LinePart> part_inside(const HalfPlane& boundary, std::span<const HalfPlane> planes,
                                    const Circle& disc) {
  const double off = boundary.depth(disc.centre_m);
  const double half2 = disc.radius_m * disc.radius_m - off * off;
  if (half2 < 0) return std::nullopt;
  const double half = std::sqrt(half2);
  LinePart part{disc.centre_m - off * boundary.normal, left_of(boundary.normal), -half, half};
  for (const HalfPlane& plane : planes) {
    const double depth = plane.depth(part.origin), gain = plane.normal.dot(part.direction);
    if (std::abs(gain) < kParallel) {
      if (depth < -kTolerance) return std::nullopt;
      continue;
    }
    if (gain > 0)
      part.from = std::max(part.from, -depth / gain);
    else
      part.to = std::min(part.to, -depth / gain);
    if (part.from > part.to) return std::nullopt;
  }
  return part;
}

/// The best point of the disc and of all half-planes. `best` is the best point of the disc, and
/// `best_of(LinePart)` returns the best point of a part of a line.
template <typename BestOf>
std::optional<Vec2> best_inside(std::span<const HalfPlane> planes, const Circle& disc, Vec2 best,
                                BestOf best_of) {
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].depth(best) >= -kTolerance) continue;
    // The best point is outside of this half-plane, so the new one is on its boundary.
    const std::optional<LinePart> part = part_inside(planes[i], planes.first(i), disc);
    if (!part) return std::nullopt;
    best = best_of(*part);
  }
  return best;
}

std::optional<Vec2> farthest_inside(std::span<const HalfPlane> planes, const Circle& disc,
                                    const Vec2& direction) {
  return best_inside(planes, disc, disc.centre_m + disc.radius_m * direction, [&](const LinePart& part) {
    return part.at(part.direction.dot(direction) > 0 ? part.to : part.from);
  });
}

/// The points that are no farther outside of `plane` than of `reference`; nullopt if the normals are equal.
std::optional<HalfPlane> no_farther_outside(const HalfPlane& plane, const HalfPlane& reference) {
  const Vec2 difference = plane.normal - reference.normal;
  const double length = difference.norm();
  if (length < kParallel) return std::nullopt;
  const Vec2 normal = difference / length;
  const double offset = (plane.normal.dot(plane.point) - reference.normal.dot(reference.point)) / length;
  return HalfPlane{offset * normal, normal};
}

}  // namespace

std::optional<Vec2> nearest_inside(std::span<const HalfPlane> planes, const Circle& disc,
                                   const Vec2& target) {
  const Vec2 off = target - disc.centre_m;
  const double distance = off.norm();
  const Vec2 nearest =
      distance <= disc.radius_m ? target : Vec2(disc.centre_m + off * (disc.radius_m / distance));
  return best_inside(planes, disc, nearest, [&](const LinePart& part) {
    return part.at(std::clamp((target - part.origin).dot(part.direction), part.from, part.to));
  });
}

std::optional<Vec2> least_outside(std::span<const HalfPlane> hard, std::span<const HalfPlane> soft,
                                  const Circle& disc) {
  std::optional<Vec2> best = nearest_inside(hard, disc, disc.centre_m);
  if (!best) return std::nullopt;
  double outside = 0;
  std::vector<HalfPlane> planes;
  for (std::size_t i = 0; i < soft.size(); ++i) {
    if (-soft[i].depth(*best) <= outside + kTolerance) continue;
    // This half-plane determines the new distance: it is the one that the new point is farthest outside of.
    planes.assign(hard.begin(), hard.end());
    for (const HalfPlane& earlier : soft.first(i))
      if (const auto plane = no_farther_outside(earlier, soft[i])) planes.push_back(*plane);
    // Rounding may hide the common point of the half-planes. The last point is then as good as any.
    if (const auto point = farthest_inside(planes, disc, soft[i].normal)) best = point;
    outside = std::max(outside, -soft[i].depth(*best));
  }
  return best;
}

}  // namespace sidestep
