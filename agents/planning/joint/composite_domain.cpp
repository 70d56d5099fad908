// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/composite_domain.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kJointStep_m = 1;  ///< maximum motion of each robot in one extension
// Probabilities that a robot's part of a sample is its start, or its goal. Otherwise it is a random free
// position.
constexpr double kJointStartProbability = 0.15, kJointGoalProbability = 0.15;

}  // namespace

double CompositeDomain::distance(const State& a, const State& b) const {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum);
}

bool CompositeDomain::is_clear_of_obstacles(const Vec2& from, const Vec2& to) const {
  const double distance_m = problem_->distance_from_obstacles_m();
  return problem_->field.contains(from, distance_m) && problem_->field.contains(to, distance_m) &&
         !problem_->world->touches(from, to, distance_m);
}

bool CompositeDomain::are_clear(const State& from, const State& to, std::size_t i, std::size_t j) const {
  // The relative position also moves on a straight line.
  const Segment relative{from[i] - from[j], to[i] - to[j]};
  const double separation_m = problem_->min_separation_m() + kJointTolerance_m;
  return squared_distance(Vec2(0, 0), relative) >= separation_m * separation_m;
}

std::optional<CompositeDomain::State> CompositeDomain::extend(const State& from, const State& to) const {
  State reached = from;
  bool has_moved = false;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec2 way = to[i] - from[i];
    const double length = way.norm();
    if (length == 0) continue;
    reached[i] = length <= kJointStep_m ? to[i] : Vec2(from[i] + kJointStep_m / length * way);
    bool is_clear = is_clear_of_obstacles(from[i], reached[i]);
    for (std::size_t j = 0; j < from.size() && is_clear; ++j)
      is_clear = j == i || are_clear(from, reached, i, j);
    if (is_clear)
      has_moved = true;
    else
      reached[i] = from[i];
  }
  return has_moved ? std::optional(reached) : std::nullopt;
}

bool CompositeDomain::check(const State& from, const State& to) const {
  for (std::size_t i = 0; i < from.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!are_clear(from, to, i, j)) return false;
  for (std::size_t i = 0; i < from.size(); ++i)
    if (!is_clear_of_obstacles(from[i], to[i])) return false;
  return true;
}

Vec2 CompositeDomain::sample_free(Rng& rng) const {
  constexpr int kMaxAttempts = 20;
  Vec2 position(0, 0);
  for (int i = 0; i < kMaxAttempts; ++i) {
    const double y = rng.uniform(-0.5, 0.5) * problem_->field.width_m,
                 x = rng.uniform(-0.5, 0.5) * problem_->field.length_m;
    position = {x, y};
    if (is_clear_of_obstacles(position, position)) break;
  }
  return position;
}

CompositeDomain::State CompositeDomain::sample(Rng& rng) const {
  State state(problem_->robots());
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double chance = rng.uniform();
    if (chance < kJointStartProbability)
      state[i] = problem_->starts_m[i];
    else if (chance < kJointStartProbability + kJointGoalProbability)
      state[i] = problem_->goals_m[i];
    else
      state[i] = sample_free(rng);
  }
  return state;
}

CompositeDomain::State CompositeDomain::between(const State& a, const State& b, double fraction) const {
  State state(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) state[i] = a[i] + fraction * (b[i] - a[i]);
  return state;
}

}  // namespace sidestep
