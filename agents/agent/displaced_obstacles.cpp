// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/displaced_obstacles.hpp"

#include <cmath>

#include "common/messaging/observation_codec.hpp"
#include "common/protocol/obstacle_bounds.hpp"

namespace sidestep {
void DisplacedObstacles::on_heartbeat(const CoordinatorHeartbeat& heartbeat, Time now) {
  bodies_.clear();
  for (const msg::RobotNotice& notice : heartbeat.notices) {
    if (!is_uncontrolled(notice) || notice.robot() == self_) continue;
    const auto seen = decode(notice, now);
    if (!seen) continue;
    const double error_m = kObstacleSigmas * std::sqrt(seen->position_variance_m2);
    bodies_.push_back({{seen->position_m, radius_m_ + error_m, seen->observed_at - max_clock_difference_,
                        max_speed_mps_, seen->velocity_mps},
                       2 * radius_m_ + margin_m_});
  }
}

std::span<const UncontrolledBody> DisplacedObstacles::recent(Time now, Duration max_lag) {
  std::erase_if(bodies_, [=, this](const UncontrolledBody& body) {
    return now - body.reach.observed_at > kMaxObservationAge + max_clock_difference_;
  });
  if (max_lag == Duration{0}) return bodies_;
  recent_ = bodies_;
  for (UncontrolledBody& body : recent_) body.reach.observed_at -= max_lag;
  return recent_;
}

}  // namespace sidestep
