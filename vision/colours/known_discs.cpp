// SPDX-License-Identifier: Apache-2.0
#include "vision/colours/known_discs.hpp"

#include <cmath>

#include "vision/patterns/patch.hpp"

namespace sidestep {

std::optional<KnownDisc> seen_disc(const CameraModel& camera, Colour colour, const Vec3& centre_m,
                                   double radius_m) {
  const auto pixel = camera.pixel_of(centre_m);
  const auto covered = px2_per_m2(camera, centre_m);
  if (!pixel || !covered || !camera.shows(*pixel)) return std::nullopt;
  return KnownDisc{colour, *pixel, radius_m * std::sqrt(*covered)};
}

std::vector<KnownDisc> seen_dots(const CameraModel& camera, const MarkingLayout& layout, Team team,
                                 const MarkingPattern& pattern, const Pose& pose, double height_m) {
  std::vector<KnownDisc> discs;
  const auto add = [&](Colour colour, const MarkingDot& dot) {
    const Vec2 at_m = pose.to_world(dot.position_m);
    const auto disc = seen_disc(camera, colour, {at_m.x(), at_m.y(), height_m}, dot.radius_m);
    if (disc) discs.push_back(*disc);
  };
  add(layout.team_colour(team), layout.centre);
  for (std::size_t k = 0; k < layout.dots.size(); ++k) add(pattern.colours[k], layout.dots[k]);
  return discs;
}

}  // namespace sidestep
