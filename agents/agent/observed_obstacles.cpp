// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/observed_obstacles.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kMaxCoordinate_m = 1e4;
constexpr double kMaxRadius_m = 10;
// In each axis, an error of a normal distribution exceeds 4 sigma once in 16,000 cases.
constexpr double kSigmas = 4;

// The comparisons are false for NaN.
bool is_valid(const msg::TrackedObstacle& observed) {
  return std::abs(observed.x_m()) <= kMaxCoordinate_m && std::abs(observed.y_m()) <= kMaxCoordinate_m &&
         observed.radius_m() >= 0 && observed.radius_m() <= kMaxRadius_m &&
         observed.position_variance_m2() >= 0 && observed.position_variance_m2() <= kMaxRadius_m;
}

}  // namespace

void ObservedObstacles::on_world(const msg::WorldState& world, Time now) {
  if (world.obstacle_count() > msg::MAX_OBSTACLES) {
    ++invalid_;
    return;
  }
  for (std::size_t i = 0; i < world.obstacle_count(); ++i) {
    const msg::TrackedObstacle& observed = world.obstacles()[i];
    const bool is_from_the_future = observed.observed_at_ns() > to_ns(now + max_clock_difference_);
    if (is_from_the_future || !is_valid(observed)) {
      ++invalid_;
      continue;
    }
    if (observed.observed_at_ns() < to_ns(now - kMaxObservationAge)) continue;
    store({world.header().incarnation(), observed.obstacle()},
          {{observed.x_m(), observed.y_m()},
           observed.radius_m() + kSigmas * std::sqrt(observed.position_variance_m2()),
           time_from_ns(observed.observed_at_ns()) - max_clock_difference_,
           max_speed_mps_});
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
