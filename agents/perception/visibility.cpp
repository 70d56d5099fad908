// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/visibility.hpp"

#include <algorithm>
#include <stdexcept>

namespace sidestep {

double min_contact_distance_m(double robot_radius_m, double clear_m, double person_radius_m) {
  const double clear2_m2 = clear_m * (2 * robot_radius_m + clear_m);
  return clear_m > 0 ? std::sqrt(clear2_m2 * person_radius_m / (person_radius_m + robot_radius_m)) : 0;
}

Visibility::Visibility(const VisibilitySettings& settings) : settings_(settings) {
  if (!(settings.person_radius_m > 0 && std::isfinite(settings.person_radius_m)))
    throw std::invalid_argument("the radius of people must be positive and finite");
  const auto is_error = [](double error) { return error >= 0 && std::isfinite(error); };
  if (!is_error(settings.range_error_m))
    throw std::invalid_argument("the error of ranges must be finite and not negative");
  if (!is_error(settings.position_error_m) || !is_error(settings.heading_error_rad))
    throw std::invalid_argument("the error of a scan's pose must be finite and not negative");
  if (!is_error(settings.min_contact_m))
    throw std::invalid_argument("the minimum contact distance must be finite and not negative");
}

void Visibility::begin(const LaserBeams& beams) {
  at_m_ = beams.at_m();
  rays_.clear();
  double angle_rad = 0;
  for (int beam = 0; beam < beams.count(); angle_rad += beams.gap_rad(beam), ++beam) {
    const double free_m = beams[beam].free_m - settings_.range_error_m;
    if (beams[beam].end != BeamEnd::kUnknown && free_m > 0)
      rays_.push_back({angle_rad, beams[beam].direction, free_m});
  }
  drop_narrow_shadows(rays_, settings_.person_radius_m);
}

void Visibility::set_post(SightRay& ray, const Vec2& post_m) const {
  ray.post_m = post_m - at_m_;
  ray.post_error_m = settings_.position_error_m + settings_.heading_error_rad * ray.post_m->norm();
}

void Visibility::finish() {
  const double radius_m = settings_.person_radius_m;
  seen_.build(rays_, at_m_, radius_m, settings_.min_contact_m);
  drop_rays_within_gaps(rays_, radius_m);
  reach_.build(rays_, at_m_, radius_m, settings_.min_contact_m);
}

}  // namespace sidestep
