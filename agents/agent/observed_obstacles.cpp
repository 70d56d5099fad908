// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/observed_obstacles.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

// In each axis, an error of a normal distribution exceeds 4 sigma once in 16,000 cases.
constexpr double kSigmas = 4;

}  // namespace

void ObservedObstacles::on_world(const WorldObservations& world, Time now) {
  for (std::size_t i = 0; i < world.obstacle_count; ++i) {
    const ObservedObstacle& observed = world.obstacles[i];
    if (observed.observed_at > now + max_clock_difference_) {
      ++invalid_;
      continue;
    }
    if (observed.observed_at < now - kMaxObservationAge) continue;
    store({world.vision, observed.track},
          {observed.position_m, observed.radius_m + kSigmas * std::sqrt(observed.position_variance_m2),
           observed.observed_at - max_clock_difference_, max_speed_mps_});
  }
}

void ObservedObstacles::store(const Track& track, const MovingObstacle& obstacle) {
  const auto end = tracks_.begin() + static_cast<std::ptrdiff_t>(count_);
  auto index = static_cast<std::size_t>(std::find(tracks_.begin(), end, track) - tracks_.begin());
  if (index < count_) {
    if (obstacle.observed_at <= obstacles_[index].observed_at) return;
  } else if (count_ < kCapacity) {
    ++count_;
  } else {
    const auto oldest = std::ranges::min_element(obstacles_, {}, &MovingObstacle::observed_at);
    if (obstacle.observed_at <= oldest->observed_at) return;
    index = static_cast<std::size_t>(oldest - obstacles_.begin());
  }
  tracks_[index] = track;
  obstacles_[index] = obstacle;
}

void ObservedObstacles::drop(std::size_t index) {
  --count_;
  tracks_[index] = tracks_[count_];
  obstacles_[index] = obstacles_[count_];
}

std::span<const MovingObstacle> ObservedObstacles::recent(Time now) {
  for (std::size_t i = count_; i-- > 0;) {
    if (now - obstacles_[i].observed_at > kMaxObservationAge + max_clock_difference_) drop(i);
  }
  return {obstacles_.data(), count_};
}

}  // namespace sidestep
