// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <optional>

#include "common/random/rng.hpp"

namespace sidestep {

/// All that a planner knows of what it plans for (Bruce 2006, section 4.6): states and how far they are
/// apart, motions between them, states drawn at random, and the goal.
///
/// - `distance(a, b)`: what the motion from a to b costs if nothing is in its way; 0 only where a is as good
///   as b.
/// - `extend(from, to)`: the state that a free motion from `from` comes to on its way to `to`: `to` itself,
///   the very same value, or a state nearer to it; none when nothing is gained. It may end after a step or go
///   on as far as it is free.
/// - `check(from, to)`: whether the whole motion is free; `check(a, a)` asks for a state.
/// - `sample(rng)`: a state to grow towards, free or not.
/// - `goal(from)`: the state to make for from here. It may differ from state to state (an orbit's tangent); a
///   state has arrived when its distance from its goal is 0.
template <typename D>
concept PlanningDomain = requires(const D& domain, const typename D::State& a, Rng& rng) {
  requires std::copyable<typename D::State>;
  { domain.distance(a, a) } -> std::convertible_to<double>;
  { domain.extend(a, a) } -> std::same_as<std::optional<typename D::State>>;
  { domain.check(a, a) } -> std::same_as<bool>;
  { domain.sample(rng) } -> std::same_as<typename D::State>;
  { domain.goal(a) } -> std::same_as<typename D::State>;
};

/// A domain whose distance is the Euclidean one between its states' coordinates, so that neighbours can be
/// looked up in a tree.
template <typename D>
concept EuclideanDomain = PlanningDomain<D> && requires(const D& domain, const typename D::State& a) {
  { domain.coordinates(a) } -> std::same_as<std::array<double, D::kDimensions>>;
};

/// A domain whose motions lead through states of their own, both ways the same: `between(a, b, part)` is the
/// one after `part` of the distance. Backward trees and smoothing need it.
template <typename D>
concept StraightDomain = PlanningDomain<D> && requires(const D& domain, const typename D::State& a) {
  { domain.between(a, a, 0.5) } -> std::same_as<typename D::State>;
};

}  // namespace sidestep
