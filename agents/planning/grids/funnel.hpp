// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// A border between two convex cells, as seen when passing through it.
struct Gate {
  Vec2 left_m, right_m;
};

/// Writes the shortest path that leads through all gates in their order, using the funnel algorithm (Lee and
/// Preparata 1984). The path is straight between gates. It starts with `from`, ends with `to`, and otherwise
/// consists of ends of gates.
void write_shortest_through(const Vec2& from_m, std::span<const Gate> gates, const Vec2& to_m,
                            std::vector<Vec2>& path_m);

}  // namespace sidestep
