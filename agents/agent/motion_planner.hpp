// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <map>
#include <optional>

#include "agents/agent/assignment.hpp"
#include "agents/agent/blockage_monitor.hpp"
#include "agents/agent/course_book.hpp"
#include "agents/agent/desired_motion.hpp"
#include "agents/agent/intent_planner.hpp"
#include "agents/agent/observations.hpp"
#include "agents/agent/occluded_corners.hpp"
#include "agents/agent/passage_yielding.hpp"
#include "agents/agent/planning_scratch.hpp"
#include "agents/agent/route_surroundings.hpp"
#include "agents/agent/route_to_target.hpp"
#include "agents/navigation/course_planner.hpp"
#include "agents/safety/safety_search.hpp"

namespace sidestep {

/// A desired motion: the query for the safety search, and the base and intent that are proposed with its
/// result.
struct MotionPlan {
  SearchQuery query;
  VersionNumber base = 0;  ///< the version that the motion continues
  Intent intent;           ///< the robot's intent after the motion
  bool follows_course = false;
};

/// Plans a robot's motion from its target to the query for the safety search: whether to give way, the route,
/// the intent, the speed and the acceleration. Safety does not depend on it.
class MotionPlanner {
 public:
  struct Query {
    Time now{};
    Time start{};         ///< when the motion starts
    const Version& base;  ///< the version that the motion continues
    int lead = 1;         ///< number of cycles from now to the start
    double max_speed_mps = std::numeric_limits<double>::infinity();  ///< the speed that the clocks allow
    Duration max_lag{0};  ///< the robot's maximum lag in excess of the clock bound
    const Assignment& assignment;
    Observations& observations;
    CourseBook& courses;
    Rng& rng;
  };

  /// `scratch` must outlive this object.
  MotionPlanner(const FloorSpec& floor, const RobotSpec& robot, PlanningScratch& scratch);

  /// Plans the motion from `start` on. Returns nullopt if the base already ends where the robot wants to be,
  /// if the search for a route takes longer than this cycle, or if the robot must come to rest first.
  /// Precondition: the agent waits for nothing but an order.
  [[nodiscard]] std::optional<MotionPlan> plan(const Query& query);
  /// Processes the result of the search for a plan.
  void on_search(const MotionPlan& plan, bool desired_is_clear, Time now);

  /// Plans the robot's course for the cycles to come, and courses that it offers to others. It may take
  /// milliseconds, so call it after the motion of this cycle has been proposed. `next` is when the motion
  /// after this one starts, `at_next` the robot's state then.
  void plan_courses(Time next, const State& at_next, Rng& rng);
  /// Says how long the last call of plan_courses() took.
  void charge_courses(Duration taken);
  /// Gives up the course unless the robot has finished it: the robot does not drive.
  void pause(Time now);
  /// The course that the robot follows; nullptr if it has none.
  const DrivingCourse* course() const { return courses_ ? courses_->course() : nullptr; }
  /// The offers that the last call of plan_courses() made to others.
  std::span<const CourseOffer> course_offers() const;

  /// Call it when the robot is lifted: one without a goal stays where it is put down.
  void on_absence();
  /// Call it when the robot gets another goal.
  void on_new_goal();
  void set_zones(std::span<const Order> zones);

  /// Whether a robot at this position has to leave a zone.
  bool is_kept_out(const Vec2& position_m) const;
  bool is_recovering() const { return intents_.is_recovering(); }
  std::uint64_t route_changes() const { return intents_.changes(); }
  /// The blockage that prevents the robot from reaching its goal; nullopt until it has lasted long enough.
  std::optional<Blockage> lasting_blockage() const { return blockage_.lasting(last_plan_); }
  /// Estimated time to reach all remaining goals; nullopt: unknown.
  std::optional<double> remaining_s(const Assignment& assignment, bool has_arrived) const;

 private:
  /// Restarts all timers, because the robot's clock was set back and recorded times have lost their meaning.
  void restart_timers(Time now);
  /// The robot's target: the place where it gives way, its goal, or the end of its base.
  Vec2 target_m(const Query& query) const;
  /// Where the robot wants to rest in the end.
  Vec2 home_m(const Query& query) const;
  /// The route to the target; nullopt if the robot is at the target, or no route is known in this cycle.
  std::optional<Route> find_route(const Query& query, const Vec2& target_m);
  /// The place that the robot announces as the end of its route.
  Vec2 announced_goal_m(const Vec2& end_m) const;
  /// Whether the intent of the robot's last version says where it wants to go and where its route ends.
  bool has_announced(const Query& query, const Vec2& end_m) const;
  void update_blockage(const Route& route, Time now);
  /// The robot's course; nullptr if the robot has to find its way without one.
  const DrivingCourse* follow_course(const Query& query, const State& at_start, const Route& route);
  /// Whether the robot can drive by a course: it relies on routes, and no body is near that nobody controls.
  bool may_follow_course(const Query& query, const State& at_start, const Route& route) const;
  /// Finds the robots nearby that are not among those with a course, and whether they will drive away.
  /// Returns false if one of them needs more room than courses leave.
  bool find_robots_without_course(const Query& query, const Vec2& position_m,
                                  std::span<const DrivingCourse* const> with_course);
  /// The plan that follows the intent, or the course if there is one; nullopt if the laser has not seen the
  /// floor where the robot is.
  std::optional<MotionPlan> follow_intent(const Query& query, const Intent& intent, const State& at_start,
                                          const Route& route, const DrivingCourse* course);
  /// Makes routes avoid a corner at which the robot has come to a standstill.
  void update_corners(const OccludedCorners::Approach& approach, const RobotLaser& laser, Time now);
  /// The lowest of the speeds that the clocks, the goal and the zones allow.
  double max_speed_mps(const Query& query, const State& at_start) const;
  /// The same for a robot with a course, which also has to stop if vision does not see it in time.
  double max_course_speed_mps(const Query& query, const State& at_start) const;
  HoldBounds hold_bounds(int lead) const;

  const FloorRules& rules_;
  const Duration cycle_;
  const RouteSurroundings surroundings_;
  RouteToTarget route_;
  BlockageMonitor blockage_;
  PassageYielding passage_;
  OccludedCorners corners_;
  IntentPlanner intents_;
  const RobotId robot_;
  std::optional<CoursePlanner> courses_;              // made when it is first used
  std::optional<CoursePlanner::Query> course_query_;  // of this cycle
  std::vector<Vec2> leaving_m_, staying_m_;
  /// A robot that rests without a course, and since when.
  struct Resting {
    Vec2 place_m{0, 0};
    Time since{}, seen_at{};
  };
  std::map<RobotId, Resting> resting_;
  std::optional<Vec2> home_m_;  // where the robot was before it stepped aside; used if it has no goal
  Time no_course_until_{}, last_plan_{};
};

}  // namespace sidestep
