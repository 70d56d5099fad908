// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// The edge shared by two convex cells, as seen when passing through the portal between them.
struct PortalEdge {
  Vec2 left_m, right_m;
};

/// Writes the shortest path that leads through all portals in their order, using the funnel algorithm (Lee
/// and Preparata 1984). The path is straight between portals. It starts with `from`, ends with `to`, and
/// otherwise consists of ends of portals.
void write_shortest_through(const Vec2& from_m, std::span<const PortalEdge> portals, const Vec2& to_m,
                            std::vector<Vec2>& path_m);

}  // namespace sidestep
