// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/waits.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/messaging/version_codec.hpp"
#include "deploy/view/monitor/closest_pair.hpp"

namespace sidestep {
namespace {

constexpr Duration kAhead = std::chrono::milliseconds(500);
constexpr double kSlow = 0.5;           ///< a waiting robot drives at less than this part of its limit
constexpr double kStanding_mps = 0.05;  ///< a robot that is slower stands
constexpr double kAtGoal_m = 0.05;      ///< a robot that is nearer to its goal is there
constexpr double kExtraSeparation_m = 0.05;

std::optional<Vec2> position_of(const PlannedRobot& robot, Time t) {
  if (robot.course) return robot.course->position_at(t);
  if (robot.version) return robot.version->state_at(t).position_m;
  return std::nullopt;
}

bool is_waiting(const PlannedRobot& robot, Time now) {
  if (!robot.course) return false;
  const DrivingCourse& course = *robot.course;
  // Between its planning and its start, a course continues the motion before it.
  const State state = course.state_at(std::max(now, course.start));
  const bool is_at_goal = !course.continues && (course.goal_m() - state.position_m).norm() < kAtGoal_m;
  const bool is_slow = state.velocity_mps.norm() < kSlow * robot.speed_limit_mps;
  return !is_at_goal && (is_slow || robot.speed_mps < kStanding_mps);
}

/// The place on a course's path that is `distance_m` ahead of its position at a time; the end if that is
/// nearer.
Vec2 place_ahead(const DrivingCourse& course, Time t, double distance_m) {
  const Duration elapsed = std::clamp(t, course.start, course.end()) - course.start;
  Vec2 place = course.position_at(t);
  for (auto i = static_cast<std::size_t>(elapsed / DrivingCourse::kSample) + 1; i < course.states.size();
       ++i) {
    const Vec2 step = course.states[i].position_m - place;
    const double length_m = step.norm();
    if (length_m > distance_m) return place + distance_m / length_m * step;
    distance_m -= length_m;
    place = course.states[i].position_m;
  }
  return place;
}

/// The nearest place of another robot within `reach_m`; nullptr if there is none. `places` are sorted by x.
const RobotPlace* nearest_other(std::span<const RobotPlace> places, const RobotPlace& wanted,
                                double reach_m) {
  const RobotPlace* nearest = nullptr;
  const auto x = [](const RobotPlace& place) { return place.position_m.x(); };
  for (auto at = std::ranges::lower_bound(places, wanted.position_m.x() - reach_m, {}, x);
       at != places.end() && x(*at) <= wanted.position_m.x() + reach_m; ++at) {
    const double distance_m = (at->position_m - wanted.position_m).norm();
    if (at->id == wanted.id || distance_m >= reach_m) continue;
    reach_m = distance_m;
    nearest = &*at;
  }
  return nearest;
}

/// The version that a robot drives by: the latest one that was granted, else the one that it executes.
std::optional<Trajectory> version_of(const RobotView& robot, const msg::Feedback* feedback, Time now) {
  const msg::Version* version = fresh(robot.granted, now);
  if (!version && feedback) version = &feedback->executing();
  const auto decoded = version ? decode(*version) : std::nullopt;
  return decoded ? std::optional(decoded->trajectory) : std::nullopt;
}

}  // namespace

Waits waits_among(std::span<const PlannedRobot> robots, double separation_m, Time now) {
  std::vector<RobotPlace> places;
  for (const PlannedRobot& robot : robots)
    if (const std::optional<Vec2> position_m = position_of(robot, now + kAhead))
      places.push_back({robot.id, *position_m});
  std::ranges::sort(places, {}, [](const RobotPlace& place) { return place.position_m.x(); });
  Waits waits;
  for (const PlannedRobot& robot : robots) {
    if (!is_waiting(robot, now)) continue;
    const double distance_m = robot.speed_limit_mps * to_seconds(kAhead);
    const RobotPlace ahead{robot.id, place_ahead(*robot.course, now, distance_m)};
    if (const RobotPlace* other = nearest_other(places, ahead, separation_m + kExtraSeparation_m))
      waits[robot.id] = other->id;
  }
  return waits;
}

Waits waits_on(const FloorState& floor, const FloorRules& rules, Time now) {
  std::vector<PlannedRobot> robots;
  for (const auto& [id, view] : floor.robots()) {
    const msg::Feedback* feedback = fresh(view.feedback, now);
    if (feedback && feedback->is_lifted()) continue;
    PlannedRobot robot;
    robot.id = id;
    robot.course = present_course(view, now);
    if (!robot.course) robot.version = version_of(view, feedback, now);
    if (feedback) robot.speed_mps = std::hypot(feedback->vx_mps(), feedback->vy_mps());
    robot.speed_limit_mps = rules.limits.speed_mps;
    const msg::AgentStatus* status = fresh(view.status, now);
    if (status && status->clock_speed_limit_mps() > 0)
      robot.speed_limit_mps = std::min(robot.speed_limit_mps, status->clock_speed_limit_mps());
    robots.push_back(robot);
  }
  return waits_among(robots, rules.min_separation_m(), now);
}

}  // namespace sidestep
