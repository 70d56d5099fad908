// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/motion_planner.hpp"

#include <algorithm>

#include "agents/agent/planning_distances.hpp"
#include "agents/agent/sight_motion.hpp"
#include "agents/navigation/trapezoidal_profile.hpp"
#include "agents/safety/creeping.hpp"

namespace sidestep {
namespace {

/// Minimum time for which an acceleration is held, even if cycles are shorter. Motors take about 10 ms to
/// reach an acceleration, so robots would deviate from versions that soon brake again.
constexpr Duration kMinHold{16'000'000};
/// A goal that is unreachable for longer than this is reported as blocked.
constexpr Duration kBlockedAfter{300'000'000};
constexpr double kStandstill_mps = 0.01;  ///< intended speeds below this count as being at rest

std::span<const double> extra_clearances_m(const FloorSpec& floor) {
  if (floor.laser) return kClearancesInSight_m;
  return {&kExtraClearance_m, 1};
}

NamedPlanner planner_of(const FloorSpec& floor, const RobotSpec& robot) {
  return make_driving_planner(robot.planner.empty() ? floor.planner : robot.planner);
}

/// Whether a robot that executes the version stays at the place.
bool will_rest_at(const Version& base, const Vec2& place_m) {
  return (base.trajectory.rest_position_m() - place_m).norm() < kAtGoal_m && base.inflation_m == 0;
}

}  // namespace

MotionPlanner::MotionPlanner(const FloorSpec& floor, const RobotSpec& robot, PlanningScratch& scratch)
    : rules_(scratch.rules),
      cycle_(floor.cycle),
      surroundings_(rules_),
      route_(planner_of(floor, robot), rules_, extra_clearances_m(floor)),
      blockage_(kBlockedAfter),
      passage_(rules_),
      corners_(rules_.radius_m),
      intents_(robot.id, route_.local_methods(), rules_, scratch.steering) {}

std::optional<MotionPlan> MotionPlanner::plan(const Query& query) {
  const Version& base = query.base;
  if (query.now < last_plan_) restart_timers(query.now);
  last_plan_ = query.now;
  passage_.update(query.now, query.observations, query.assignment, route_, query.rng);
  // Inflation ends only when the robot is at rest. If the robot drove on with inflation, it might never fit
  // through narrow places.
  if (base.inflation_m > 0 || query.start <= base.trajectory.start()) return std::nullopt;
  const Vec2 target = target_m(query);
  const std::optional<Route> route = find_route(query, target);
  if (!route) return std::nullopt;
  const State at_start = base.trajectory.state_at(query.start);
  Intent intent = intents_.choose({at_start, query.start, *route, hold_bounds(query.lead).max}, route_,
                                  query.observations.neighbours());
  intent.target_m = target;
  return follow_intent(query, intent, at_start, *route);
}

void MotionPlanner::restart_timers(Time now) {
  passage_.restart(now);
  blockage_.restart();
  corners_.restart();
  intents_.on_new_goal();
}

Vec2 MotionPlanner::target_m(const Query& query) const {
  if (const std::optional<Vec2> place = passage_.place_m()) return *place;
  const Goal* goal = query.assignment.goal();
  return goal ? goal->position_m : query.base.trajectory.rest_position_m();
}

std::optional<Route> MotionPlanner::find_route(const Query& query, const Vec2& target) {
  const bool gives_way = passage_.place_m().has_value();
  if (will_rest_at(query.base, target) && !is_kept_out(target)) {
    if (!gives_way) blockage_.clear();
    route_.on_arrival();
    return std::nullopt;
  }
  const std::vector<TemporaryObstacle> temporary = surroundings_.find(
      target, query.now, query.observations, query.assignment, corners_, cycle_ * (query.lead + 1));
  const std::optional<Route> route =
      route_.find({target, query.base.trajectory.state_at(query.start).position_m,
                   query.observations.own().estimate().position_m, query.now},
                  temporary, query.rng);
  if (!route) return std::nullopt;
  if (!gives_way)
    update_blockage(*route, query.now);
  else if (const std::optional<Blockage> other = passage_.blockage())
    blockage_.on_blocked(*other, query.now);
  passage_.on_route(*route);
  const bool is_as_near_as_possible = !route->reaches_goal && will_rest_at(query.base, route->end_m);
  return is_as_near_as_possible ? std::nullopt : route;
}

void MotionPlanner::update_blockage(const Route& route, Time now) {
  if (route.reaches_goal) return blockage_.clear();
  Blockage blockage = route_.blockage();
  if (const std::optional<Vec2> corner = corners_.newest_m())
    blockage = {msg::BlockReason::BLOCK_OCCLUDED_CORNER, 0, *corner};
  blockage.nearest_m = route.end_m;
  blockage_.on_blocked(blockage, now);
}

double MotionPlanner::max_speed_mps(const Query& query, const State& at_start) const {
  double limit_mps = query.max_speed_mps;
  const Goal* goal = query.assignment.goal();
  if (goal && goal->speed_limit_mps) limit_mps = std::min(limit_mps, *goal->speed_limit_mps);
  const Duration reaction = hold_bounds(query.lead).max + cycle_;
  return std::min(limit_mps, route_.zones().max_speed_mps(at_start.position_m, at_start.velocity_mps.norm(),
                                                          rules_.radius_m, reaction, rules_.limits));
}

HoldBounds MotionPlanner::hold_bounds(int lead) const {
  const Duration min = std::max(cycle_, kMinHold);
  return {min, std::max(min, cycle_ * lead)};
}

std::optional<MotionPlan> MotionPlanner::follow_intent(const Query& query, const Intent& intent,
                                                       const State& at_start, const Route& route) {
  Observations& seen = query.observations;
  const RobotLaser* laser = seen.laser();
  if (laser && !laser->sight().visibility().is_enclosed_by_frontiers(at_start.position_m))
    return std::nullopt;
  const double max_speed = max_speed_mps(query, at_start);
  const double dead_reckoning_m = seen.own().dead_reckoning_m(at_start.position_m);
  const double length_m = std::min(route.length_m, dead_reckoning_m);
  const IntentToFollow followed{intent,        at_start,        length_m,
                                rules_.limits, kStandstill_mps, hold_bounds(query.lead)};
  SearchQuery search{query.start, at_start};
  search.max_speed_mps = max_speed;
  AccelerationCommand desired;
  if (laser) {
    search.hidden = laser->hidden_space();
    const SightMotion motion = follow_in_sight(followed, query.start, max_speed, search.hidden, rules_);
    desired = motion.command;
    if (motion.is_creeping) search.max_speed_mps = std::min(max_speed, search.hidden.creep_mps);
    update_corners({at_start, query.start, intent.waypoint_m, motion.is_creeping}, *laser, query.now);
  } else {
    desired = follow(followed, max_speed);
    search.creep_mps = kCreep_mps;
    search.moving = seen.obstacles().recent(query.now, query.max_lag);
    search.seen = seen.obstacles().seen(query.now, query.max_lag);
  }
  search.desired_mps2 = desired.acceleration_mps2;
  search.hold_time = desired.hold;
  search.uncontrolled = seen.displaced().recent(query.now, query.max_lag);
  search.stop = &query.base.trajectory;
  search.keep_outs = route_.zones().keep_outs();
  search.preferred_mps2 = intents_.preferred_accelerations(at_start.velocity_mps, desired.hold);
  if (route.is_way_out) search.way_out_m = route.end_m;
  return MotionPlan{search, query.base.number, intent};
}

void MotionPlanner::update_corners(const OccludedCorners::Approach& approach, const RobotLaser& laser,
                                   Time now) {
  if (corners_.update(approach, laser, now)) route_.mark_outdated();
}

void MotionPlanner::on_search(const MotionPlan& plan, bool desired_is_clear, Time now) {
  intents_.on_search(plan.intent, desired_is_clear, plan.query.at_start.velocity_mps.norm(), now);
}

void MotionPlanner::on_new_goal() {
  route_.forget();
  intents_.on_new_goal();
  blockage_.clear();
  passage_.restart(last_plan_);
}

void MotionPlanner::set_zones(std::span<const Order> zones) {
  route_.set_zones(zones);
  passage_.restart(last_plan_);
}

bool MotionPlanner::is_kept_out(const Vec2& position_m) const {
  return route_.zones().is_kept_out(position_m, required_separation_m(rules_));
}

std::optional<double> MotionPlanner::remaining_s(const Assignment& assignment, bool has_arrived) const {
  const Goal* first = assignment.goal();
  if (!first || blockage_.is_blocked() || passage_.place_m() || (!route_.has_route() && !has_arrived))
    return std::nullopt;
  if (assignment.report().progress.is_finished()) return 0;
  double length_m = route_.length_m(), seconds = 0;
  Vec2 from = first->position_m;
  for (const Goal& goal : assignment.goals_left()) {
    if (&goal != first) length_m = (goal.position_m - from).norm();
    seconds += TrapezoidalProfile::duration_s(length_m, 0, limits_to(goal, rules_.limits));
    from = goal.position_m;
  }
  return seconds;
}

}  // namespace sidestep
