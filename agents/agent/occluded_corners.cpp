// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/occluded_corners.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sidestep {
namespace {

// A corner that stops the robot for longer than kOccludedAfter is avoided for kOccludedCornerMemory, if the
// robot has not moved farther away in the meantime.
constexpr Duration kOccludedAfter{3'000'000'000}, kOccludedCornerMemory{20'000'000'000};
constexpr double kOccludedRange_m = 0.4;
/// If a person or robot is this near, the robot's stop is not attributed to a corner.
constexpr double kCornerSlack_m = 0.4;

}  // namespace

bool OccludedCorners::update(const Approach& approach, const RobotLaser& laser, Time now) {
  std::erase_if(corners_, [&](const Corner& corner) { return now >= corner.until; });
  if (!measure_standstill(approach, now)) return false;
  const std::optional<Vec2> corner = corner_ahead_m(approach, laser.hidden_space());
  if (!corner || is_body(*corner, laser)) return false;
  std::erase_if(corners_, [&](const Corner& c) { return (c.at_m - *corner).norm() < kCornerSlack_m; });
  corners_.push_back({*corner, now + kOccludedCornerMemory});
  return true;
}

bool OccludedCorners::measure_standstill(const Approach& approach, Time now) {
  if (approach.is_creeping && !standstill_) standstill_ = {approach.at_start.position_m, approach.start};
  if (!standstill_) return false;
  if ((approach.at_start.position_m - standstill_->at_m).norm() > kOccludedRange_m) standstill_.reset();
  if (!approach.is_creeping || !standstill_ || now - standstill_->since < kOccludedAfter) return false;
  standstill_->since = now;
  return true;
}

std::optional<Vec2> OccludedCorners::corner_ahead_m(const Approach& approach,
                                                    const HiddenSpace& hidden) const {
  const Vec2& position = approach.at_start.position_m;
  const Vec2 ahead = position + radius_m_ * (approach.waypoint_m - position).stableNormalized();
  const Frontier* nearest = nullptr;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Frontier& frontier : hidden.frontiers) {
    const double distance_m = std::sqrt(squared_distance(ahead, frontier.segment)) - frontier.bulge_m;
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    nearest = &frontier;
  }
  if (!nearest) return std::nullopt;
  return nearest->segment.from_m + nearest_offset(ahead, nearest->segment);
}

bool OccludedCorners::is_body(const Vec2& corner, const RobotLaser& laser) const {
  const auto is_of = [&](const Circle& disc) {
    return (disc.centre_m - corner).norm() < disc.radius_m + kCornerSlack_m;
  };
  const auto is_at_person = [&](const LaserTrack& track) {
    return is_of({track.position_m, track.radius_m});
  };
  return std::ranges::any_of(laser.sight().tracks(), is_at_person) ||
         std::ranges::any_of(laser.robots(), is_of);
}

void OccludedCorners::restart() {
  standstill_.reset();
  corners_.clear();
}

std::optional<Vec2> OccludedCorners::newest_m() const {
  return corners_.empty() ? std::nullopt : std::optional(corners_.back().at_m);
}

}  // namespace sidestep
