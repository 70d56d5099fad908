// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/visibility/bend.hpp"

namespace sidestep {

/// A number for the left side of a bend and one for the right: ways to both are computed together.
using BothSides = Eigen::Array2d;
inline const BothSides kSigns{1, -1};
inline Side side_of(Eigen::Index lane) { return lane == 0 ? Side::kLeft : Side::kRight; }

struct BothDirections {
  BothSides x, y;
  Vec2 at(Eigen::Index lane) const { return {x[lane], y[lane]}; }
};
inline BothSides dot(const Vec2& a, const BothDirections& b) { return a.x() * b.x + a.y() * b.y; }
inline BothSides cross(const Vec2& a, const BothDirections& b) { return a.x() * b.y - a.y() * b.x; }

/// The tangents from a bend on a side to both sides of another.
struct Tangents {
  BothDirections along;  ///< of length 1
  BothSides length_m;
  bool exist[2];
};

inline Tangents tangents(const Bend& from, Side from_side, const Bend& to, double slack_m) {
  const Vec2 between = to.centre_m - from.centre_m;
  const double distance2 = between.squaredNorm();
  BothSides across = kSigns * to.radius_m - sign(from_side) * from.radius_m;
  BothSides length2 = distance2 - across.square();
  Tangents found;
  for (Eigen::Index lane = 0; lane < 2; ++lane) {
    found.exist[lane] = length2[lane] >= 0 && distance2 > 0;
    if (length2[lane] >= 0) continue;
    found.exist[lane] =
        lies_on(from.radius_m == 0 || to.radius_m == 0, std::sqrt(distance2), slack_m, across[lane]);
    length2[lane] = 0;
  }
  found.length_m = length2.sqrt();
  found.along.x = (found.length_m * between.x() + across * between.y()) / distance2;
  found.along.y = (found.length_m * between.y() - across * between.x()) / distance2;
  return found;
}

/// Whether a tangent to one of the sides may be within both bends' arcs, as far as that is known without a
/// root: its direction is the centres' up to what the radii make of it.
inline bool may_have_tangent(const Bend& from, Side from_side, const Bend& to, double slack_m) {
  if (!from.is_corner && !to.is_corner) return true;
  const Vec2 between = to.centre_m - from.centre_m;
  const BothSides across = (kSigns * to.radius_m - sign(from_side) * from.radius_m).abs();
  // Over the cosine of at most 30 degrees. What is no corner has directions of 0.
  const BothSides extra_clearance_m = 1.16 * across + slack_m;
  const double leaves_m =
      std::min(-sign(from_side) * between.dot(from.first), sign(from_side) * between.dot(from.last));
  const BothSides arrives_m = (-between.dot(to.first) * kSigns).min(between.dot(to.last) * kSigns);
  return (extra_clearance_m + arrives_m.min(leaves_m)).max(4 * across.square() - between.squaredNorm()).maxCoeff() >= 0;
}

/// By how much directions are within a bend's arc where ways along them touch it: about the angle, negative
/// for those outside.
inline BothSides within(const Bend& bend, const BothSides& signs, const BothDirections& along) {
  const BothDirections touching{signs * along.y, -signs * along.x};
  return cross(bend.first, touching).min(-cross(bend.last, touching));
}

}  // namespace sidestep
