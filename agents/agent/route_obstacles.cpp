// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/route_obstacles.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace sidestep {

namespace {

std::vector<Shape> fixed_obstacles(const FloorRules& rules) {
  std::vector<Shape> shapes = rules.obstacles;
  if (rules.map) std::ranges::copy(rules.map->boxes_on(rules.field), std::back_inserter(shapes));
  return shapes;
}

}  // namespace

RouteObstacles::RouteObstacles(const FloorRules& rules, const ZoneMap& zones)
    : world_(fixed_obstacles(rules)) {
  for (std::size_t i = 0; i < zones.keep_outs().size(); ++i)
    zones_[world_.add(zones.keep_outs()[i])] = {msg::BlockReason::BLOCK_ZONE, zones.keep_out_numbers()[i]};
}

bool RouteObstacles::set_temporary(std::span<const TemporaryObstacle> obstacles) {
  const auto is_same = [](const TemporaryObstacle& a, const TemporaryObstacle& b) {
    return a.circle.centre_m == b.circle.centre_m && a.circle.radius_m == b.circle.radius_m &&
           a.robot == b.robot;
  };
  if (std::ranges::equal(obstacles, temporary_, is_same, {}, &Temporary::obstacle)) return false;
  std::vector<Temporary> before = std::exchange(temporary_, {});
  for (const TemporaryObstacle& obstacle : obstacles) {
    // Any previous obstacle of the same size can be moved to the new place.
    const auto found = std::ranges::find_if(before, [&](const Temporary& other) {
      return other.obstacle.circle.radius_m == obstacle.circle.radius_m;
    });
    if (found == before.end()) {
      temporary_.push_back({obstacle, world_.add(obstacle.circle)});
      continue;
    }
    world_.move(found->id, obstacle.circle.centre_m - std::get<Circle>(world_.shape(found->id)).centre_m);
    temporary_.push_back({obstacle, found->id});
    before.erase(found);
  }
  for (const Temporary& gone : before) world_.remove(gone.id);
  return true;
}

ObstacleWorld RouteObstacles::fixed_world() const {
  ObstacleWorld world = world_;
  for (const Temporary& temporary : temporary_) world.remove(temporary.id);
  return world;
}

Blockage RouteObstacles::blockage(ObstacleId obstacle) const {
  using enum msg::BlockReason;
  if (const auto zone = zones_.find(obstacle); zone != zones_.end()) return zone->second;
  const auto temporary = std::ranges::find(temporary_, obstacle, &Temporary::id);
  if (temporary == temporary_.end()) return {BLOCK_OBSTACLE, 0, centre_m(world_.shape(obstacle))};
  const auto& [circle, robot] = temporary->obstacle;
  return {robot ? BLOCK_ROBOT : BLOCK_OBSTACLE, robot.value_or(0), circle.centre_m};
}

}  // namespace sidestep
