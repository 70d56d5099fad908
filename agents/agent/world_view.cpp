// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/world_view.hpp"

#include <algorithm>
#include <cmath>

#include "common/messaging/senders.hpp"
#include "common/messaging/version_codec.hpp"

namespace sidestep {
namespace {

constexpr double kMaxRadius_m = 10;

// The comparisons are false for NaN.
bool is_valid(const ObservedObstacle& obstacle) {
  return std::abs(obstacle.position_m.x()) <= kMaxCoordinate_m &&
         std::abs(obstacle.position_m.y()) <= kMaxCoordinate_m && obstacle.radius_m >= 0 &&
         obstacle.radius_m <= kMaxRadius_m && obstacle.position_variance_m2 >= 0 &&
         obstacle.position_variance_m2 <= kMaxRadius_m;
}

ObservedObstacle obstacle_from(const msg::TrackedObstacle& message) {
  return {message.obstacle(),
          time_from_ns(message.observed_at_ns()),
          {message.x_m(), message.y_m()},
          message.radius_m(),
          message.position_variance_m2()};
}

PoseFix fix_from(const msg::TrackedRobot& message) {
  return {time_from_ns(message.observed_at_ns()),
          {message.observed_x_m(), message.observed_y_m()},
          message.observed_heading_rad()};
}

}  // namespace

WorldObservations WorldView::decode(const msg::WorldState& message) {
  WorldObservations world;
  if (message.header().sender() != static_cast<std::uint32_t>(Sender::kVision)) {
    ++invalid_;
    return world;
  }
  world.vision = message.header().incarnation();
  decode_obstacles(message, world);
  if (const msg::TrackedRobot* self = find_self(message)) {
    const PoseFix fix = fix_from(*self);
    if (fix.position_m.allFinite() && std::isfinite(fix.heading_rad))
      world.self = fix;
    else
      ++invalid_;
  }
  return world;
}

void WorldView::decode_obstacles(const msg::WorldState& message, WorldObservations& world) {
  if (message.obstacle_count() > msg::MAX_OBSTACLES) {
    ++invalid_;
    return;
  }
  for (std::size_t i = 0; i < message.obstacle_count(); ++i) {
    const ObservedObstacle obstacle = obstacle_from(message.obstacles()[i]);
    if (is_valid(obstacle))
      world.obstacles[world.obstacle_count++] = obstacle;
    else
      ++invalid_;
  }
}

const msg::TrackedRobot* WorldView::find_self(const msg::WorldState& message) {
  const auto& robots = message.robots();
  // The index rarely changes between messages.
  if (index_ >= robots.size() || robots[index_].robot() != robot_) {
    const auto found = std::ranges::find_if(robots, [&](const auto& r) { return r.robot() == robot_; });
    index_ = static_cast<std::size_t>(found - robots.begin());
  }
  return index_ < robots.size() ? &robots[index_] : nullptr;
}

}  // namespace sidestep
