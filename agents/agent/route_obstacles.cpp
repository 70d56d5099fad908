// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/route_obstacles.hpp"

namespace sidestep {

RouteObstacles::RouteObstacles(std::span<const Shape> fixed, const ZoneMap& zones,
                               std::span<const TemporaryObstacle> temporary) {
  using enum msg::BlockReason;
  for (const Shape& shape : fixed) {
    shapes_.push_back(shape);
    blockages_.push_back({BLOCK_OBSTACLE, 0, centre_m(shape)});
  }
  for (const TemporaryObstacle& obstacle : temporary) {
    shapes_.emplace_back(obstacle.circle);
    blockages_.push_back({obstacle.robot ? BLOCK_ROBOT : BLOCK_OBSTACLE, obstacle.robot.value_or(0),
                          obstacle.circle.centre_m});
  }
  for (std::size_t i = 0; i < zones.keep_outs().size(); ++i) {
    shapes_.push_back(zones.keep_outs()[i]);
    blockages_.push_back({BLOCK_ZONE, zones.keep_out_numbers()[i]});
  }
}

}  // namespace sidestep
