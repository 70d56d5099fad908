// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/motion_planner.hpp"

#include <algorithm>
#include <cmath>

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
constexpr double kAnnounced_m = 0.01;  ///< places nearer to each other than this need not be announced anew
constexpr double kStandstill_mps = 0.01;  ///< intended speeds below this count as being at rest

std::span<const double> extra_clearances_m(const FloorSpec& floor) {
  if (floor.laser) return kClearancesInSight_m;
  return {&kExtraClearance_m, 1};
}

NamedPlanner planner_of(const FloorSpec& floor, const RobotSpec& robot) {
  return make_driving_planner(robot.planner.empty() ? floor.planner : robot.planner);
}

/// Courses of robots that are farther away do not matter yet.
constexpr double kCourseHorizon_m = 5;
/// Length of the straight line between two places on a bent course, as a part of the way. Dead reckoning
/// becomes worse with the way.
constexpr double kStraightShare = 0.9;
/// A robot that cannot follow a course now has none for this long, because such things come and go.
constexpr Duration kWithoutCourse{300'000'000};
/// A robot without a course that has rested for this long counts as an obstacle.
constexpr Duration kStaysAfter{500'000'000};
/// A robot without a course that rests again within this distance has not driven away.
constexpr double kSamePlace_m = 0.03;
/// The intent of a robot with a course: its velocity after the first time, for twice that time, then the
/// place where it will be after the second one.
constexpr Duration kIntendedVelocity{150'000'000}, kIntendedPlace{600'000'000};

/// The place on a route where a course from `from_m` should end: the end of the route if it is near enough.
/// nullopt if the end is far away and the way to it is open: there robots steer better than by courses that
/// do not lead to their targets.
std::optional<Vec2> course_goal_m(const Vec2& from_m, std::span<const Vec2> waypoints_m, const Vec2& end_m,
                                  double reach_m) {
  const auto is_near = [&](const Vec2& place_m) {
    return (place_m - from_m).cwiseAbs().maxCoeff() <= reach_m;
  };
  if (!is_near(waypoints_m.empty() ? end_m : waypoints_m.front())) return std::nullopt;
  Vec2 last_m = from_m;
  for (std::size_t i = 0; i <= waypoints_m.size(); ++i) {
    const Vec2 next_m = i < waypoints_m.size() ? waypoints_m[i] : end_m;
    if (!is_near(next_m)) {
      // Halves the interval in which the route leaves the surroundings.
      Vec2 inside_m = last_m, outside_m = next_m;
      while ((outside_m - inside_m).norm() > 0.01) {
        const Vec2 middle_m = (inside_m + outside_m) / 2;
        (is_near(middle_m) ? inside_m : outside_m) = middle_m;
      }
      return inside_m;
    }
    last_m = next_m;
  }
  return end_m;
}

/// The acceleration, reduced so that the robot does not exceed a speed limit after a time. A robot that is
/// too fast brakes without turning, because a turn would leave less acceleration for braking.
Vec2 with_speed_limit(const Vec2& acceleration_mps2, const Vec2& velocity_mps, double limit_mps,
                      double duration_s) {
  const Vec2 after_mps = velocity_mps + duration_s * acceleration_mps2;
  const double speed_mps = after_mps.norm();
  if (speed_mps <= limit_mps) return acceleration_mps2;
  const double now_mps = velocity_mps.norm();
  if (now_mps > limit_mps) return (limit_mps / now_mps - 1) / duration_s * velocity_mps;
  return (limit_mps / speed_mps * after_mps - velocity_mps) / duration_s;
}

/// The speed from which a robot that begins to brake after a time comes to rest within a distance.
double max_speed_within_mps(double distance_m, double reaction_s, double deceleration_mps2) {
  const double lost_mps = deceleration_mps2 * reaction_s;
  return std::sqrt(lost_mps * lost_mps + 2 * deceleration_mps2 * std::max(0.0, distance_m)) - lost_mps;
}

