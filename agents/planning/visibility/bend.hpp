// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "common/collision/shapes.hpp"

namespace sidestep {

/// Shortest ways of a disc are straight but for bends: round a circle, or round a corner of another shape, at
/// the distance of the disc's radius. A bend is the part of a circle that such a way may follow.
struct Bend {
  Vec2 centre_m{0, 0};
  double radius_m = 0;  ///< 0: a start or a goal
  /// A corner's arc, counter-clockwise between two directions from the centre; at most half a circle.
  bool is_corner = false;
  Vec2 first{0, 0}, last{0, 0};

  /// Whether the arc goes through the direction from the centre, a unit vector, up to `slack_rad`.
  bool holds(const Vec2& direction, double slack_rad = 0) const {
    const double least = -1e-9 - slack_rad;
    return !is_corner || (cross(first, direction) >= least && cross(direction, last) >= least);
  }
};

/// Appends the bends round a shape for ways that keep `min_separation_m` from it.
void append_bends(const Shape& shape, double min_separation_m, std::vector<Bend>& bends);

/// On which side of a way a bend lies: the way turns to that side.
enum class Side { kLeft = 1, kRight = -1 };
inline double sign(Side side) { return static_cast<double>(side); }

/// The straight motion from one bend to another.
struct Tangent {
  Vec2 along{1, 0};  ///< of length 1
  double length_m = 0;
};

/// Where circles overlap, there is no way from one to the other. A point may lie within a circle by up to
/// `slack_m`: then it lies on it. `across_m`, as far as the way gets nearer to the one circle's centre than
/// to the other's, is changed accordingly.
inline bool lies_on(bool is_point, double distance_m, double slack_m, double& across_m) {
  if (!is_point || std::abs(across_m) - distance_m > slack_m || distance_m == 0) return false;
  across_m = std::copysign(distance_m, across_m);
  return true;
}

/// The way that has one bend on one side and then the other on its; none where they overlap.
inline std::optional<Tangent> tangent(const Bend& from, Side from_side, const Bend& to, Side to_side,
                                      double slack_m) {
  const Vec2 between = to.centre_m - from.centre_m;
  const double distance2 = between.squaredNorm();
  double across = sign(to_side) * to.radius_m - sign(from_side) * from.radius_m;
  double length2 = distance2 - across * across;
  if (length2 < 0) {
    if (!lies_on(from.radius_m == 0 || to.radius_m == 0, std::sqrt(distance2), slack_m, across))
      return std::nullopt;
    length2 = 0;
  }
  if (distance2 == 0) return std::nullopt;
  const double length = std::sqrt(length2);
  return Tangent{(length * between - across * left_of(between)) / distance2, length};
}

/// Where a way that goes along `along` touches a bend on its side.
inline Vec2 touching_point(const Bend& bend, Side side, const Vec2& along) {
  return bend.centre_m - sign(side) * bend.radius_m * left_of(along);
}
/// The direction of that point from the bend's centre.
inline Vec2 touching_direction(Side side, const Vec2& along) { return -sign(side) * left_of(along); }

/// By how much a way turns towards its side between two directions, in [0, 2 pi); a turn back that is but
/// rounding is none.
inline double turn_rad(Side side, const Vec2& from, const Vec2& to) {
  const double across = sign(side) * cross(from, to), along = from.dot(to);
  const double angle = std::atan2(across, along);
  constexpr double kFull = 6.283185307179586, kRounding = 1e-9;
  if (angle >= 0) return angle;
  return angle > -kRounding ? 0 : angle + kFull;
}

/// Appends the corners of the way round a bend, from the direction `from` on through `turn_rad`, that lie
/// outside of it; each turns by at most `most_rad`.
void append_corners(const Bend& bend, Side side, const Vec2& from, double turn_rad, double most_rad,
                    std::vector<Vec2>& corners);

}  // namespace sidestep
