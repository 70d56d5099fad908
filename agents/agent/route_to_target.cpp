// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/route_to_target.hpp"

#include <chrono>
#include <utility>

namespace sidestep {
namespace {

/// A free route is kept for this long after obstacles have changed.
constexpr Duration kMaxRouteAge{200'000'000};

}  // namespace

RouteToTarget::RouteToTarget(NamedPlanner planner, const FloorRules& rules,
                             std::span<const double> extra_clearances_m)
    : planner_(std::move(planner)), rules_(rules), extra_clearances_m_(extra_clearances_m) {}

void RouteToTarget::set_zones(std::span<const Order> zones) {
  zones_ = ZoneMap(zones);
  obstacles_.reset();
  route_planner_.reset();
  has_route_ = false;
}

std::optional<Route> RouteToTarget::find(const Query& query, std::span<const TemporaryObstacle> temporary,
                                         Rng& rng) {
  replan_if_due(query, temporary);
  const Vec2& target = query.target_m;
  const Route straight{target, target, (target - query.start_m).norm(), target};
  const std::optional<Route> found = route_planner_->route_from(query.start_m, rng);
  if (route_planner_->is_searching()) return std::nullopt;
  const Route route = found.value_or(straight);
  length_m_ = route.length_m;
  return route;
}

const RouteObstacles& RouteToTarget::obstacles() {
  if (!obstacles_) obstacles_.emplace(rules_, zones_);
  return *obstacles_;
}

void RouteToTarget::replan_if_due(const Query& query, std::span<const TemporaryObstacle> temporary) {
  if (!route_planner_) {
    obstacles();
    route_planner_.emplace(planner_, obstacles_->world(), rules_.field, rules_.radius_m, rules_.margin_m,
                           extra_clearances_m_);
  }
  is_outdated_ |= obstacles_->set_temporary(temporary);
  const bool is_new = !has_route_ || query.target_m != route_planner_->goal_m();
  const Duration max_age = from_seconds(to_seconds(kMaxRouteAge) * route_planner_->effort());
  const bool is_old = std::chrono::abs(query.now - routed_at_) >= max_age;
  if (is_new || (is_outdated_ && (is_old || !route_planner_->is_free_from(query.robot_m)))) {
    route_planner_->begin(query.target_m);
    routed_at_ = query.now;
    is_outdated_ = false;
  }
  has_route_ = true;
}

Blockage RouteToTarget::blockage() const {
  const std::optional<ObstacleId> obstacle = route_planner_->obstacle_on_goal();
  return obstacle ? obstacles_->blockage(*obstacle) : Blockage{};
}

}  // namespace sidestep
