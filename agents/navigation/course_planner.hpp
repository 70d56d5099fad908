// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "agents/navigation/course_conflicts.hpp"
#include "agents/navigation/course_leader.hpp"
#include "agents/navigation/course_search.hpp"

namespace sidestep {

/// What a robot knows about others when it plans its course.
struct CourseSurroundings {
  std::span<const DrivingCourse* const> others{};  ///< the courses of robots nearby
  std::span<const CourseOffer* const> offers{};    ///< recent offers to all robots
  std::span<const Vec2> leaving_m{};               ///< robots without a course that will drive away
  std::span<const Vec2> staying_m{};               ///< robots without a course that will stay
};

/// Plans a robot's course to its target among the courses of others. All robots follow the same rules, so
/// they agree after a few messages:
/// - A robot plans its course around all courses that precede its own. It keeps the course while it can
///   follow it and no course that precedes it comes too close.
/// - Courses may conflict: robots that plan at the same time do not know each other's, and a robot that sets
///   out later may precede those that have courses. One of the robots then plans new courses for the others
///   and offers them (CourseLeader). The others wait a moment for these offers before they plan by
///   themselves.
/// - A robot that is late tries from time to time whether there is a faster course by now.
/// Each cycle has two parts: follow() is fast, and the robot's motion depends on it. plan() may take ten
/// milliseconds or more; its results are used from the next cycle on.
class CoursePlanner {
 public:
  struct Query {
    Time start{};         ///< when the robot's next motion starts
    State at_start;       ///< the robot's state at `start`
    Vec2 target_m{0, 0};  ///< where the robot wants to rest
    /// The target, or a place on the way to it within CourseSearch::reach_m(); nullopt: the robot drives
    /// without a course.
    std::optional<Vec2> goal_m{};
    MotionLimits limits{};
    CourseSurroundings around{};
  };

  /// `world`: the obstacles that courses avoid.
  CoursePlanner(RobotId robot, const FloorRules& rules, ObstacleWorld world);
  CoursePlanner(const CoursePlanner&) = delete;
  CoursePlanner& operator=(const CoursePlanner&) = delete;

  /// Keeps or changes the course for the motion from query.start on, and decides whether plan() has to find
  /// another one. Returns nullptr if the robot has none, or cannot follow it.
  const DrivingCourse* follow(const Query& query);
  /// The acceleration during `hold` with which the robot follows its course. Precondition: the last call of
  /// follow() returned a course.
  Vec2 acceleration_mps2(const Query& query, Duration hold) const;
  /// Plans what follow() has found necessary, from query.start on: the start of the motion after this one.
  /// Also plans courses for others.
  void plan(const Query& query, Rng& rng);
  /// Says how long the last call of plan() took. Where no core is idle, or cores are slow, this counts as
  /// more effort, so that robots search less.
  void charge(Duration taken);

  /// Gives up the course: the robot has another target, or does not drive.
  void give_up();
  /// The robot's course; nullptr if it has none.
  const DrivingCourse* course() const { return own_ ? &*own_ : nullptr; }
  /// The effort of all searches so far; see BeamPlanner.
  std::size_t effort() const { return search_.effort(); }
  /// The offers that the last call of plan() made to others.
  std::span<const CourseOffer> offers() const { return offers_; }

 private:
  void start_anew(const Query& query);
  /// Takes an offer that fits, if there is one, instead of the present course.
  void take_offer(const Query& query);
  /// Delays the course by the time by which the robot has fallen behind.
  void delay_by_lag(const Query& query);
  bool can_follow(const Query& query) const;
  /// The earliest conflict with a course that precedes the robot's own.
  std::optional<Time> find_conflict(const Query& query);
  /// Whether the course keeps its distance from all courses that precede it.
  bool is_settled(const Query& query, const DrivingCourse& course);
  /// Decides how to solve the conflict: wait for an offer, brake, or plan.
  void handle_conflict(const Query& query);
  /// Whether a robot that precedes this one is planning courses for others.
  bool is_led(const Query& query) const;
  /// Whether the course leads straight to the target, without waiting.
  bool drives_straight(const Query& query) const;

  /// `before`: courses that end later are of no use.
  [[nodiscard]] std::optional<DrivingCourse> find_course(const Query& query, std::optional<Time> before,
                                                         Rng& rng);
  void plan_own(const Query& query, Rng& rng);
  /// Gives up a course that will come too close to others soon: no other one has been found. Returns whether
  /// the robot keeps its course.
  bool keep_while_free(const Query& query);
  void set_course(DrivingCourse course);
  /// Replaces the course by a faster one if there is one.
  void improve(const Query& query, Rng& rng);
  /// Plans what is necessary and what the effort allows. Precondition: the robot has a target.
  void plan_within_effort(const Query& query, Rng& rng);
  /// The robot cannot follow its course any more.
  void lose_course(const Query& query);

  const RobotId robot_;
  const MotionLimits limits_;
  const double separation_m_;
  CourseConflicts conflicts_;
  CourseSearch search_;
  CourseLeader leader_{search_, conflicts_};
  Vec2 target_m_{0, 0}, first_target_m_{0, 0};  // now, and when the robot set out
  std::optional<Time> due_;                     // nullopt: the robot has no target yet
  std::optional<DrivingCourse> own_;
  Duration delay_{0};  // by which own_ has been delayed
  Time last_planned_at_{};
  Vec2 lost_m_{0, 0};  // where the robot has lost its courses
  int losses_ = 0;     // how many it has lost there
  bool needs_course_ = false, brakes_ = false;
  std::optional<Time> conflict_;
  Time waiting_since_{};  // since when the robot waits for offers
  Time retry_at_{};       // no course was found; the time of the next attempt
  Duration retry_{};
  Time improve_at_{};
  double improve_s_ = 0;  // mean time between two attempts to improve the course
  double effort_ = 0;     // that the robot may spend on searches, as of effort_at_
  Time effort_at_{};
  double last_effort_ = 0;  // of the last call of plan()
  std::span<const CourseOffer> offers_;
};

}  // namespace sidestep
