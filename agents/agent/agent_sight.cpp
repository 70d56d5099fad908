// SPDX-License-Identifier: Apache-2.0
// What the agent does with the scans of its robot's laser.
#include <algorithm>
#include <array>
#include <limits>

#include "agents/agent/agent.hpp"
#include "common/motion/robot_model.hpp"

namespace sidestep {
namespace {

/// The position of a robot at a time, which may be shortly before its version starts.
Vec2 position_at(const Trajectory& trajectory, Time t) {
  if (t >= trajectory.start()) return trajectory.state_at(t).position_m;
  const State& first = trajectory.at_start();
  return first.position_m - to_seconds(trajectory.start() - t) * first.velocity_mps;
}

}  // namespace

void Agent::on_scan(const LaserScan& scan, Time now) {
  if (!sight_ || scan.captured_at > now + max_clock_difference_) {
    ++future_scans_;
    return;
  }
  seen_robots_.clear();
  for (const Version* version : neighbours_.newest(scan.at_m, page_horizon_m()))
    seen_robots_.push_back({position_at(version->trajectory, scan.captured_at), rules_.radius_m});
  sight_->update(scan, seen_robots_);
}

std::span<const double> Agent::extra_clearances_m() const {
  // The wider a robot passes a corner, the earlier it sees what is behind it.
  if (sight_) return settings_.clearances_in_sight_m;
  return {&settings_.extra_clearance_m, 1};
}

HiddenSpace Agent::hidden_space() const {
  if (!sight_) return {};
  const Visibility& visibility = sight_->visibility();
  HiddenSpace hidden{visibility.frontiers(), visibility.closed_gaps(), sight_->captured_at(),
                     max_person_speed_mps_};
  hidden.heading_error_rad = settings_.max_heading_error_rad;
  hidden.creep_mps = settings_.creep_mps;
  hidden.observed_from_m = sight_->beams().at_m();
  return hidden;
}

AccelerationCommand Agent::follow_in_sight(const Intent& intent, const State& at_start, Time start,
                                           const Route& route, double max_speed_mps,
                                           const HiddenSpace& hidden) {
  constexpr std::array kFractions{1.0, 0.8, 0.6, 0.45, 0.3, 0.2, 0.1, 0.05};
  const double top_mps = std::min(max_speed_mps, rules_.limits.speed_mps);
  AccelerationCommand command;
  for (const double fraction : kFractions) {
    MotionLimits limits = rules_.limits;
    limits.speed_mps = fraction * top_mps;
    command = follow(intent, at_start, route, limits.speed_mps);
    const Vec2 acceleration =
        limit_acceleration(command.acceleration_mps2, at_start.velocity_mps, limits, command.hold);
    const Trajectory trajectory =
        accelerate_then_stop(start, at_start, acceleration, command.hold, rules_.limits.deceleration_mps2);
    const double separation_m = required_separation_m();
    if (!is_passively_safe_from_hidden(trajectory, hidden, separation_m)) continue;
    is_creeping_ = false;
    return command;
  }
  is_creeping_ = true;
  if (!standstill_) standstill_ = {at_start.position_m, start};
  return creep_away(at_start, hidden);
}

AccelerationCommand Agent::creep_away(const State& at_start, const HiddenSpace& hidden) const {
  MotionLimits limits = rules_.limits;
  limits.speed_mps = hidden.creep_mps;
  Vec2 away(0, 0);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Frontier& frontier : hidden.frontiers) {
    const Vec2 at = frontier.segment.from_m + nearest_offset(at_start.position_m, frontier.segment);
    const double distance_m = (at_start.position_m - at).norm() - frontier.bulge_m;
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    away = (at_start.position_m - at).stableNormalized();
  }
  return hold_towards(rules_.radius_m * away, at_start.velocity_mps, limits);
}

void Agent::update_occlusion(const Intent& intent, const State& at_start, const HiddenSpace& hidden,
                             Time now) {
  std::erase_if(occluded_corners_, [&](const OccludedCorner& c) { return now >= c.until; });
  if (!standstill_) return;
  if ((at_start.position_m - standstill_->at_m).norm() > settings_.occluded_range_m) standstill_.reset();
  if (!is_creeping_ || !standstill_ || now - standstill_->since < settings_.occluded_after) return;
  standstill_->since = now;
  const Vec2 ahead =
      at_start.position_m + rules_.radius_m * (intent.waypoint_m - at_start.position_m).stableNormalized();
  const Frontier* nearest = nullptr;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Frontier& frontier : hidden.frontiers) {
    const double distance_m = std::sqrt(squared_distance(ahead, frontier.segment)) - frontier.bulge_m;
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    nearest = &frontier;
  }
  if (!nearest) return;
  const Vec2 corner = nearest->segment.from_m + nearest_offset(ahead, nearest->segment);
  const auto is_of = [&](const Circle& disc) {
    return (disc.centre_m - corner).norm() < disc.radius_m + settings_.corner_slack_m;
  };
  // If a person is in the way, the person will leave.
  const bool is_of_person = std::ranges::any_of(sight_->tracks(), [&](const LaserTrack& track) {
    return is_of({track.position_m, track.radius_m});
  });
  if (is_of_person || std::ranges::any_of(seen_robots_, is_of)) return;
  std::erase_if(occluded_corners_,
                [&](const OccludedCorner& c) { return (c.at_m - corner).norm() < settings_.corner_slack_m; });
  occluded_corners_.push_back({corner, now + settings_.occluded_corner_memory});
  is_route_outdated_ = true;
}

std::vector<TemporaryObstacle> Agent::obstacles_in_sight(const Vec2& target) const {
  std::vector<TemporaryObstacle> found;
  if (!sight_) return found;
  const auto add = [&](const Circle& circle) {
    if (signed_distance(target, Shape(circle)) > required_separation_m()) found.push_back({circle});
  };
  for (const Circle& square : sight_->unknown()) add(square);
  // At this distance the robot can pass slowly.
  const double age_s = to_seconds(2 * scan_period_ + cycle_ * (negotiation_.lead() + 1));
  const double radius_m = max_person_speed_mps_ * age_s;
  for (const OccludedCorner& corner : occluded_corners_) add({corner.at_m, radius_m});
  return found;
}

}  // namespace sidestep