Intent intent_of(const DrivingCourse& course, Time t) {
  Intent intent{course.state_at(t + kIntendedVelocity).velocity_mps, to_seconds(2 * kIntendedVelocity),
                course.position_at(t + kIntendedPlace), course.goal_m()};
  intent.due = course.due;
  return intent;
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
      passage_(robot.id, rules_),
      corners_(rules_.radius_m),
      intents_(robot.id, route_.local_methods(), rules_, scratch.steering),
      robot_(robot.id) {}

std::optional<MotionPlan> MotionPlanner::plan(const Query& query) {
  const Version& base = query.base;
  if (query.now < last_plan_) restart_timers(query.now);
  last_plan_ = query.now;
  course_query_.reset();
  passage_.update(query.now, home_m(query), query.observations, query.assignment, route_, query.rng);
  // Inflation ends only when the robot is at rest. If the robot drove on with inflation, it might never fit
  // through narrow places.
  if (base.inflation_m > 0) pause(query.now);
  if (base.inflation_m > 0 || query.start <= base.trajectory.start()) return std::nullopt;
  if (passage_.place_m() && !query.assignment.goal() && !home_m_) home_m_ = base.trajectory.rest_position_m();
  const Vec2 target = target_m(query);
  const std::optional<Route> route = find_route(query, target);
  if (!route) return std::nullopt;
  const State at_start = base.trajectory.state_at(query.start);
  const DrivingCourse* course = follow_course(query, at_start, *route);
  Intent intent = course ? intent_of(*course, query.start)
                         : intents_.choose({at_start, query.start, *route, hold_bounds(query.lead).max},
                                           route_, query.observations.neighbours());
  intent.target_m = home_m(query);
  intent.goal_m = announced_goal_m(route->end_m);
  return follow_intent(query, intent, at_start, *route, course);
}

void MotionPlanner::restart_timers(Time now) {
  passage_.restart(now);
  blockage_.restart();
  corners_.restart();
  intents_.on_new_goal();
  if (courses_) courses_->give_up();
  resting_.clear();
  no_course_until_ = {};
}

Vec2 MotionPlanner::target_m(const Query& query) const {
  if (const std::optional<Vec2> place = passage_.place_m()) return *place;
  return home_m(query);
}

Vec2 MotionPlanner::home_m(const Query& query) const {
  if (const Goal* goal = query.assignment.goal()) return goal->position_m;
  return home_m_.value_or(query.base.trajectory.rest_position_m());
}

std::optional<Route> MotionPlanner::find_route(const Query& query, const Vec2& target) {
  const bool gives_way = passage_.place_m().has_value();
  const bool rests_at_target = will_rest_at(query.base, target) && !is_kept_out(target);
  if (rests_at_target && (!query.base.intent || has_announced(query, target))) {
    if (!gives_way) {
      blockage_.clear();
      home_m_.reset();
    }
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
  return is_as_near_as_possible && has_announced(query, route->end_m) ? std::nullopt : route;
}

Vec2 MotionPlanner::announced_goal_m(const Vec2& end_m) const {
  // Robots in the way to the place have to know where it is.
  const bool makes_room = passage_.is_idle() && passage_.place_m();
  return makes_room ? *passage_.place_m() : end_m;
}

bool MotionPlanner::has_announced(const Query& query, const Vec2& end_m) const {
  const std::optional<Intent>& intent = query.base.intent;
  return intent && (intent->target_m - home_m(query)).norm() < kAnnounced_m &&
         (intent->goal_m - announced_goal_m(end_m)).norm() < kAnnounced_m;
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

double MotionPlanner::max_course_speed_mps(const Query& query, const State& at_start) const {
  const double observed_m = kStraightShare * query.observations.own().dead_reckoning_m(at_start.position_m);
  const double reaction_s = to_seconds(hold_bounds(query.lead).max + cycle_);
  return std::min(max_speed_mps(query, at_start),
                  max_speed_within_mps(observed_m, reaction_s, rules_.limits.deceleration_mps2));
}

HoldBounds MotionPlanner::hold_bounds(int lead) const {
  const Duration min = std::max(cycle_, kMinHold);
  return {min, std::max(min, cycle_ * lead)};
}

bool MotionPlanner::may_follow_course(const Query& query, const State& at_start, const Route& route) const {
  Observations& seen = query.observations;
  if (seen.laser() || route_.local_methods() || passage_.place_m() || route.is_way_out) return false;
  const auto is_near = [&](const MovingObstacle& body) {
    return (body.position_m - at_start.position_m).norm() - body.radius_m <= kCourseHorizon_m;
  };
  return std::ranges::none_of(seen.obstacles().recent(query.now, query.max_lag), is_near) &&
         std::ranges::none_of(seen.displaced().recent(query.now, query.max_lag), is_near,
                              &UncontrolledBody::reach);
}

bool MotionPlanner::find_robots_without_course(const Query& query, const Vec2& position_m,
                                               std::span<const DrivingCourse* const> with_course) {
  leaving_m_.clear();
  staying_m_.clear();
  for (const Version* version : query.observations.neighbours().newest(position_m, page_horizon_m(rules_))) {
    const bool has_course =
        std::ranges::find(with_course, version->robot, &DrivingCourse::robot) != with_course.end();
    if (has_course) continue;
    if (version->inflation_m > 0) return false;
    const OtherAssignment orders = query.assignment.other(version->robot);
    const Vec2 place_m = version->trajectory.rest_position_m();
    Resting& resting = resting_[version->robot];
    if (resting.seen_at == Time{} || (resting.place_m - place_m).norm() > kSamePlace_m)
      resting = {place_m, query.now, query.now};
    resting.seen_at = query.now;
    const bool stays = orders.is_held || !orders.has_drive_order || query.now - resting.since > kStaysAfter;
    (stays ? staying_m_ : leaving_m_).push_back(place_m);
  }
  std::erase_if(resting_, [&](const auto& entry) { return entry.second.seen_at != query.now; });
  return true;
}

const DrivingCourse* MotionPlanner::follow_course(const Query& query, const State& at_start,
                                                  const Route& route) {
  CoursePlanner::Query course{query.start, at_start, route.end_m, {}, rules_.limits, {}};
  course.limits.speed_mps = std::min(course.limits.speed_mps, max_speed_mps(query, at_start));
  course.goal_m = course_goal_m(at_start.position_m, route_.remaining_waypoints_m(), route.end_m,
                                CourseSearch::reach_m(course.limits.speed_mps));
  bool may_follow = may_follow_course(query, at_start, route);
  if (may_follow && course.goal_m) {
    course.around = {query.courses.nearby(at_start.position_m, kCourseHorizon_m, query.now),
                     query.courses.offers(query.now)};
    may_follow = find_robots_without_course(query, at_start.position_m, course.around.others);
    course.around.leaving_m = leaving_m_;
    course.around.staying_m = staying_m_;
  }
  if (!may_follow || !course.goal_m) resting_.clear();
  if (!may_follow) {
    no_course_until_ = query.now + kWithoutCourse;
    if (courses_) courses_->give_up();
  }
  if (query.now < no_course_until_) return nullptr;
  if (!courses_) courses_.emplace(robot_, rules_, route_.obstacles().fixed_world());
  course_query_ = course;
  return courses_->follow(*course_query_);
}

void MotionPlanner::plan_courses(Time next, const State& at_next, Rng& rng) {
  if (!course_query_) return;
  CoursePlanner::Query query = *course_query_;
  query.start = next;
  query.at_start = at_next;
  courses_->plan(query, rng);
}

void MotionPlanner::charge_courses(Duration taken) {
  if (course_query_) courses_->charge(taken);
}

void MotionPlanner::pause(Time now) {
  const DrivingCourse* course = this->course();
  if (course && course->end() > now) courses_->give_up();
}

std::span<const CourseOffer> MotionPlanner::course_offers() const {
  if (!course_query_) return {};
  return courses_->offers();
}

std::optional<MotionPlan> MotionPlanner::follow_intent(const Query& query, const Intent& intent,
                                                       const State& at_start, const Route& route,
                                                       const DrivingCourse* course) {
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
    // The version after this one starts `lead` cycles later.
    if (course) {
      desired.hold = followed.hold.max;
      desired.acceleration_mps2 =
          with_speed_limit(courses_->acceleration_mps2(*course_query_, desired.hold), at_start.velocity_mps,
                           max_course_speed_mps(query, at_start), to_seconds(desired.hold));
    } else {
      desired = follow(followed, max_speed);
    }
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
  return MotionPlan{search, query.base.number, intent, course != nullptr};
}

void MotionPlanner::update_corners(const OccludedCorners::Approach& approach, const RobotLaser& laser,
                                   Time now) {
  if (corners_.update(approach, laser, now)) route_.mark_outdated();
}

void MotionPlanner::on_search(const MotionPlan& plan, bool desired_is_clear, Time now) {
  // A robot that waits as planned is in no deadlock.
  if (plan.follows_course) return;
  intents_.on_search(plan.intent, desired_is_clear, plan.query.at_start.velocity_mps.norm(), now);
}

void MotionPlanner::on_absence() {
  home_m_.reset();
  passage_.restart(last_plan_);
}

void MotionPlanner::on_new_goal() {
  route_.forget();
  intents_.on_new_goal();
  if (courses_) courses_->give_up();
  blockage_.clear();
  home_m_.reset();
  passage_.restart(last_plan_);
}

void MotionPlanner::set_zones(std::span<const Order> zones) {
  route_.set_zones(zones);
  passage_.restart(last_plan_);
  courses_.reset();
  course_query_.reset();
}

bool MotionPlanner::is_kept_out(const Vec2& position_m) const {
  return route_.zones().is_kept_out(position_m, required_separation_m(rules_));
}

std::optional<double> MotionPlanner::remaining_s(const Assignment& assignment, bool has_arrived) const {
  const Goal* first = assignment.goal();
  if (first && passage_.is_idle() && passage_.place_m()) return 0;
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
