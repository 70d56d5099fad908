// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "agents/navigation/course_planner.hpp"
#include "agents/navigation/trapezoidal_profile.hpp"
#include "common/motion/robot_model.hpp"

namespace sidestep {

/// A robot of a CourseCrowd.
struct CrowdRobot {
  CrowdRobot(RobotId robot, const FloorRules& rules, const State& at_start, const Vec2& target)
      : id(robot),
        target_m(target),
        state(at_start),
        planner(robot, rules, ObstacleWorld()),
        rng(robot + 1) {}

  RobotId id;
  Vec2 target_m;
  State state;
  CoursePlanner planner;
  Rng rng;
  MotionLimits limits{};
  bool is_held = false;  ///< the robot brakes, and does not follow its course
  std::optional<Time> arrived_at{};
  std::optional<Time> followed{};  ///< `planned_at` of the course that it followed in the last cycle
  std::optional<DrivingCourse> published{};  ///< what the others know
  int plans = 0;                             ///< number of courses that it has had
};

/// Robots that follow their courses without errors, as far as their limits allow. What they publish in a
/// cycle arrives before the next one. Robots that have arrived rest.
class CourseCrowd {
 public:
  static constexpr Duration kCycle{16'666'667};
  static constexpr Time kStart = time_from_ns(1'800'000'000'000'000'000);
  static constexpr double kArrived_m = 0.001, kArrived_mps = 0.01;

  explicit CourseCrowd(const Field& field = {6, 6}) { rules.field = field; }

  CrowdRobot& add(const Vec2& from_m, const Vec2& target_m) {
    const auto id = static_cast<RobotId>(robots.size());
    return robots.emplace_back(id, rules, State{from_m, {0, 0}}, target_m);
  }

  /// One cycle: the motion from `now` on, then the courses from the next cycle on.
  void step() {
    std::erase_if(offers,
                  [&](const Heard& heard) { return now - heard.at > std::chrono::milliseconds(200); });
    std::vector<Moving> moving;
    std::vector<CourseOffer> made;
    for (CrowdRobot& robot : robots) moving.push_back({robot.state, move(robot, made)});
    keep_nearest(moving);
    now += kCycle;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      CrowdRobot& robot = robots[i];
      robot.state = state_after(moving[i].from, moving[i].acceleration_mps2, to_seconds(kCycle));
      const bool is_there = (robot.state.position_m - robot.target_m).norm() < kArrived_m &&
                            robot.state.velocity_mps.norm() < kArrived_mps;
      if (is_there && !robot.arrived_at) robot.arrived_at = now;
      if (robot.arrived_at) robot.state.velocity_mps.setZero();
      publish(robot);
    }
    for (CourseOffer& offer : made) offers.push_back({std::move(offer), now});
    offers_made += made.size();
  }

  /// Returns whether all robots have arrived within a time.
  bool run(Duration at_most) {
    const auto has_arrived = [](const CrowdRobot& robot) { return robot.arrived_at.has_value(); };
    for (const Time end = now + at_most; now < end && !std::ranges::all_of(robots, has_arrived);) step();
    return std::ranges::all_of(robots, has_arrived);
  }
  void run_for(Duration duration) {
    for (const Time end = now + duration; now < end;) step();
  }

  struct Heard {
    CourseOffer offer;
    Time at{};
  };

  FloorRules rules;
  std::deque<CrowdRobot> robots;
  std::vector<Vec2> staying_m;           ///< robots that do not drive
  std::vector<DrivingCourse> strangers;  ///< further courses that all robots know
  std::vector<Heard> offers;
  Time now = kStart;
  double nearest_m = std::numeric_limits<double>::infinity();  ///< smallest distance of two robots so far
  std::size_t offers_made = 0;

 private:
  struct Moving {
    State from;
    Vec2 acceleration_mps2{0, 0};
  };

  /// The target, or the place on the straight way to it at the border of the reach.
  Vec2 goal_m(const CrowdRobot& robot) const {
    const Vec2 way_m = robot.target_m - robot.state.position_m;
    const double part = CourseSearch::reach_m(robot.limits.speed_mps) / way_m.cwiseAbs().maxCoeff();
    return part < 1 ? Vec2(robot.state.position_m + part * way_m) : robot.target_m;
  }

  /// Returns the acceleration in this cycle.
  Vec2 move(CrowdRobot& robot, std::vector<CourseOffer>& made) {
    robot.followed.reset();
    if (robot.arrived_at) return {0, 0};
    std::vector<const DrivingCourse*> others;
    std::vector<Vec2> leaving_m;
    for (const CrowdRobot& other : robots) {
      if (other.id == robot.id) continue;
      if (other.published)
        others.push_back(&*other.published);
      else
        leaving_m.push_back(other.state.position_m);
    }
    for (const DrivingCourse& stranger : strangers) others.push_back(&stranger);
    std::vector<const CourseOffer*> heard;
    for (const Heard& offer : offers)
      if (offer.offer.by != robot.id) heard.push_back(&offer.offer);
    CoursePlanner::Query query{now,           robot.state,  robot.target_m,
                               goal_m(robot), robot.limits, {others, heard, leaving_m, staying_m}};
    const DrivingCourse* course = robot.planner.follow(query);
    if (course) robot.followed = course->planned_at;
    Vec2 acceleration = -robot.state.velocity_mps / to_seconds(kCycle);
    if (course && !robot.is_held) acceleration = robot.planner.acceleration_mps2(query, kCycle);
    acceleration = limit_acceleration(acceleration, robot.state.velocity_mps, robot.limits, kCycle);
    query.start = now + kCycle;
    query.at_start = state_after(robot.state, acceleration, to_seconds(kCycle));
    robot.planner.plan(query, robot.rng);
    made.insert(made.end(), robot.planner.offers().begin(), robot.planner.offers().end());
    return acceleration;
  }

  static void publish(CrowdRobot& robot) {
    const DrivingCourse* course = robot.planner.course();
    if (course && (!robot.published || robot.published->planned_at != course->planned_at)) ++robot.plans;
    robot.published = course ? std::optional(*course) : std::nullopt;
  }

  void keep_nearest(const std::vector<Moving>& moving) {
    constexpr int kParts = 4;
    for (int part = 1; part <= kParts; ++part) {
      const double t_s = to_seconds(kCycle) * part / kParts;
      std::vector<Vec2> at_m = staying_m;
      for (const Moving& robot : moving)
        at_m.push_back(state_after(robot.from, robot.acceleration_mps2, t_s).position_m);
      for (std::size_t i = staying_m.size(); i < at_m.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) nearest_m = std::min(nearest_m, (at_m[i] - at_m[j]).norm());
    }
  }
};

/// The time that a robot needs from rest to rest if it is alone.
inline double time_alone_s(const Vec2& from_m, const Vec2& to_m) {
  return TrapezoidalProfile::duration_s((to_m - from_m).norm(), 0, MotionLimits{});
}

/// Precondition: the robot has arrived.
inline double driven_s(const CrowdRobot& robot) {
  return to_seconds(robot.arrived_at.value() - CourseCrowd::kStart);
}

}  // namespace sidestep
