// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/seen_obstacles.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kFarthest_m = 1e4;
constexpr double kLargest_m = 10;
// Of a normal distribution, per axis, all but one in 16,000 lie within.
constexpr double kSigmas = 4;

// Written so that a NaN fails it.
bool is_sound(const msg::TrackedObstacle& seen) {
  return std::abs(seen.x_m()) <= kFarthest_m && std::abs(seen.y_m()) <= kFarthest_m && seen.radius_m() >= 0 &&
         seen.radius_m() <= kLargest_m && seen.position_variance_m2() >= 0 &&
         seen.position_variance_m2() <= kLargest_m;
}

}  // namespace

void SeenObstacles::on_world(const msg::WorldState& world, Time now) {
  if (world.obstacle_count() > msg::MAX_OBSTACLES) {
    ++invalid_;
    return;
  }
  for (std::size_t i = 0; i < world.obstacle_count(); ++i) {
    const msg::TrackedObstacle& seen = world.obstacles()[i];
    const bool is_from_the_future = seen.seen_at_ns() > to_ns(now + clocks_differ_);
    if (is_from_the_future || !is_sound(seen)) {
      ++invalid_;
      continue;
    }
    if (seen.seen_at_ns() < to_ns(now - kForgottenAfter)) continue;
    put({world.head().incarnation(), seen.obstacle()},
        {{seen.x_m(), seen.y_m()},
         seen.radius_m() + kSigmas * std::sqrt(seen.position_variance_m2()),
         time_from_ns(seen.seen_at_ns()) - clocks_differ_,
         speed_mps_});
  }
}

void SeenObstacles::put(const Track& track, const MovingObstacle& seen) {
  const auto end = tracks_.begin() + static_cast<std::ptrdiff_t>(count_);
  auto index = static_cast<std::size_t>(std::find(tracks_.begin(), end, track) - tracks_.begin());
  if (index < count_) {
    if (seen.seen_at <= seen_[index].seen_at) return;
  } else if (count_ < kMost) {
    ++count_;
  } else {
    const auto oldest = std::ranges::min_element(seen_, {}, &MovingObstacle::seen_at);
    if (seen.seen_at <= oldest->seen_at) return;
    index = static_cast<std::size_t>(oldest - seen_.begin());
  }
  tracks_[index] = track;
  seen_[index] = seen;
}

void SeenObstacles::drop(std::size_t index) {
  --count_;
  tracks_[index] = tracks_[count_];
  seen_[index] = seen_[count_];
}

std::span<const MovingObstacle> SeenObstacles::recent(Time now) {
  for (std::size_t i = count_; i-- > 0;) {
    if (now - seen_[i].seen_at > kForgottenAfter + clocks_differ_) drop(i);
  }
  return {seen_.data(), count_};
}

}  // namespace sidestep
