// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "agents/planning/joint/beam_planner.hpp"
#include "common/motion/driving_course.hpp"
#include "common/motion/floor_rules.hpp"

namespace sidestep {

/// What a robot has to avoid on its course, from a time on.
class CourseObstruction {
 public:
  /// Nobody knows where robots that still drive will be after this time: they may change their courses.
  static constexpr Duration kAhead{8'000'000'000};

  explicit CourseObstruction(Time from) : from_(from) {}
  CourseObstruction(const CourseObstruction&) = delete;
  CourseObstruction& operator=(const CourseObstruction&) = delete;

  /// Adds a robot that follows a course.
  void add(const DrivingCourse& course);
  /// Adds robots that stay where they are.
  void add_staying(std::span<const Vec2> places_m);
  /// Adds robots that will drive away, nobody knows where.
  void add_leaving(std::span<const Vec2> places_m);
  void add_leaving(const Vec2& place_m) { leaving_m_.push_back(place_m); }

  Time from() const { return from_; }
  std::span<const TimedPositions> others() const { return others_; }
  std::span<const Vec2> leaving_m() const { return leaving_m_; }

 private:
  const Time from_;
  std::deque<std::vector<Vec2>> storage_;
  std::vector<TimedPositions> others_;
  std::vector<Vec2> leaving_m_;
};

/// A motion that a course has to achieve.
struct CourseTask {
  RobotId robot = 0;
  State at_start;
  Vec2 goal_m{0, 0};
  MotionLimits limits{};
  std::optional<Time> before{};  ///< courses that end later are of no use
};

/// Searches for courses of robots.
class CourseSearch {
 public:
  /// `world`: the obstacles that courses avoid.
  CourseSearch(const FloorRules& rules, ObstacleWorld world);
  CourseSearch(const CourseSearch&) = delete;
  CourseSearch& operator=(const CourseSearch&) = delete;

  /// The distance along each axis from a robot within which its goals may be.
  static double reach_m(double speed_mps);

  /// The fastest motion to the goal, which may be anywhere, if it is free.
  [[nodiscard]] std::optional<DrivingCourse> find_straight(const CourseTask& task,
                                                           const CourseObstruction& obstruction);
  /// A course to a goal within reach_m().
  [[nodiscard]] std::optional<DrivingCourse> find(const CourseTask& task,
                                                  const CourseObstruction& obstruction, Rng& rng);
  /// The effort of all searches so far; see BeamPlanner.
  std::size_t effort() const { return planner_.effort(); }

 private:
  const FloorRules rules_;
  const ObstacleWorld world_;
  const JointProblem problem_;
  BeamPlanner planner_;
};

}  // namespace sidestep
