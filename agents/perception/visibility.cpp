// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/visibility.hpp"

#include <stdexcept>

namespace sidestep {
namespace {

/// Larger than the rounding errors of distances within a laser's range.
constexpr double kRounding_m = 1e-9;

/// Throws std::invalid_argument if a number is out of range.
void check(const BrakingQuery& query) {
  const auto is_at_least_0 = [](double x) { return x >= 0 && std::isfinite(x); };
  if (!query.at_m.allFinite() || !(std::abs(query.direction.squaredNorm() - 1) < 1e-6))
    throw std::invalid_argument("a robot's position is not finite, or its direction not a unit vector");
  if (!is_at_least_0(query.radius_m) || !is_at_least_0(query.reaction_s) ||
      !is_at_least_0(query.person_speed_mps) || !is_at_least_0(query.limit_mps))
    throw std::invalid_argument("a radius, speed or reaction time is negative or not finite");
  if (!(query.deceleration_mps2 > 0 && std::isfinite(query.deceleration_mps2)))
    throw std::invalid_argument("the deceleration of a robot is not positive and finite");
}

/// The highest speed, up to `limit_mps`, up to which the robot at rest is farther from the segment than a
/// reach that grows at `growth_mps` while it brakes. See Visibility.
double speed_before(const Segment& segment, double reach_m, double growth_mps, const BrakingQuery& query,
                    double limit_mps) {
  constexpr int kMaxSteps = 100;
  constexpr double kPrecision_mps = 1e-3;
  const double deceleration = query.deceleration_mps2;
  double speed = 0;
  for (int step = 0; step < kMaxSteps; ++step) {
    const double braking_s = speed / deceleration;
    const Vec2 rest = query.at_m + speed * (query.reaction_s + braking_s / 2) * query.direction;
    const double room_m = std::sqrt(squared_distance(rest, segment)) - reach_m - growth_mps * braking_s;
    if (room_m <= 0) return speed;
    // The room shrinks by at most T w + (v w + w² / 2 + growth w) / D while the speed v grows by w.
    const double slope_s = query.reaction_s + (speed + growth_mps) / deceleration;
    const double increase =
        deceleration * (std::sqrt(slope_s * slope_s + 2 * room_m / deceleration) - slope_s);
    speed += increase;
    if (speed >= limit_mps) return limit_mps;
    if (increase < kPrecision_mps) return speed;
  }
  return speed;
}

}  // namespace

Visibility::Visibility(const VisibilitySettings& settings) : settings_(settings) {
  if (!(settings.person_radius_m > 0 && std::isfinite(settings.person_radius_m)))
    throw std::invalid_argument("the radius of people is not positive and finite");
  if (!(settings.range_error_m >= 0 && std::isfinite(settings.range_error_m)))
    throw std::invalid_argument("the error of ranges is negative or not finite");
}

void Visibility::begin(const LaserBeams& beams) {
  at_m_ = beams.at_m();
  captured_at_ = beams.captured_at();
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

double Visibility::max_speed_mps(const BrakingQuery& query) const {
  check(query);
  if (!reach_.contains(query.at_m)) return 0;
  const double age_s = std::abs(to_seconds(query.now - captured_at_));
  const double reach_m = query.radius_m + kRounding_m + query.person_speed_mps * (age_s + query.reaction_s);
  double speed = query.limit_mps;
  for (const Frontier& open : frontiers())
    speed = speed_before(open.segment, reach_m + open.bulge_m, query.person_speed_mps, query, speed);
  for (const Frontier& gap : closed_gaps()) {
    const Vec2 towards = gap.segment.from_m + nearest_offset(query.at_m, gap.segment) - query.at_m;
    const double gap_reach_m = query.radius_m + kRounding_m + gap.bulge_m;
    const bool is_within = towards.squaredNorm() <= gap_reach_m * gap_reach_m;
    if (is_within && towards.dot(query.direction) <= 0) continue;
    speed = speed_before(gap.segment, gap_reach_m, 0, query, speed);
  }
  return speed;
}

}  // namespace sidestep
