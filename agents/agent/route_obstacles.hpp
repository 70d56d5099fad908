// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "agents/navigation/zone_map.hpp"
#include "common/collision/shapes.hpp"
#include "common/protocol/order.hpp"

namespace sidestep {

/// An obstacle that routes lead around only for now: a robot at rest, or a moving obstacle.
struct TemporaryObstacle {
  Circle circle;
  std::optional<RobotId> robot{};
};

/// Everything that routes lead around.
class RouteObstacles {
 public:
  RouteObstacles(std::span<const Shape> fixed, const ZoneMap& zones,
                 std::span<const TemporaryObstacle> temporary);

  const std::vector<Shape>& shapes() const { return shapes_; }
  /// What the obstacle with this index in shapes() is, if it covers a goal. Without the nearest place.
  Blockage blockage(std::size_t index) const { return blockages_[index]; }

 private:
  std::vector<Shape> shapes_;
  std::vector<Blockage> blockages_;
};

}  // namespace sidestep
