// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/navigation/free_space.hpp"

namespace sidestep {

/// A circle that contains no obstacle.
struct Bubble {
  Vec2 centre_m{0, 0};
  double radius_m = 0;
  Vec2 away{0, 0};    ///< unit vector pointing away from the nearest obstacle; 0 if unknown
  double path_m = 0;  ///< path length along the band up to the centre
};

/// The displacement of a bubble in one step. It is pulled towards its neighbours, which shortens the band,
/// and pushed away from the nearest obstacle. Both forces are weaker on bubbles smaller than the reach of
/// obstacles. Since a displacement is shorter than the radius, a bubble never jumps over an obstacle.
[[nodiscard]] Vec2 displacement_m(const Vec2& previous_m, const Bubble& bubble, const Vec2& next_m,
                                  double robot_radius_m);

/// The diameter of the largest disc that can move straight from the centre of one bubble to the centre of
/// another bubble without leaving either bubble: the common chord if it lies between the centres, otherwise
/// the diameter of the smaller bubble; 0 if they do not overlap.
[[nodiscard]] double passage_width_m(const Bubble& a, const Bubble& b);

}  // namespace sidestep
