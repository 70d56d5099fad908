// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/obstacle_list_decoder.hpp"

#include <algorithm>
#include <cmath>

#include "common/messaging/version_codec.hpp"
#include "common/protocol/obstacle_bounds.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

constexpr double kMaxRadius_m = 10, kMaxVariance_m2 = 10;

// The comparisons are false for NaN.
bool is_possible(const ObservedObstacle& obstacle) {
  return std::abs(obstacle.position_m.x()) <= kMaxCoordinate_m &&
         std::abs(obstacle.position_m.y()) <= kMaxCoordinate_m && obstacle.radius_m >= 0 &&
         obstacle.radius_m <= kMaxRadius_m && obstacle.position_variance_m2 >= 0 &&
         obstacle.position_variance_m2 <= kMaxVariance_m2;
}

bool is_possible(const msg::ObstacleList& message) {
  return message.complete_within_m() >= 0 && message.complete_within_m() <= kCompleteEverywhere_m &&
         message.obstacles().size() <= msg::MAX_OBSTACLES;
}

ObservedObstacle obstacle_from(const msg::TrackedObstacle& message) {
  return {message.obstacle(), time_from_ns(message.observed_at_ns()), {message.x_m(), message.y_m()},
          message.radius_m(), message.position_variance_m2(),         {message.vx_mps(), message.vy_mps()}};
}

}  // namespace

std::optional<ObstacleObservations> ObstacleListDecoder::decode(const msg::ObstacleList& message) {
  if (!is_possible(message)) return std::nullopt;
  obstacles_.clear();
  for (const msg::TrackedObstacle& obstacle : message.obstacles())
    obstacles_.push_back(obstacle_from(obstacle));
  if (!std::ranges::all_of(obstacles_, [](const ObservedObstacle& o) { return is_possible(o); }))
    return std::nullopt;
  return ObstacleObservations{message.header().incarnation(), time_from_ns(message.valid_at_ns()),
                              message.complete_within_m(), obstacles_};
}

}  // namespace sidestep
