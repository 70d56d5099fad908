// SPDX-License-Identifier: Apache-2.0
// The agent's routes: what they lead around, and what prevents the robot from reaching its goal.
#include <algorithm>
#include <cmath>
#include <utility>

#include "agents/agent/agent.hpp"

namespace sidestep {

std::vector<Circle> Agent::moving_obstacles(const Vec2& target, Time now) {
  const Vec2& position = estimate_.position_m;
  const double grid_m = settings_.moving_grid_m;
  std::vector<Circle> found;
  const auto add = [&](const MovingObstacle& obstacle) {
    if ((obstacle.position_m - position).norm() > settings_.moving_range_m) return;
    const Vec2 centre = (obstacle.position_m / grid_m).array().round().matrix() * grid_m;
    const double radius = std::round(obstacle.radius_m / grid_m) * grid_m;
    // The inflated circle must not cover the target.
    const double max_inflation =
        (centre - target).norm() - radius - planning_separation_m() - settings_.at_goal_m;
    const double inflation = grid_m + obstacle.speed_mps * to_seconds(settings_.moving_horizon);
    found.push_back({centre, radius + std::clamp(max_inflation, 0.0, inflation)});
  };
  if (sight_) {
    // Routes keep a large distance from walls in order to see around corners early, but this is not needed
    // near people. If people are in the way, the robot waits rather than squeezing past along a wall.
    const double less_m = settings_.clearances_in_sight_m.front() - settings_.extra_clearance_m;
    for (const LaserTrack& track : sight_->tracks())
      add({track.position_m, std::max(0.05, track.radius_m - less_m), track.seen_at, 0});
  } else {
    for (const MovingObstacle& obstacle : obstacles_.recent(now)) add(obstacle);
  }
  for (const UncontrolledBody& body : displaced_.recent(now)) add(body.reach);
  std::ranges::sort(found, {}, [&](const Circle& c) { return (c.centre_m - position).squaredNorm(); });
  if (found.size() > settings_.max_moving) found.resize(settings_.max_moving);
  std::ranges::sort(found, {}, [](const Circle& c) { return std::pair(c.centre_m.x(), c.centre_m.y()); });
  return found;
}

bool Agent::is_to_stay(const Neighbours::Stationary& other) const {
  const OtherAssignment orders = assignment_.other(other.robot);
  if (orders.is_held || !orders.has_to_go) return true;
  // The other robot waits as near to its goal as it can get. But if this robot is what blocks it, one of the
  // two must move.
  const bool waits =
      other.intent && (other.position_m - other.intent->goal_m).norm() < settings_.neighbour_at_goal_m;
  return waits && orders.goal_m &&
         (estimate_.position_m - *orders.goal_m).norm() > rules_.radius_m + planning_separation_m();
}

std::vector<TemporaryObstacle> Agent::temporary_obstacles(const Vec2& target, Time now) {
  std::vector<TemporaryObstacle> found = obstacles_in_sight(target);
  for (const Circle& circle : moving_obstacles(target, now)) found.push_back({circle});
  for (const Neighbours::Stationary& other : neighbours_.find_stationary(
           now - settings_.stationary_after, estimate_.position_m, settings_.max_stationary)) {
    // A robot that stands on the target but is going to leave is no reason to go elsewhere.
    const bool covers = (other.position_m - target).norm() <= rules_.radius_m + required_separation_m();
    if (!covers || is_to_stay(other)) found.push_back({{other.position_m, rules_.radius_m}, other.robot});
  }
  return found;
}

void Agent::update_route_planner(const Vec2& target, Time now) {
  if (!route_planner_) {
    route_obstacles_.emplace(rules_, zones_);
    route_planner_.emplace(planner_, route_obstacles_->world(), rules_.field, rules_.radius_m,
                           rules_.margin_m, extra_clearances_m());
  }
  is_route_outdated_ |= route_obstacles_->set_temporary(temporary_obstacles(target, now));
  const bool is_new = !has_route_ || target != route_planner_->goal_m();
  // A route that is still free is kept for a while, even if there might be a shorter one.
  const Duration max_age = from_seconds(to_seconds(settings_.max_route_age) * route_planner_->effort());
  const bool is_old = std::chrono::abs(now - routed_at_) >= max_age;
  if (is_new || (is_route_outdated_ && (is_old || !route_planner_->is_free_from(estimate_.position_m)))) {
    route_planner_->begin(target);
    routed_at_ = now;
    is_route_outdated_ = false;
  }
  has_route_ = true;
}

void Agent::update_blockage(const Route& route, Time now) {
  if (route.reaches_goal) {
    blockage_.reset();
    blocked_since_.reset();
    return;
  }
  const std::optional<ObstacleId> obstacle = route_planner_->obstacle_on_goal();
  blockage_ = obstacle ? route_obstacles_->blockage(*obstacle) : Blockage{};
  if (!occluded_corners_.empty())
    blockage_ = Blockage{msg::BlockReason::BLOCK_OCCLUDED_CORNER, 0, occluded_corners_.back().at_m};
  blockage_->nearest_m = route.end_m;
  if (!blocked_since_) blocked_since_ = now;
}

}  // namespace sidestep
