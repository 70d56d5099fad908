// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/visibility.hpp"

#include <stdexcept>

namespace sidestep {
Visibility::Visibility(const VisibilitySettings& settings) : settings_(settings) {
  if (!(settings.person_radius_m > 0 && std::isfinite(settings.person_radius_m)))
    throw std::invalid_argument("the radius of people is not positive and finite");
  if (!(settings.range_error_m >= 0 && std::isfinite(settings.range_error_m)))
    throw std::invalid_argument("the error of ranges is negative or not finite");
}

void Visibility::begin(const LaserBeams& beams) {
  at_m_ = beams.at_m();
  rays_.clear();
}

void Visibility::add(const Beam& beam, double angle_rad, bool is_standing) {
  const double free_m = beam.free_m - settings_.range_error_m;
  if (beam.end != BeamEnd::kUnknown && free_m > 0)
    rays_.push_back({angle_rad, beam.direction, free_m, is_standing});
}

void Visibility::finish() {
  const double radius_m = settings_.person_radius_m, error_m = settings_.range_error_m;
  drop_narrow_shadows(rays_, radius_m);
  seen_.build(rays_, at_m_, radius_m, error_m);
  drop_rays_within_gaps(rays_, radius_m, error_m);
  reach_.build(rays_, at_m_, radius_m, error_m);
}

}  // namespace sidestep
