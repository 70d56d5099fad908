// SPDX-License-Identifier: Apache-2.0
#include "vision/colours/labelled_discs.hpp"

#include <cmath>

#include "vision/patterns/projected_region.hpp"

namespace sidestep {

std::optional<LabelledDisc> projected_disc(const CameraModel& camera, Colour colour, const Vec3& centre_m,
                                           double radius_m) {
  const auto pixel = camera.pixel_of(centre_m);
  const auto scale = px2_per_m2(camera, centre_m);
  if (!pixel || !scale || !camera.is_in_image(*pixel)) return std::nullopt;
  return LabelledDisc{colour, *pixel, radius_m * std::sqrt(*scale)};
}

std::vector<LabelledDisc> projected_dots(const CameraModel& camera, const MarkerLayout& layout, Team team,
                                         const MarkerPattern& pattern, const Pose& pose, double height_m) {
  std::vector<LabelledDisc> discs;
  const auto add = [&](Colour colour, const Marker& dot) {
    const Vec2 position_m = pose.to_world(dot.position_m);
    const auto disc =
        projected_disc(camera, colour, {position_m.x(), position_m.y(), height_m}, dot.radius_m);
    if (disc) discs.push_back(*disc);
  };
  add(layout.team_colour(team), layout.centre);
  for (std::size_t k = 0; k < layout.dots.size(); ++k) add(pattern.colours[k], layout.dots[k]);
  return discs;
}

}  // namespace sidestep
