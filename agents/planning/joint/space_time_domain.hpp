// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "agents/planning/domain/planning_domain.hpp"
#include "agents/planning/joint/joint_plan.hpp"

namespace sidestep {

/// A robot at rest at a position at a time.
struct SpaceTimeState {
  Vec2 at_m{0, 0};
  Time at{};
  bool operator==(const SpaceTimeState&) const = default;
};

/// Planning in space × time for one robot among others that follow fixed courses. In a motion, the robot
/// waits where it is, then drives straight from rest to rest, as fast as its limits allow, and arrives at the
/// state's time. A motion to the goal is free only if the robot can stay there forever. Motions are one-way,
/// because time passes. Keeps references to the problem and the courses, which must outlive it.
class SpaceTimeDomain {
 public:
  using State = SpaceTimeState;

  SpaceTimeDomain(const JointProblem& problem, std::size_t robot, std::span<const Course> others);

  State start() const { return {problem_->starts_m[robot_], Time{}}; }
  /// The time from a to b in seconds; more than a thousand if b is too early to be reached from a.
  double distance(const State& a, const State& b) const;
  /// Returns `to` or, if `to` is too early, its position at the earliest possible time. If that motion is
  /// blocked, returns a position on the way.
  std::optional<State> extend(const State& from, const State& to) const;
  bool check(const State& from, const State& to) const;
  State sample(Rng& rng) const;
  /// The goal, with the time at which a straight motion reaches it.
  State goal(const State& from) const;

  /// The arrival time of a motion that starts immediately.
  Time earliest_arrival(const State& from, const Vec2& to_m) const;
  /// The motion: waiting, then driving. Precondition: the robot can reach `to` in time.
  Trajectory motion(const State& from, const State& to) const;

 private:
  const Vec2& goal_m() const { return problem_->goals_m[robot_]; }
  bool is_free(const State& from, const State& to) const;

  const JointProblem* problem_;
  std::size_t robot_;
  std::span<const Course> others_;
  double horizon_s_ = 0;
};

static_assert(PlanningDomain<SpaceTimeDomain>);

}  // namespace sidestep
