// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/bubble_band/bubble.hpp"

#include <algorithm>

namespace sidestep {
namespace {

Vec2 direction(const Vec2& offset) {
  const double length = offset.norm();
  return length > 0 ? Vec2(offset / length) : Vec2(0, 0);
}

}  // namespace

Vec2 displacement_m(const Vec2& previous_m, const Bubble& bubble, const Vec2& next_m, double robot_radius_m,
                    const BubbleForces& forces) {
  const double reach_m = forces.reach_radii * robot_radius_m;
  const Vec2& centre = bubble.centre_m;
  const Vec2 internal = forces.internal_m * (direction(previous_m - centre) + direction(next_m - centre));
  const Vec2 external = forces.external * std::max(0.0, reach_m - bubble.radius_m) * bubble.away;
  const Vec2 sum = std::min(1.0, bubble.radius_m / reach_m) * (internal + external);
  const double length = sum.norm(), longest = forces.max_step * bubble.radius_m;
  return length > longest ? Vec2(longest / length * sum) : sum;
}

double passage_m(const Bubble& a, const Bubble& b) {
  const double distance2 = (a.centre_m - b.centre_m).squaredNorm();
  const double smaller = std::min(a.radius_m, b.radius_m), larger = std::max(a.radius_m, b.radius_m);
  if (distance2 > (a.radius_m + b.radius_m) * (a.radius_m + b.radius_m)) return 0;
  // The chord lies beyond the smaller bubble's centre.
  if (larger * larger >= distance2 + smaller * smaller) return 2 * smaller;
  const double to_chord2 = (distance2 + smaller * smaller - larger * larger) *
                           (distance2 + smaller * smaller - larger * larger) / (4 * distance2);
  return 2 * std::sqrt(std::max(0.0, smaller * smaller - to_chord2));
}

}  // namespace sidestep
