// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/space_time_domain.hpp"

#include <algorithm>

#include "agents/planning/joint/leg.hpp"

namespace sidestep {
namespace {

// Probabilities that a sample is the start (to wait there) or the goal (to arrive later), at a random time.
constexpr double kWaitProbability = 0.1, kArrivalProbability = 0.2;
/// Samples are at most this much later than the end of all courses, in addition to twice the straight drive.
constexpr double kSpare_s = 1;

}  // namespace

SpaceTimeDomain::SpaceTimeDomain(const JointProblem& problem, std::size_t robot,
                                 std::span<const Course> others)
    : problem_(&problem), robot_(robot), others_(others) {
  Time end{};
  for (const Course& course : others_) end = std::max(end, course.end());
  const Time direct = earliest_arrival(start(), goal_m());
  horizon_s_ = to_seconds(end - Time{}) + 2 * to_seconds(direct - Time{}) + kSpare_s;
}

Time SpaceTimeDomain::earliest_arrival(const State& from, const Vec2& to_m) const {
  return from.at + leg_times((to_m - from.at_m).norm(), problem_->limits).total();
}

double SpaceTimeDomain::distance(const State& a, const State& b) const {
  constexpr double kTooEarly_s = 1000;
  const Time arrival = earliest_arrival(a, b.at_m);
  if (arrival <= b.at) return to_seconds(b.at - a.at);
  return kTooEarly_s + to_seconds(arrival - b.at);
}

Trajectory SpaceTimeDomain::motion(const State& from, const State& to) const {
  const LegTimes times = leg_times((to.at_m - from.at_m).norm(), problem_->limits);
  const Trajectory leg = make_leg(to.at - times.total(), from.at_m, to.at_m, times);
  Trajectory motion = Trajectory::resting(from.at, from.at_m);
  if (leg.start() > from.at) motion.append(leg.start() - from.at, Vec2::Zero());
  for (const MotionPhase& phase : leg.phases()) motion.append(phase.duration, phase.acceleration_mps2);
  return motion;
}

bool SpaceTimeDomain::is_free(const State& from, const State& to) const {
  const double distance_m = problem_->distance_from_obstacles_m();
  if (!problem_->field.contains(from.at_m, distance_m) || !problem_->field.contains(to.at_m, distance_m) ||
      problem_->world->touches(from.at_m, to.at_m, distance_m))
    return false;
  const Trajectory driven = motion(from, to);
  const Time until = to.at_m == goal_m() ? Time::max() : to.at;
  const double separation_m = problem_->min_separation_m() + kJointTolerance_m;
  return std::ranges::all_of(
      others_, [&](const Course& other) { return is_clear(other, driven, until, separation_m); });
}

bool SpaceTimeDomain::check(const State& from, const State& to) const {
  return to.at >= earliest_arrival(from, to.at_m) && is_free(from, to);
}

std::optional<SpaceTimeState> SpaceTimeDomain::extend(const State& from, const State& to) const {
  const State later{to.at_m, std::max(to.at, earliest_arrival(from, to.at_m))};
  if (later == from) return std::nullopt;
  if (is_free(from, later)) return later;
  for (const double part : {0.5, 0.25}) {
    const Vec2 at_m = from.at_m + part * (to.at_m - from.at_m);
    const State nearer{at_m, earliest_arrival(from, at_m)};
    if (nearer.at > from.at && is_free(from, nearer)) return nearer;
  }
  return std::nullopt;
}

SpaceTimeState SpaceTimeDomain::goal(const State& from) const {
  return {goal_m(), earliest_arrival(from, goal_m())};
}

SpaceTimeState SpaceTimeDomain::sample(Rng& rng) const {
  const Time at = Time{} + from_seconds(rng.uniform(0, horizon_s_));
  const double chance = rng.uniform();
  if (chance < kWaitProbability) return {start().at_m, at};
  if (chance < kWaitProbability + kArrivalProbability) return {goal_m(), at};
  const double y = rng.uniform(-0.5, 0.5) * problem_->field.width_m,
               x = rng.uniform(-0.5, 0.5) * problem_->field.length_m;
  return {{x, y}, at};
}

}  // namespace sidestep
