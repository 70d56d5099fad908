// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "agents/safety/safety_search.hpp"

namespace sidestep {

/// Up to kMax accelerations, the best first.
struct CreepAccelerations {
  static constexpr std::size_t kMax = 16;
  std::array<Vec2, kMax> mps2;
  std::size_t count = 0;

  std::span<const Vec2> all() const { return std::span(mps2).first(count); }
};

/// The accelerations with which a robot creeps away from all strangers that may reach it before it stops from
/// creeping, or from the nearest one that may reach it soon; those that lead away most directly first. Empty
/// if there is no such stranger, if the robot is faster than it may creep, or if each direction leads nearer
/// to one of the strangers. `min_separation_m` is the robot's radius plus the margin. Allocates
/// nothing, and takes time in proportion to the number of strangers.
[[nodiscard]] CreepAccelerations accelerations_away(const SearchQuery& query, double min_separation_m);

}  // namespace sidestep
