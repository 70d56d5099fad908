// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/free_fraction.hpp"

#include <algorithm>

namespace sidestep {

double free_fraction(const ObstacleWorld& obstacles, const Vec2& from_m, const Vec2& to_m, double radius_m) {
  constexpr double kStandoff_m = 1e-6;
  const auto contact = obstacles.first_contact(from_m, to_m, radius_m);
  if (!contact) return obstacles.touches(from_m, to_m, radius_m) ? 0 : 1;
  const double length_m = (to_m - from_m).norm();
  if (length_m == 0) return 0;
  const double fraction = std::max(contact->fraction - kStandoff_m / length_m, 0.0);
  // If the motion grazes an obstacle, the disc may still touch it at a micrometre before the contact.
  return obstacles.touches(from_m, from_m + fraction * (to_m - from_m), radius_m) ? 0 : fraction;
}

}  // namespace sidestep
