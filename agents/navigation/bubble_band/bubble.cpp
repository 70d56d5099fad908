// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/bubble_band/bubble.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// The forces on a bubble are displacements. The gains and the reach of obstacles are from Philippsen (EPFL
// thesis 3146, ch. 3), whose robots are about 0.7 m wide; scale the internal force with the robot's size.
constexpr double kInternalForce_m = 0.1;  ///< internal force towards each neighbour
/// External force per metre by which the bubble's radius is below the reach of obstacles.
constexpr double kExternalForce = 0.5;
constexpr double kObstacleReach_radii = 2;  ///< reach of obstacles, in robot radii
/// Longest displacement, as a fraction of the bubble's radius.
constexpr double kMaxDisplacement_radii = 0.5;

Vec2 direction(const Vec2& offset) {
  const double length = offset.norm();
  return length > 0 ? Vec2(offset / length) : Vec2(0, 0);
}

}  // namespace

Vec2 displacement_m(const Vec2& previous_m, const Bubble& bubble, const Vec2& next_m, double robot_radius_m) {
  const double reach_m = kObstacleReach_radii * robot_radius_m;
  const Vec2& centre = bubble.centre_m;
  const Vec2 internal = kInternalForce_m * (direction(previous_m - centre) + direction(next_m - centre));
  const Vec2 external = kExternalForce * std::max(0.0, reach_m - bubble.radius_m) * bubble.away;
  const Vec2 sum = std::min(1.0, bubble.radius_m / reach_m) * (internal + external);
  const double length = sum.norm(), longest = kMaxDisplacement_radii * bubble.radius_m;
  return length > longest ? Vec2(longest / length * sum) : sum;
}

double passage_width_m(const Bubble& a, const Bubble& b) {
  const double distance2 = (a.centre_m - b.centre_m).squaredNorm();
  const double smaller = std::min(a.radius_m, b.radius_m), larger = std::max(a.radius_m, b.radius_m);
  if (distance2 > (a.radius_m + b.radius_m) * (a.radius_m + b.radius_m)) return 0;
  // The common chord lies beyond the smaller bubble's centre, so the passage is as wide as that bubble.
  if (larger * larger >= distance2 + smaller * smaller) return 2 * smaller;
  const double to_chord2 = (distance2 + smaller * smaller - larger * larger) *
                           (distance2 + smaller * smaller - larger * larger) / (4 * distance2);
  return 2 * std::sqrt(std::max(0.0, smaller * smaller - to_chord2));
}

}  // namespace sidestep
