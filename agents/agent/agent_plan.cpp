// SPDX-License-Identifier: Apache-2.0
// The agent's planning: from the route to the goal to a proposal.
#include <algorithm>
#include <cmath>
#include <limits>

#include "agents/agent/agent.hpp"
#include "agents/navigation/right_of_way.hpp"

namespace sidestep {

double Agent::search_horizon_m() const {
  const double speed = rules_.limits.speed_mps;
  return 2 * speed * (settings_.max_speed_hold_s + speed / (2 * rules_.limits.deceleration_mps2)) +
         rules_.min_separation_m();
}

double Agent::page_horizon_m() const {
  return search_horizon_m() + 2 * rules_.limits.speed_mps * settings_.max_page_age_s;
}

double Agent::planning_separation_m() const {
  return rules_.radius_m + rules_.margin_m + settings_.extra_clearance_m;
}

WaitReason Agent::wait_reason(Time now) const {
  // A time far in the future means that a clock has been set.
  const auto is_recent = [&](Time t, Duration max_age) { return std::chrono::abs(now - t) <= max_age; };
  if (const WaitReason reason = negotiation_.wait_reason(now); reason != WaitReason::kNone) return reason;
  if (negotiation_.is_absent()) return WaitReason::kNone;
  if (!assignment_.is_known()) return WaitReason::kOrdersUnknown;
  if (assignment_.is_held()) return WaitReason::kHeld;
  if (!assignment_.goal() && !zones_.is_kept_out(estimate_.position_m, required_separation_m()))
    return WaitReason::kNoOrder;
  if (!is_recent(last_fix_, settings_.max_fix_age)) return WaitReason::kNotSeen;
  if (sight_ && !is_recent(sight_->captured_at(), settings_.max_fix_age)) return WaitReason::kNoScan;
  if (!sight_ && !is_recent(obstacles_.complete_at(), settings_.max_fix_age))
    return WaitReason::kNoObstacleList;
  if (!is_recent(watched_until_, settings_.max_watch_age)) return WaitReason::kNotWatched;
  return WaitReason::kNone;
}

std::optional<MotionPlan> Agent::plan(Time now, Time start, double max_speed_mps, Duration max_lag) {
  if (wait_reason(now) != WaitReason::kNone || negotiation_.is_absent()) return std::nullopt;
  if (now < last_plan_) restart_timers(now);
  last_plan_ = now;
  const Version& base = negotiation_.base_at(start);
  const Vec2 rest = base.trajectory.rest_position_m();
  decide_whether_to_give_way(now);
  const bool gives_way = give_way_.place_m().has_value();
  const Vec2 target = give_way_.place_m().value_or(target_m(rest));
  // Inflation ends only when the robot is at rest. If it drove on with inflation, it might never fit where it
  // has to go.
  if (base.inflation_m > 0 && !may_end_inflation(base, start)) return std::nullopt;
  const auto ends_at = [&](const Vec2& place) {
    return (rest - place).norm() < settings_.at_goal_m && base.inflation_m == 0;
  };
  if (start <= base.trajectory.start()) return std::nullopt;
  if (ends_at(target) && !zones_.is_kept_out(target, required_separation_m())) {
    if (!gives_way) update_blockage({}, now);
    route_length_m_ = 0;
    return std::nullopt;
  }
  const State at_start = base.trajectory.state_at(start);
  update_route_planner(target, now);
  const Route straight{target, target, (target - at_start.position_m).norm(), target};
  const std::optional<Route> found = route_planner_->route_from(at_start.position_m, rng_);
  if (route_planner_->is_searching()) return std::nullopt;
  const Route route = found.value_or(straight);
  route_length_m_ = route.length_m;
  if (!gives_way) update_blockage(route, now);
  const bool leads_to_goal = !gives_way && route.reaches_goal;
  remaining_to_goal_m_ = leads_to_goal ? route.length_m : std::numeric_limits<double>::infinity();
  if (!route.reaches_goal && ends_at(route.end_m)) return std::nullopt;
  if (assignment_.goal() && goal().speed_limit_mps)
    max_speed_mps = std::min(max_speed_mps, *goal().speed_limit_mps);
  max_speed_mps =
      std::min(max_speed_mps, zones_.max_speed_mps(at_start.position_m, at_start.velocity_mps.norm(),
                                                   rules_.radius_m, max_hold() + cycle_, rules_.limits));
  Intent intent = planner_.local ? steer_locally(at_start, start, route) : steer(at_start, start, route);
  intent.target_m = target;
  const HiddenSpace hidden = hidden_space();
  if (sight_ && !sight_->visibility().is_before_frontiers(at_start.position_m)) return std::nullopt;
  const AccelerationCommand desired =
      sight_ ? follow_in_sight(intent, at_start, start, route, max_speed_mps, hidden)
             : follow(intent, at_start, route, max_speed_mps);
  if (sight_) update_occlusion(intent, at_start, hidden, now);
  SearchQuery query{start, at_start, desired.acceleration_mps2, desired.hold};
  if (sight_) {
    query.hidden = hidden;
  } else {
    query.moving = obstacles_.recent(now, max_lag);
    query.seen = obstacles_.seen(now, max_lag);
  }
  query.uncontrolled = displaced_.recent(now, max_lag);
  query.stop = &base.trajectory;
  query.max_speed_mps = is_creeping_ ? std::min(max_speed_mps, hidden.creep_mps) : max_speed_mps;
  query.keep_outs = zones_.keep_outs();
  query.preferred_mps2 = preferred_accelerations(at_start.velocity_mps, desired.hold);
  if (route.is_way_out) query.way_out_m = route.end_m;
  return MotionPlan{query, base.number, intent};
}

void Agent::restart_timers(Time now) {
  give_way_.restart(now);
  blocked_since_.reset();
  standstill_.reset();
  occluded_corners_.clear();
}

void Agent::decide_whether_to_give_way(Time now) {
  if (!assignment_.goal() || assignment_.report().progress.is_finished()) return give_way_.restart(now);
  const double remaining_m = has_route_ ? remaining_to_goal_m_ : std::numeric_limits<double>::infinity();
  if (!give_way_.is_due(now, remaining_m) || !route_obstacles_) return;
  if (give_way_.is_searching()) return give_way_.search(now, rng_);
  give_way_.begin_search(now, estimate_.position_m, others_in_passages(now), route_obstacles_->fixed_world());
}

std::vector<OtherRobot> Agent::others_in_passages(Time now) {
  std::vector<OtherRobot> others;
  for (const Version* version : neighbours_.newest(estimate_.position_m, page_horizon_m())) {
    OtherRobot other{version->robot, true, version->trajectory.rest_position_m()};
    const OtherAssignment orders = assignment_.other(version->robot);
    if (version->intent && !orders.is_held) {
      other.goals_m = {version->intent->goal_m, version->intent->target_m};
      // A route across a large floor would take too long to plan.
      for (std::optional<Vec2>& goal : other.goals_m)
        if ((*goal - other.position_m).norm() > settings_.longest_trip_m) goal = version->intent->waypoint_m;
      other.has_right_of_way = assignment_.yields_to({version->robot, orders.number}, now, passage_period_);
    }
    others.push_back(other);
  }
  for (const RobotId robot : give_way_.yields_to()) {
    const OtherAssignment orders = assignment_.other(robot);
    const bool is_near = std::ranges::any_of(others, [=](const auto& other) { return other.id == robot; });
    if (!is_near && orders.has_to_go && !orders.is_held) others.push_back({robot, false});
  }
  return others;
}

AccelerationCommand Agent::follow(const Intent& intent, const State& at_start, const Route& route,
                                  double max_speed_mps) const {
  // If the robot is not observed again, it comes to rest before its drift exceeds the tracking bound.
  const double dead_reckoning_m =
      std::max(0.0, max_dead_reckoning_m_ - (at_start.position_m - estimate_.position_m).norm());
  const double length = std::min(route.length_m, dead_reckoning_m);
  MotionLimits limits = rules_.limits;
  Vec2 displacement = length * (intent.waypoint_m - at_start.position_m).stableNormalized();
  if (intent.velocity_duration_s > 0) {
    const double speed = intent.velocity_mps.norm();
    const bool is_standstill = speed < settings_.standstill_mps;
    displacement = is_standstill ? Vec2::Zero() : Vec2(length / speed * intent.velocity_mps);
    if (!is_standstill) limits.speed_mps = speed;
  }
  limits.speed_mps = std::min(limits.speed_mps, max_speed_mps);
  return hold_towards(displacement, at_start.velocity_mps, limits);
}

AccelerationCommand Agent::hold_towards(const Vec2& displacement_m, const Vec2& velocity_mps,
                                        const MotionLimits& limits) const {
  return desired_acceleration(displacement_m, velocity_mps, limits, min_hold(), max_hold());
}

bool Agent::may_end_inflation(const Version& base, Time start) const {
  const bool is_at_rest = start >= base.trajectory.end();
  const bool was_observed_at_rest = last_fix_ > base.trajectory.end();
  // The robot may not have received the observation yet.
  const bool agrees = (last_fix_m_ - estimate_.position_m).norm() <= drift_bound_m_;
  return is_at_rest && was_observed_at_rest && agrees;
}

std::optional<Proposal> Agent::search(const MotionPlan& plan, Time now) {
  const SearchQuery& query = plan.query;
  TrajectoryIndex& others = scratch_->others;
  neighbours_.collect(query.at_start.position_m, search_horizon_m(), others);
  SearchResult result = scratch_->safety_search.search(query, others, rng_);
  const bool is_blocked = result.count == 0;
  if (is_blocked) result = search_escape(query, negotiation_.base_at(query.start), others, rules_);
  is_escaping_ = is_blocked && result.count > 0;
  const bool is_waiting =
      plan.intent.velocity_duration_s > 0 &&
      plan.intent.velocity_mps.norm() < settings_.waiting_speed_fraction * rules_.limits.speed_mps;
  recovery_.update(result.desired_is_clear && !is_waiting, query.at_start.velocity_mps.norm(), now);
  if (result.count == 0) return std::nullopt;
  return negotiation_.propose({result.candidates.data(), result.count}, plan.base, now, plan.intent);
}

}  // namespace sidestep
