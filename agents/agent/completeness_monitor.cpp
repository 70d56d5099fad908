// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/completeness_monitor.hpp"

#include <algorithm>

#include "common/protocol/obstacle_bounds.hpp"

namespace sidestep {

void CompletenessMonitor::on_world_state(const WorldObservations& world) {
  if (!world.self) return;
  positions_[position_count_++ % positions_.size()] = {world.vision, world.valid_at, world.self_m};
  combine();
}

void CompletenessMonitor::on_list(const ObstacleObservations& list) {
  if (list.valid_at <= complete_at_) return;
  if (list.complete_within_m >= kCompleteEverywhere_m) {
    seen_ = {};
    complete_at_ = list.valid_at;
  } else if (!pending_ || list.valid_at > pending_->valid_at) {
    pending_ = {list.vision, list.valid_at, list.complete_within_m};
    combine();
  }
}

void CompletenessMonitor::combine() {
  if (!pending_ || pending_->valid_at <= complete_at_) return;
  const auto end =
      positions_.begin() + static_cast<std::ptrdiff_t>(std::min(position_count_, positions_.size()));
  const auto found = std::find_if(positions_.begin(), end, [&](const OwnPosition& own) {
    return own.vision == pending_->vision && own.valid_at == pending_->valid_at;
  });
  if (found == end) return;
  seen_ = {found->position_m, pending_->complete_within_m, pending_->valid_at - max_clock_difference_,
           max_speed_mps_};
  complete_at_ = pending_->valid_at;
  pending_.reset();
}

void CompletenessMonitor::on_forgotten(const SeenRegion& rest, Time until) {
  not_forgotten_ = rest.observed_at < forgotten_until_ ? rest.limited_by(not_forgotten_) : rest;
  forgotten_until_ = std::max(forgotten_until_, until);
}

SeenRegion CompletenessMonitor::seen(Time now, Duration max_lag) const {
  SeenRegion seen = now < forgotten_until_ ? seen_.limited_by(not_forgotten_) : seen_;
  seen.observed_at -= max_lag;
  return seen;
}

}  // namespace sidestep
