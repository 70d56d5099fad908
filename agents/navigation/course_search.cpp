// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/course_search.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace sidestep {
namespace {

/// Margin of planned courses beyond the floor's margin. Robots follow their courses with small errors.
constexpr double kPlannedMargin_m = 0.010;
/// A narrow beam finds most courses, a wide one most of the rest.
constexpr BeamSettings kNarrowBeam{12, 5, 3}, kWideBeam{40, 60, 16};
/// How far courses may leave the rectangle between start and goal.
constexpr double kDetour_m = 1.5;
/// Slower robots drive without courses: these would have too many states.
constexpr double kMinSpeed_mps = 0.2;
/// Goals are within this distance, and within what a robot drives in this time.
constexpr double kReach_m = 5, kReach_s = 5;
/// A state takes two to three microseconds, and messages wait until a search ends.
constexpr std::size_t kMaxExpanded = 1'500;
/// Courses that take longer are not looked for.
constexpr double kLongest_s = 15;
const double kLongestStraight_s = to_seconds(DrivingCourse::kSample) * (DrivingCourse::kMaxStates - 1);

/// A robot may be faster than a limit that has just become lower.
MotionLimits limits_of(const CourseTask& task) {
  MotionLimits limits = task.limits;
  limits.speed_mps = std::max(limits.speed_mps, task.at_start.velocity_mps.norm());
  return limits;
}

BeamQuery query_of(const CourseTask& task, const CourseObstruction& obstruction, double longest_s) {
  const double latest_s = task.before ? to_seconds(*task.before - obstruction.from()) : longest_s;
  return {task.at_start.position_m,
          task.goal_m,
          limits_of(task),
          task.at_start.velocity_mps,
          obstruction.others(),
          obstruction.leaving_m(),
          latest_s,
          kMaxExpanded};
}

std::optional<DrivingCourse> to_driving_course(const SampledCourse& found, RobotId robot, Time start) {
  assert(found.samples_m.size() <= DrivingCourse::kMaxStates);
  DrivingCourse course{robot, start, {}, start, false, {}};
  for (std::size_t i = 0; i < found.samples_m.size(); ++i)
    course.states.push_back(
        found.course.state_at(Time{} + DrivingCourse::kSample * static_cast<std::int64_t>(i)));
  course.states.back().velocity_mps.setZero();
  return course;
}

}  // namespace

void CourseObstruction::add(const DrivingCourse& course) {
  std::vector<Vec2>& at_m = storage_.emplace_back();
  const Time end = std::min(course.end() + DrivingCourse::kSample, from_ + kAhead);
  for (Time t = from_; at_m.empty() || t < end; t += DrivingCourse::kSample)
    at_m.push_back(course.position_at(t));
  others_.push_back({at_m, !course.continues && course.end() <= from_ + kAhead});
}

void CourseObstruction::add_staying(std::span<const Vec2> places_m) {
  for (const Vec2& place_m : places_m) others_.push_back({storage_.emplace_back(1, place_m)});
}

void CourseObstruction::add_leaving(std::span<const Vec2> places_m) {
  leaving_m_.insert(leaving_m_.end(), places_m.begin(), places_m.end());
}

CourseSearch::CourseSearch(const FloorRules& rules, ObstacleWorld world)
    : rules_(rules),
      world_(std::move(world)),
      problem_{&world_, rules.field, rules.radius_m, rules.margin_m + kPlannedMargin_m, rules.limits},
      planner_(problem_) {}

double CourseSearch::reach_m(double speed_mps) { return std::min(kReach_m, kReach_s * speed_mps); }

std::optional<DrivingCourse> CourseSearch::find_straight(const CourseTask& task,
                                                         const CourseObstruction& obstruction) {
  if (task.limits.speed_mps < kMinSpeed_mps) return std::nullopt;
  const std::optional<SampledCourse> found =
      planner_.plan_straight(query_of(task, obstruction, kLongestStraight_s));
  if (!found) return std::nullopt;
  return to_driving_course(*found, task.robot, obstruction.from());
}

std::optional<DrivingCourse> CourseSearch::find(const CourseTask& task, const CourseObstruction& obstruction,
                                                Rng& rng) {
  if (task.limits.speed_mps < kMinSpeed_mps) return std::nullopt;
  const auto with = [](BeamSettings beam, double braking_separation_m) {
    beam.braking_separation_m = braking_separation_m;
    beam.detour_m = kDetour_m;
    return beam;
  };
  // If robots that brake kept the whole planned margin, narrow places would be closed.
  const double planned_m = problem_.min_separation_m(), required_m = rules_.min_separation_m();
  const std::array attempts{with(kNarrowBeam, planned_m), with(kNarrowBeam, required_m),
                            with(kWideBeam, required_m)};
  // A course that is only to be improved is not worth a wide beam.
  const std::span<const BeamSettings> tried(attempts.data(), task.before ? 2 : attempts.size());
  const std::optional<SampledCourse> found =
      planner_.plan(query_of(task, obstruction, kLongest_s), tried, rng);
  if (!found) return std::nullopt;
  return to_driving_course(*found, task.robot, obstruction.from());
}

}  // namespace sidestep
