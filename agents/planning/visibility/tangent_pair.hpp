// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/visibility/tangent_arc.hpp"

namespace sidestep {

/// A number for each side of an arc, left and right. Tangents to both sides are computed together.
using SidePair = Eigen::Array2d;
inline const SidePair kSideSigns{1, -1};
inline Side side_of(Eigen::Index lane) { return lane == 0 ? Side::kLeft : Side::kRight; }

struct DirectionPair {
  SidePair x, y;
  Vec2 at(Eigen::Index lane) const { return {x[lane], y[lane]}; }
};
inline SidePair dot(const Vec2& a, const DirectionPair& b) { return a.x() * b.x + a.y() * b.y; }
inline SidePair cross(const Vec2& a, const DirectionPair& b) { return a.x() * b.y - a.y() * b.x; }

/// The tangents from one side of an arc to both sides of another arc.
struct TangentPair {
  DirectionPair along;  ///< unit vectors
  SidePair length_m;
  bool exist[2] = {false, false};
};

inline TangentPair tangent_pair(const TangentArc& from, Side from_side, const TangentArc& to,
                                double slack_m) {
  const Vec2 between = to.centre_m - from.centre_m;
  const double distance2 = between.squaredNorm();
  SidePair across = kSideSigns * to.radius_m - sign(from_side) * from.radius_m;
  SidePair length2 = distance2 - across.square();
  TangentPair found;
  for (Eigen::Index lane = 0; lane < 2; ++lane) {
    found.exist[lane] = length2[lane] >= 0 && distance2 > 0;
    if (length2[lane] >= 0) continue;
    found.exist[lane] =
        snap_to_circle(from.radius_m == 0 || to.radius_m == 0, std::sqrt(distance2), slack_m, across[lane]);
    length2[lane] = 0;
  }
  found.length_m = length2.sqrt();
  found.along.x = (found.length_m * between.x() + across * between.y()) / distance2;
  found.along.y = (found.length_m * between.y() - across * between.x()) / distance2;
  return found;
}

/// Whether both arcs may cover their tangent points, for a tangent to either side. A conservative test
/// without a square root: the direction of a tangent differs from the line between the centres by an angle
/// bounded by the radii.
inline bool may_have_tangent(const TangentArc& from, Side from_side, const TangentArc& to, double slack_m) {
  if (!from.is_corner && !to.is_corner) return true;
  const Vec2 between = to.centre_m - from.centre_m;
  const SidePair across = (kSideSigns * to.radius_m - sign(from_side) * from.radius_m).abs();
  // 1.16 is an upper bound of 1 / cos for angles up to 30 degrees; the last line accepts larger angles. For
  // full circles, `first` and `last` are zero.
  const SidePair tolerance_m = 1.16 * across + slack_m;
  const double departure_slack_m =
      std::min(-sign(from_side) * between.dot(from.first), sign(from_side) * between.dot(from.last));
  const SidePair arrival_slack_m =
      (-between.dot(to.first) * kSideSigns).min(between.dot(to.last) * kSideSigns);
  return (tolerance_m + arrival_slack_m.min(departure_slack_m))
             .max(4 * across.square() - between.squaredNorm())
             .maxCoeff() >= 0;
}

/// How far the tangent points of two directions lie inside an arc: approximately the angle in radians;
/// negative outside.
inline SidePair arc_slack(const TangentArc& arc, const SidePair& signs, const DirectionPair& along) {
  const DirectionPair touching{signs * along.y, -signs * along.x};
  return cross(arc.first, touching).min(-cross(arc.last, touching));
}

}  // namespace sidestep
