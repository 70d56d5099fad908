// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "agents/navigation/zone_map.hpp"
#include "common/collision/obstacle_world.hpp"
#include "common/motion/floor_rules.hpp"
#include "common/protocol/order.hpp"

namespace sidestep {

/// An obstacle that routes lead around only for now: a robot at rest, or a moving obstacle.
struct TemporaryObstacle {
  Circle circle;
  std::optional<RobotId> robot{};
};

/// Everything that routes lead around. Temporary obstacles are moved; the world is not built again.
class RouteObstacles {
 public:
  RouteObstacles(const FloorRules& rules, const ZoneMap& zones);

  /// Replaces the temporary obstacles. Returns whether any has changed.
  bool set_temporary(std::span<const TemporaryObstacle> obstacles);

  const ObstacleWorld& world() const { return world_; }
  /// The world without the temporary obstacles.
  ObstacleWorld fixed_world() const;
  /// What the obstacle is, if it covers a goal. Without the nearest place.
  Blockage blockage(ObstacleId obstacle) const;

 private:
  struct Temporary {
    TemporaryObstacle obstacle;
    ObstacleId id;
  };

  ObstacleWorld world_;
  std::map<ObstacleId, Blockage> zones_;
  std::vector<Temporary> temporary_;
};

}  // namespace sidestep
