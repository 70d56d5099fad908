// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/funnel.hpp"

namespace sidestep {
namespace {

/// One side of the funnel: the end of a portal that the path may have to turn around.
struct FunnelSide {
  Vec2 at_m;
  std::size_t portal;
};

/// Positive if c lies to the left of the line from a to b.
double side_of(const Vec2& a, const Vec2& b, const Vec2& c) { return cross(b - a, c - a); }

}  // namespace

void write_shortest_through(const Vec2& from, std::span<const PortalEdge> portals, const Vec2& to,
                            std::vector<Vec2>& path) {
  path.assign(1, from);
  FunnelSide left{from, 0}, right{from, 0};
  // The path turns at this side, and the funnel restarts from there.
  const auto turn_at = [&](const FunnelSide& corner) {
    if (corner.at_m != path.back()) path.push_back(corner.at_m);
    const FunnelSide apex = corner;
    left = right = apex;
    return apex.portal + 1;
  };
  for (std::size_t i = 0; i <= portals.size();) {
    const Vec2& apex = path.back();
    const PortalEdge portal = i < portals.size() ? portals[i] : PortalEdge{to, to};
    if (side_of(apex, right.at_m, portal.right_m) >= 0) {
      if (right.at_m != apex && left.at_m != apex && side_of(apex, left.at_m, portal.right_m) > 0) {
        i = turn_at(left);
        continue;
      }
      right = {portal.right_m, i};
    }
    if (side_of(apex, left.at_m, portal.left_m) <= 0) {
      if (left.at_m != apex && right.at_m != apex && side_of(apex, right.at_m, portal.left_m) < 0) {
        i = turn_at(right);
        continue;
      }
      left = {portal.left_m, i};
    }
    ++i;
  }
  if (path.back() != to) path.push_back(to);
}

}  // namespace sidestep
