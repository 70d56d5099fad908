// SPDX-License-Identifier: Apache-2.0
// The agent's steering: where to head among robots and obstacles nearby, on the route.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "agents/agent/agent.hpp"
#include "agents/navigation/right_of_way.hpp"
#include "common/map/ray_cast.hpp"

namespace sidestep {
namespace {

/// The state at a time on a robot's trajectory, assuming that it does not brake: the velocity is that at the
/// end of the first phase.
State state_if_continued(const Trajectory& trajectory, Time t) {
  State state = trajectory.state_at(t);
  if (trajectory.phases().empty() || t >= trajectory.end()) return state;
  const Time first_end = trajectory.start() + trajectory.phases().front().duration;
  if (t > first_end) state.velocity_mps = trajectory.state_at(first_end).velocity_mps;
  return state;
}

/// The rest of a version's intent at a time; nullopt if the robot will stay at its goal.
std::optional<Intent> intent_at(const Version& version, Time t, double at_goal_m) {
  if (!version.intent) return std::nullopt;
  const bool is_at_rest = t >= version.trajectory.end();
  if (is_at_rest && (version.trajectory.rest_position_m() - version.intent->goal_m).norm() < at_goal_m)
    return std::nullopt;
  Intent intent = *version.intent;
  intent.velocity_duration_s =
      std::max(0.0, intent.velocity_duration_s - to_seconds(t - version.trajectory.start()));
  return intent;
}

}  // namespace

Intent Agent::steer(const State& at_start, Time start, const Route& route) {
  if (recovery_.is_active()) {
    return {rules_.limits.speed_mps * recovery_direction(at_start.position_m, route),
            settings_.recovery_hold_s, route.waypoint_m, route.end_m};
  }
  Steering& steering = scratch_->steering;
  steering.clear();
  for (const Version* version : neighbours_.newest(at_start.position_m, page_horizon_m())) {
    const State state = state_if_continued(version->trajectory, start);
    const double separation = rules_.min_separation_m() + version->inflation_m;
    const std::optional<Intent> intent = intent_at(*version, start, settings_.neighbour_at_goal_m);
    if (!intent)
      steering.add_stationary(state.position_m, separation);
    else if (has_right_of_way(version->robot, robot_.id, start, settings_.right_of_way_period))
      steering.add_moving(state, *intent, separation);
  }
  for (const Shape& obstacle : rules_.obstacles) {
    const Circle disc = disc_facing(at_start.position_m, obstacle);
    const bool is_far = (disc.centre_m - at_start.position_m).norm() > page_horizon_m();
    if (disc.radius_m > 0 || !is_far)
      steering.add_stationary(disc.centre_m, disc.radius_m + required_separation_m());
  }
  if (rules_.map) add_walls(at_start.position_m);
  for (const Circle& zone : zones_.seen_from(at_start.position_m))
    steering.add_stationary(zone.centre_m, zone.radius_m + required_separation_m());
  const double elapsed_s = std::max(0.0, to_seconds(start - last_steered_start_));
  last_steered_start_ = start;
  // On an open floor, the rest of the way is equally short from anywhere. With a map, walls may be in
  // between.
  const bool is_open = !rules_.map && std::ranges::all_of(rules_.obstacles, [](const Shape& obstacle) {
    return std::holds_alternative<Circle>(obstacle);
  });
  return steering.choose(at_start, route.waypoint_m, is_open ? route.end_m : route.following_m, elapsed_s,
                         last_choice_);
}

Intent Agent::steer_locally(const State& at_start, Time start, Route route) {
  preferred_mps_.clear();
  const std::span<const Vec2> path = route_planner_->remaining_waypoints_m();
  if (route.is_way_out || path.empty() || path.front() != route.waypoint_m || recovery_.is_active())
    return steer(at_start, start, route);
  if (!local_driver_)
    local_driver_.emplace(*planner_.local, rules_.field, rules_.radius_m, required_separation_m(),
                          rules_.limits);
  bodies_nearby_.clear();
  for (const Version* version : neighbours_.newest(at_start.position_m, page_horizon_m()))
    bodies_nearby_.push_back(
        {state_if_continued(version->trajectory, start).position_m, rules_.radius_m + version->inflation_m});
  const LocalChoice choice = local_driver_->choose(
      {at_start, path, &route_obstacles_->world(), bodies_nearby_, to_seconds(max_hold())});
  route.waypoint_m = choice.target_m;
  if (!choice.velocity_mps) return steer(at_start, start, route);
  preferred_mps_.assign(choice.preferred_mps.begin(), choice.preferred_mps.end());
  return {*choice.velocity_mps, settings_.recovery_hold_s, choice.target_m, route.end_m};
}

std::span<const Vec2> Agent::preferred_accelerations(const Vec2& velocity_mps, Duration hold) {
  preferred_mps2_.clear();
  for (const Vec2& preferred : preferred_mps_)
    preferred_mps2_.emplace_back((preferred - velocity_mps) / to_seconds(hold));
  return preferred_mps2_;
}

void Agent::add_walls(const Vec2& position_m) {
  constexpr int kDirections = 32;
  Steering& steering = scratch_->steering;
  const double horizon_m = page_horizon_m();
  if (const auto nearest = rules_.map->disc_facing(position_m, required_separation_m()))
    steering.add_stationary(nearest->centre_m, nearest->radius_m + required_separation_m());
  for (int i = 0; i < kDirections; ++i) {
    const double angle_rad = i * 2 * std::numbers::pi / kDirections;
    const Vec2 direction(std::cos(angle_rad), std::sin(angle_rad));
    const double distance_m =
        cast_ray(rules_.map->cells(), rules_.map->field(), position_m, direction, horizon_m);
    if (std::isfinite(distance_m))
      steering.add_stationary(position_m + distance_m * direction, required_separation_m());
  }
}

Vec2 Agent::recovery_direction(const Vec2& position, const Route& route) const {
  const Vec2 straight = (route.waypoint_m - position).stableNormalized();
  const double length = std::min(route.length_m, settings_.recovery_clear_path_m);
  for (const double fraction : {1.0, 0.75, 0.5, 0.25}) {
    const Vec2 direction = rotated(straight, -fraction * recovery_.angle_rad());
    const Vec2 end = position + length * direction;
    if (rules_.field.contains(end, rules_.radius_m) && route_planner_->is_line_free(position, end))
      return direction;
  }
  return straight;
}

}  // namespace sidestep
