// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/intent_planner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "agents/agent/planning_distances.hpp"
#include "agents/navigation/right_of_way.hpp"
#include "agents/navigation/trapezoidal_profile.hpp"
#include "common/map/ray_cast.hpp"

namespace sidestep {
namespace {

/// A robot whose intended speed is below this fraction of the limit counts as waiting.
constexpr double kWaitingSpeedFraction = 0.5;
constexpr double kRecoveryClearPath_m = 0.5;  ///< length of free path that a recovery direction requires
constexpr double kRecoveryHold_s = 0.3;       ///< how long the velocity of a recovery is held

/// The state at a time on a robot's trajectory, assuming that it does not brake: it keeps the velocity at the
/// end of the first phase.
State state_if_continued(const Trajectory& trajectory, Time t) {
  State state = trajectory.state_at(t);
  if (trajectory.phases().empty() || t >= trajectory.end()) return state;
  const Time first_end = trajectory.start() + trajectory.phases().front().duration;
  if (t > first_end) state.velocity_mps = trajectory.state_at(first_end).velocity_mps;
  return state;
}

/// The part of a version's intent that remains at a time; nullopt if the robot will stay at its goal.
std::optional<Intent> intent_at(const Version& version, Time t) {
  if (!version.intent) return std::nullopt;
  const bool is_at_rest = t >= version.trajectory.end();
  if (is_at_rest &&
      (version.trajectory.rest_position_m() - version.intent->goal_m).norm() < kNeighbourAtGoal_m)
    return std::nullopt;
  Intent intent = *version.intent;
  intent.velocity_duration_s =
      std::max(0.0, intent.velocity_duration_s - to_seconds(t - version.trajectory.start()));
  return intent;
}

}  // namespace

IntentPlanner::IntentPlanner(RobotId robot, const std::optional<LocalMethods>& local, const FloorRules& rules,
                             Steering& steering)
    : robot_(robot), local_(local), rules_(rules), steering_(steering) {}

Intent IntentPlanner::choose(const Query& query, const RouteToTarget& routes, Neighbours& neighbours) {
  const Time due_at = due(query);
  Intent intent = local_ ? steer_locally(query, routes, neighbours) : steer(query, routes, neighbours);
  intent.due = due_at;
  return intent;
}

Time IntentPlanner::due(const Query& query) {
  if (!due_ || query.start - *due_ > kMaxOverdue)
    due_ = query.start + from_seconds(TrapezoidalProfile::duration_s(query.route.length_m, 0, rules_.limits));
  return *due_;
}

Intent IntentPlanner::steer(const Query& query, const RouteToTarget& routes, Neighbours& neighbours) {
  const Route& route = query.route;
  if (recovery_.is_active()) {
    return {rules_.limits.speed_mps * recovery_direction(query, routes), kRecoveryHold_s, route.waypoint_m,
            route.end_m};
  }
  steering_.clear();
  add_robots(query, neighbours);
  add_obstacles(query.at_start.position_m, routes.zones());
  const double elapsed_s = std::max(0.0, to_seconds(query.start - last_steered_start_));
  last_steered_start_ = query.start;
  // On an open floor the robot can head straight for the end of its route from anywhere. With a map, walls
  // may be in between.
  const bool is_open = !rules_.map && std::ranges::all_of(rules_.obstacles, [](const Shape& obstacle) {
    return std::holds_alternative<Circle>(obstacle);
  });
  return steering_.choose(query.at_start, route.waypoint_m, is_open ? route.end_m : route.next_waypoint_m,
                          elapsed_s, last_choice_);
}

void IntentPlanner::add_robots(const Query& query, Neighbours& neighbours) {
  const double horizon_m = page_horizon_m(rules_);
  for (const Version* version : neighbours.newest(query.at_start.position_m, horizon_m)) {
    const State state = state_if_continued(version->trajectory, query.start);
    const double separation = rules_.min_separation_m() + version->inflation_m;
    const std::optional<Intent> intent = intent_at(*version, query.start);
    if (!intent)
      steering_.add_stationary(state.position_m, separation);
    else if (goes_first({version->robot, intent->due}, {robot_, *due_}))
      steering_.add_moving(state, *intent, separation);
  }
}

void IntentPlanner::add_obstacles(const Vec2& position, const ZoneMap& zones) {
  const double separation_m = required_separation_m(rules_);
  for (const Shape& obstacle : rules_.obstacles) {
    const Circle disc = disc_facing(position, obstacle);
    const bool is_far = (disc.centre_m - position).norm() > page_horizon_m(rules_);
    if (disc.radius_m > 0 || !is_far) steering_.add_stationary(disc.centre_m, disc.radius_m + separation_m);
  }
  if (rules_.map) add_walls(position);
  for (const Circle& zone : zones.seen_from(position))
    steering_.add_stationary(zone.centre_m, zone.radius_m + separation_m);
}

void IntentPlanner::add_walls(const Vec2& position_m) {
  constexpr int kDirections = 32;
  const double horizon_m = page_horizon_m(rules_), separation_m = required_separation_m(rules_);
  if (const auto nearest = rules_.map->disc_facing(position_m, separation_m))
    steering_.add_stationary(nearest->centre_m, nearest->radius_m + separation_m);
  for (int i = 0; i < kDirections; ++i) {
    const double angle_rad = i * 2 * std::numbers::pi / kDirections;
    const Vec2 direction(std::cos(angle_rad), std::sin(angle_rad));
    const double distance_m =
        cast_ray(rules_.map->cells(), rules_.map->field(), position_m, direction, horizon_m);
    if (std::isfinite(distance_m))
      steering_.add_stationary(position_m + distance_m * direction, separation_m);
  }
}

Intent IntentPlanner::steer_locally(Query query, const RouteToTarget& routes, Neighbours& neighbours) {
  Route& route = query.route;
  preferred_mps_.clear();
  const std::span<const Vec2> path = routes.remaining_waypoints_m();
  if (route.is_way_out || path.empty() || path.front() != route.waypoint_m || recovery_.is_active())
    return steer(query, routes, neighbours);
  if (!local_driver_)
    local_driver_.emplace(*local_, rules_.field, rules_.radius_m, required_separation_m(rules_),
                          rules_.limits);
  bodies_nearby_.clear();
  for (const Version* version : neighbours.newest(query.at_start.position_m, page_horizon_m(rules_)))
    bodies_nearby_.push_back({state_if_continued(version->trajectory, query.start).position_m,
                              rules_.radius_m + version->inflation_m});
  const LocalChoice choice = local_driver_->choose(
      {query.at_start, path, &routes.known_obstacles()->world(), bodies_nearby_, to_seconds(query.max_hold)});
  route.waypoint_m = choice.target_m;
  if (!choice.velocity_mps) return steer(query, routes, neighbours);
  preferred_mps_.assign(choice.preferred_mps.begin(), choice.preferred_mps.end());
  return {*choice.velocity_mps, kRecoveryHold_s, choice.target_m, route.end_m};
}

std::span<const Vec2> IntentPlanner::preferred_accelerations(const Vec2& velocity_mps, Duration hold) {
  preferred_mps2_.clear();
  for (const Vec2& preferred : preferred_mps_)
    preferred_mps2_.emplace_back((preferred - velocity_mps) / to_seconds(hold));
  return preferred_mps2_;
}

void IntentPlanner::on_search(const Intent& intent, bool desired_is_clear, double speed_mps, Time now) {
  const bool is_waiting = intent.velocity_duration_s > 0 &&
                          intent.velocity_mps.norm() < kWaitingSpeedFraction * rules_.limits.speed_mps;
  recovery_.update(desired_is_clear && !is_waiting, speed_mps, now);
}

Vec2 IntentPlanner::recovery_direction(const Query& query, const RouteToTarget& routes) const {
  const Vec2& position = query.at_start.position_m;
  const Vec2 straight = (query.route.waypoint_m - position).stableNormalized();
  const double length = std::min(query.route.length_m, kRecoveryClearPath_m);
  for (const double fraction : {1.0, 0.75, 0.5, 0.25}) {
    const Vec2 direction = rotated(straight, -fraction * recovery_.angle_rad());
    const Vec2 end = position + length * direction;
    if (rules_.field.contains(end, rules_.radius_m) && routes.is_line_free(position, end)) return direction;
  }
  return straight;
}

}  // namespace sidestep
