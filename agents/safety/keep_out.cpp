// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/keep_out.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr double kRounding_m = 1e-9;

/// Whether a candidate enters a zone. Approximates each phase by a chord, with an error of less than 1 mm.
bool touches(const Trajectory& candidate, const Shape& zone, double radius) {
  Time t = candidate.start();
  Vec2 from = candidate.state_at(t).position_m;
  for (const auto& phase : candidate.phases()) {
    t += phase.duration;
    const Vec2 to = candidate.state_at(t).position_m;
    if (squared_distance(Segment{from, to}, zone) <= radius * radius) return true;
    from = to;
  }
  return false;
}

}  // namespace

void KeepOut::find(std::span<const Shape> zones, const Vec2& start, const std::optional<Vec2>& way_out,
                   const Circle& reach, double radius) {
  nearby_.clear();
  way_out_m_ = way_out;
  if (way_out) start_to_way_out_m_ = (*way_out - start).norm();
  radius_m_ = radius;
  start_depth_m_ = 0;
  for (const Shape& zone : zones) {
    if (signed_distance(reach.centre_m, zone) > reach.radius_m + radius) continue;
    nearby_.push_back({&zone, signed_distance(start, zone)});
    start_depth_m_ = std::max(start_depth_m_, radius - nearby_.back().start_distance_m);
  }
}

bool KeepOut::allows(const Trajectory& candidate) const {
  if (way_out_m_ && (*way_out_m_ - candidate.rest_position_m()).norm() < start_to_way_out_m_) return true;
  return std::ranges::all_of(nearby_, [&](const NearbyZone& nearby) {
    if (nearby.start_distance_m > radius_m_) return !touches(candidate, *nearby.zone, radius_m_);
    const double depth_m = radius_m_ - signed_distance(candidate.rest_position_m(), *nearby.zone);
    return depth_m <= start_depth_m_ + kRounding_m;
  });
}

}  // namespace sidestep
