// SPDX-License-Identifier: Apache-2.0
#include "tests/study/problems/replan_course.hpp"

#include <cmath>

#include "agents/planning/fallback_goal.hpp"

namespace sidestep {
namespace {

constexpr double kGoalTolerance_m = 0.1;

/// The position at `length_m` along a path, or the end of a shorter path.
Vec2 position_on(const std::vector<Vec2>& path, double length_m) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double leg_m = (path[i] - path[i - 1]).norm();
    if (leg_m >= length_m && leg_m > 0) return path[i - 1] + length_m / leg_m * (path[i] - path[i - 1]);
    length_m -= leg_m;
  }
  return path.back();
}

}  // namespace

ReplanCourse::ReplanCourse(std::size_t cycles, std::uint64_t seed)
    : world_(make_world("circles", cycles, seed)),
      obstacles_(world_.obstacles),
      position_m_(world_.queries[0].start_m) {
  Rng rng(seed);
  for (std::size_t i = 0; i < world_.obstacles.size(); ++i)
    velocities_mps_.push_back(rotated({kObstacleSpeed_mps, 0}, rng.uniform(0, 6.283185307179586)));
  path_.states = {position_m_};
  path_.reason = PlanReason::kSolved;
}

void ReplanCourse::step() {
  position_m_ = position_on(path_.states, kSpeed_mps * kCycle_s);
  if (!path_.arrives()) goal_ = (goal_ + 1) % world_.queries.size();
  move_circles();
  if ((world_.queries[goal_].goal_m - position_m_).norm() < kGoalTolerance_m)
    goal_ = (goal_ + 1) % world_.queries.size();
  Rng rng(0);  // unused: the driver does not sample
  path_ = plan_with_fallback_goal(driver_, domain(), position_m_, {}, rng);
}

DiscDomain ReplanCourse::domain(const DiscDomainSettings& settings) const {
  return {obstacles_, world_.field, world_.radius_m, position_m_, world_.queries[goal_].goal_m, settings};
}

bool ReplanCourse::is_valid(const std::vector<Vec2>& path_m) const {
  PlanWorld now = world_;
  for (std::uint32_t i = 0; i < now.obstacles.size(); ++i) now.obstacles[i] = obstacles_.shape(ObstacleId{i});
  return !is_free(now, path_m.front()) || is_valid_path(now, path_m, 1e-9);
}

void ReplanCourse::move_circles() {
  for (std::uint32_t i = 0; i < velocities_mps_.size(); ++i) {
    const Vec2 at = std::get<Circle>(obstacles_.shape(ObstacleId{i})).centre_m;
    Vec2& velocity = velocities_mps_[i];
    if (at.x() * velocity.x() > 0 && std::abs(at.x()) > world_.field.length_m / 2) velocity.x() *= -1;
    if (at.y() * velocity.y() > 0 && std::abs(at.y()) > world_.field.width_m / 2) velocity.y() *= -1;
    obstacles_.move(ObstacleId{i}, kCycle_s * velocity);
  }
}

}  // namespace sidestep
