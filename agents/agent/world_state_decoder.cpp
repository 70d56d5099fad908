// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/world_state_decoder.hpp"

#include <algorithm>
#include <cmath>

#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

PoseFix fix_from(const msg::TrackedRobot& message) {
  return {time_from_ns(message.observed_at_ns()),
          {message.observed_x_m(), message.observed_y_m()},
          message.observed_heading_rad()};
}

}  // namespace

WorldObservations WorldStateDecoder::decode(const msg::WorldState& message) {
  WorldObservations world;
  world.vision = message.header().incarnation();
  world.valid_at = time_from_ns(message.valid_at_ns());
  if (const msg::TrackedRobot* self = find_self(message)) {
    const PoseFix fix = fix_from(*self);
    const Vec2 position(self->x_m(), self->y_m());
    if (fix.position_m.allFinite() && std::isfinite(fix.heading_rad) && position.allFinite()) {
      world.self = fix;
      world.self_m = position;
      world.is_self_seen_elsewhere = self->is_seen_elsewhere();
    } else {
      ++invalid_;
    }
  }
  return world;
}

const msg::TrackedRobot* WorldStateDecoder::find_self(const msg::WorldState& message) {
  const auto& robots = message.robots();
  // The index rarely changes between messages.
  if (index_ >= robots.size() || robots[index_].robot() != robot_) {
    const auto found = std::ranges::find_if(robots, [&](const auto& r) { return r.robot() == robot_; });
    index_ = static_cast<std::size_t>(found - robots.begin());
  }
  return index_ < robots.size() ? &robots[index_] : nullptr;
}

}  // namespace sidestep
