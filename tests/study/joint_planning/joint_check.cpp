// SPDX-License-Identifier: Apache-2.0
#include "tests/study/joint_planning/joint_check.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "deploy/trial/planning/rounded_shape.hpp"

namespace sidestep {
namespace {

constexpr double kStep_s = 0.001, kDistanceTolerance_m = 1e-6, kSpeedTolerance_mps = 1e-4,
                 kAccelerationTolerance_mps2 = 1e-2;
// Below this speed the higher of both limits applies: where a robot reverses, a sample averages two phases.
constexpr double kSlow_mps = 0.02;

/// A robot's positions at all sample times.
std::vector<Vec2> sampled(const Course& course, std::size_t samples) {
  std::vector<Vec2> positions(samples);
  const auto legs = course.legs();
  for (std::size_t leg = 0; leg < legs.size(); ++leg) {
    double begin_s = to_seconds(legs[leg].start() - Time{});
    Vec2 p = legs[leg].at_start().position_m, v = legs[leg].at_start().velocity_mps;
    auto k = static_cast<std::size_t>(std::ceil(begin_s / kStep_s));
    for (const MotionPhase& phase : legs[leg].phases()) {
      const double seconds = to_seconds(phase.duration);
      const Vec2& a = phase.acceleration_mps2;
      for (; k < samples && static_cast<double>(k) * kStep_s <= begin_s + seconds; ++k) {
        const double t = static_cast<double>(k) * kStep_s - begin_s;
        positions[k] = p + v * t + a * (t * t / 2);
      }
      p += v * seconds + a * (seconds * seconds / 2);
      v += a * seconds;
      begin_s += seconds;
    }
    // The robot rests here unless a next leg overwrites these positions.
    for (; k < samples; ++k) positions[k] = p;
  }
  return positions;
}

double distance_m(const Vec2& p, const RoundedShape& obstacle) {
  return closest_points(std::span(&p, 1), obstacle.corners_m).distance_m - obstacle.radius_m;
}

std::string fault_of_robot(const JointProblem& problem, std::span<const RoundedShape> obstacles,
                           std::size_t robot, double speed_limit_mps, const std::vector<Vec2>& at) {
  if ((at.front() - problem.starts_m[robot]).norm() > kDistanceTolerance_m)
    return fmt::format("robot {} does not begin at its start", robot);
  if ((at.back() - problem.goals_m[robot]).norm() > kDistanceTolerance_m)
    return fmt::format("robot {} does not end at its goal", robot);
  const double far_m = problem.radius_m + problem.margin_m - kDistanceTolerance_m;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double t = static_cast<double>(k) * kStep_s;
    if (!problem.field.contains(at[k], far_m))
      return fmt::format("robot {} leaves the field after {:.3f} s", robot, t);
    if (k > 0 && at[k] == at[k - 1]) continue;  // The robot is at rest.
    for (const RoundedShape& obstacle : obstacles)
      if (distance_m(at[k], obstacle) < far_m)
        return fmt::format("robot {} comes too close to an obstacle after {:.3f} s", robot, t);
    if (k == 0 || k + 1 == at.size()) continue;
    const Vec2 v = (at[k + 1] - at[k - 1]) / (2 * kStep_s);
    const Vec2 a = (at[k + 1] - 2 * at[k] + at[k - 1]) / (kStep_s * kStep_s);
    const bool speeds_up = v.norm() > kSlow_mps && a.dot(v) >= 0;
    const double max_mps2 =
        speeds_up ? problem.limits.acceleration_mps2
                  : std::max(problem.limits.acceleration_mps2, problem.limits.deceleration_mps2);
    if (v.norm() > speed_limit_mps + kSpeedTolerance_mps)
      return fmt::format("robot {} is too fast after {:.3f} s", robot, t);
    if (a.norm() > max_mps2 + kAccelerationTolerance_mps2)
      return fmt::format("robot {} exceeds its acceleration after {:.3f} s", robot, t);
  }
  return {};
}

}  // namespace

std::string fault_of(const JointProblem& problem, std::span<const Shape> obstacles,
                     std::span<const Course> courses, std::span<const double> speed_limits_mps) {
  if (courses.size() != problem.robots()) return "not every robot has a course";
  if (!speed_limits_mps.empty() && speed_limits_mps.size() != problem.robots())
    return "not every robot has a speed limit";
  std::vector<RoundedShape> rounded_obstacles;
  for (const Shape& obstacle : obstacles) rounded_obstacles.push_back(rounded(obstacle));
  double end_s = 0;
  for (const Course& course : courses) end_s = std::max(end_s, to_seconds(course.end() - Time{}));
  const auto samples = static_cast<std::size_t>(end_s / kStep_s) + 3;
  std::vector<std::vector<Vec2>> at;
  for (std::size_t robot = 0; robot < courses.size(); ++robot) {
    at.push_back(sampled(courses[robot], samples));
    double speed_limit_mps = problem.limits.speed_mps;
    if (!speed_limits_mps.empty()) speed_limit_mps = std::min(speed_limit_mps, speed_limits_mps[robot]);
    const std::string fault = fault_of_robot(problem, rounded_obstacles, robot, speed_limit_mps, at.back());
    if (!fault.empty()) return fault;
  }
  const double separation_m = 2 * problem.radius_m + problem.margin_m - kDistanceTolerance_m;
  for (std::size_t i = 0; i < at.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < samples; ++k)
        if ((at[i][k] - at[j][k]).norm() < separation_m)
          return fmt::format("robots {} and {} come too close after {:.3f} s", j, i,
                             static_cast<double>(k) * kStep_s);
  return {};
}

}  // namespace sidestep
