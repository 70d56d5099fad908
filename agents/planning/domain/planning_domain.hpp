// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <optional>

#include "common/random/rng.hpp"

namespace sidestep {

/// The interface between planners and the problems they solve (Bruce 2006, section 4.5): states and their
/// distances, motions between them, random states, and the goal.
///
/// - `distance(a, b)`: cost of the motion from a to b without obstacles; 0 only if a and b are equivalent.
/// - `extend(from, to)`: the state that a free motion from `from` towards `to` reaches: exactly `to`, or a
/// state nearer to it; nullopt if there is no progress. The motion may end after one step or continue until
/// it is blocked.
/// - `check(from, to)`: whether the whole motion is free; `check(a, a)` checks a state.
/// - `sample(rng)`: a state to grow towards, free or not.
/// - `goal(from)`: the goal state for a path from `from`. It may differ between states (the tangent of an
/// orbit); a state has arrived if its distance from its goal is 0.
template <typename D>
concept PlanningDomain = requires(const D& domain, const typename D::State& a, Rng& rng) {
  requires std::copyable<typename D::State>;
  { domain.distance(a, a) } -> std::convertible_to<double>;
  { domain.extend(a, a) } -> std::same_as<std::optional<typename D::State>>;
  { domain.check(a, a) } -> std::same_as<bool>;
  { domain.sample(rng) } -> std::same_as<typename D::State>;
  { domain.goal(a) } -> std::same_as<typename D::State>;
};

/// A domain whose distance is the Euclidean distance between the coordinates of its states, as a K-D tree for
/// nearest neighbours requires.
template <typename D>
concept EuclideanDomain = PlanningDomain<D> && requires(const D& domain, const typename D::State& a) {
  { domain.coordinates(a) } -> std::same_as<std::array<double, D::kDimensions>>;
};

/// A domain whose motions are symmetric and pass through intermediate states: `between(a, b, fraction)` is
/// the state after that fraction of the distance. Required by trees that grow from the goal and by smoothing.
template <typename D>
concept StraightDomain = PlanningDomain<D> && requires(const D& domain, const typename D::State& a) {
  { domain.between(a, a, 0.5) } -> std::same_as<typename D::State>;
};

}  // namespace sidestep
