// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "agents/planning/domain/planning_domain.hpp"
#include "agents/planning/joint/joint_plan.hpp"

namespace sidestep {

/// At rest at a position at a time.
struct SpaceTimeState {
  Vec2 at_m{0, 0};
  Time at{};
  bool operator==(const SpaceTimeState&) const = default;
};

struct SpaceTimeSettings {
  /// Probabilities that a sample is the start, or the goal, at a random time: to wait there, or to arrive
  /// later.
  double start_probability = 0.1, goal_probability = 0.2;
  /// Samples are up to this much later than the end of all courses, beyond twice the straight drive.
  double spare_s = 1;
};

/// One robot among others that follow fixed courses: space × time. In a motion, the robot waits where it is,
/// then drives straight from rest to rest, as fast as its limits allow, and arrives at the state's time. A
/// motion to the goal is free only if the robot can stay there for ever. Time passes, so motions are one-way.
/// Refers to the problem and the courses, which have to outlive it.
class SpaceTimeDomain {
 public:
  using State = SpaceTimeState;

  SpaceTimeDomain(const JointProblem& problem, std::size_t robot, std::span<const Course> others,
                  const SpaceTimeSettings& settings = {});

  State start() const { return {problem_->starts_m[robot_], Time{}}; }
  /// The time from a to b in seconds; more than a thousand if b is too early for that.
  double distance(const State& a, const State& b) const;
  /// The motion to `to`, or later to its position if it is too early, or else to a position on the way.
  std::optional<State> extend(const State& from, const State& to) const;
  bool check(const State& from, const State& to) const;
  State sample(Rng& rng) const;
  /// The goal at the time at which the straight motion arrives.
  State goal(const State& from) const;

  /// The time at which a motion that begins at once arrives.
  Time earliest_arrival(const State& from, const Vec2& to_m) const;
  /// Waiting, then driving. Precondition: the state is not too early.
  Trajectory motion(const State& from, const State& to) const;

 private:
  const Vec2& goal_m() const { return problem_->goals_m[robot_]; }
  bool is_free(const State& from, const State& to) const;

  const JointProblem* problem_;
  std::size_t robot_;
  std::span<const Course> others_;
  SpaceTimeSettings settings_;
  double horizon_s_ = 0;
};

static_assert(PlanningDomain<SpaceTimeDomain>);

}  // namespace sidestep
