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

/// An obstacle that routes avoid only temporarily: a robot at rest, or a moving obstacle.
struct TemporaryObstacle {
  Circle circle;
  std::optional<RobotId> robot{};
};

/// All obstacles that routes avoid. Temporary obstacles are moved within the world, which is not rebuilt.
class RouteObstacles {
 public:
  RouteObstacles(const FloorRules& rules, const ZoneMap& zones);

  /// Replaces the temporary obstacles. Returns whether any has changed.
  bool set_temporary(std::span<const TemporaryObstacle> obstacles);

  const ObstacleWorld& world() const { return world_; }
  /// The world without the temporary obstacles.
  ObstacleWorld fixed_world() const;
  /// Describes the obstacle as the cause of a blocked goal. Does not set the place to which the robot goes
  /// instead.
  Blockage blockage(ObstacleId obstacle) const;

 private:
  struct Temporary {
    TemporaryObstacle obstacle;
    ObstacleId id{};
  };

  ObstacleWorld world_;
  std::map<ObstacleId, Blockage> zones_;
  std::vector<Temporary> temporary_;
};

}  // namespace sidestep
