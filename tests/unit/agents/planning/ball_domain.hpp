// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "agents/planning/domain/plan.hpp"

namespace sidestep {

/// A point in the cube [-1, 1]³ among balls: a domain that is unrelated to the floor and does not expose
/// coordinates to planners.
class BallDomain {
 public:
  using State = std::array<double, 3>;
  struct Ball {
    State centre;
    double radius;
  };

  BallDomain(std::vector<Ball> balls, const State& goal) : balls_(std::move(balls)), goal_(goal) {}

  double distance(const State& a, const State& b) const {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  }
  std::optional<State> extend(const State& from, const State& to) const {
    constexpr double kStep = 0.2;
    const double far = distance(from, to);
    if (far == 0) return std::nullopt;
    const State end = far <= kStep ? to : between(from, to, kStep / far);
    return check(from, end) ? std::optional(end) : std::nullopt;
  }
  bool check(const State& from, const State& to) const {
    return std::none_of(balls_.begin(), balls_.end(), [&](const Ball& ball) {
      const double far = distance(from, to);
      double along = 0;
      for (std::size_t i = 0; i < 3; ++i) along += (ball.centre[i] - from[i]) * (to[i] - from[i]);
      const double part = far > 0 ? std::clamp(along / (far * far), 0.0, 1.0) : 0.0;
      return distance(ball.centre, between(from, to, part)) <= ball.radius;
    });
  }
  State sample(Rng& rng) const { return {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)}; }
  State goal(const State&) const { return goal_; }
  State between(const State& a, const State& b, double part) const {
    State state;
    for (std::size_t i = 0; i < 3; ++i) state[i] = a[i] + part * (b[i] - a[i]);
    return state;
  }

 private:
  std::vector<Ball> balls_;
  State goal_;
};

static_assert(StraightDomain<BallDomain> && !EuclideanDomain<BallDomain>);

}  // namespace sidestep
