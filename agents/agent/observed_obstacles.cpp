// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/observed_obstacles.hpp"

#include <algorithm>
#include <cmath>

#include "common/protocol/obstacle_bounds.hpp"
#include "common/time/clock_bounds.hpp"

namespace sidestep {
namespace {

/// Lower bound of the obstacle's distance from a position at a time.
double min_distance_m(const MovingObstacle& obstacle, const Vec2& position_m, Time t) {
  return (obstacle.position_m - position_m).norm() - obstacle.reach_m(t);
}

}  // namespace

ObservedObstacles::ObservedObstacles(double max_speed_mps, Duration max_clock_difference)
    : max_speed_mps_(max_speed_mps),
      max_clock_difference_(max_clock_difference),
      completeness_(max_speed_mps, max_clock_difference) {
  tracks_.reserve(kCapacity);
  obstacles_.reserve(kCapacity);
  recent_.reserve(kCapacity);
}

void ObservedObstacles::on_list(const ObstacleObservations& list, const Vec2& robot_m, Time now) {
  if (list.valid_at > now + max_vision_lead(max_clock_difference_)) {
    ++invalid_;
    return;
  }
  if (has_future(now)) forget(now);
  bool is_whole = true;
  for (const ObservedObstacle& observed : list.obstacles) {
    if (observed.observed_at > now + max_clock_difference_) {
      ++invalid_;
      is_whole = false;
      continue;
    }
    if (observed.observed_at < now - kMaxObservationAge) continue;
    const double radius_m = observed.radius_m + kObstacleSigmas * std::sqrt(observed.position_variance_m2);
    store({list.vision, observed.track},
          {observed.position_m, radius_m, observed.observed_at - max_clock_difference_, max_speed_mps_,
           observed.velocity_mps},
          robot_m, now);
  }
  if (is_whole && now >= incomplete_until_) completeness_.on_list(list);
}

bool ObservedObstacles::has_future(Time now) const {
  const auto is_future = [=](const MovingObstacle& obstacle) { return obstacle.observed_at > now; };
  return completeness_.complete_at() > now + max_vision_lead(max_clock_difference_) ||
         incomplete_until_ > now + kMaxObservationAge || std::ranges::any_of(obstacles_, is_future);
}

void ObservedObstacles::forget(Time now) {
  tracks_.clear();
  obstacles_.clear();
  completeness_ = CompletenessMonitor(max_speed_mps_, max_clock_difference_);
  incomplete_until_ = now + kMaxObservationAge;
}

void ObservedObstacles::store(const Track& track, const MovingObstacle& obstacle, const Vec2& robot_m,
                              Time now) {
  auto place = std::ranges::lower_bound(tracks_, track);
  if (place != tracks_.end() && *place == track) {
    MovingObstacle& known = obstacles_[static_cast<std::size_t>(place - tracks_.begin())];
    if (obstacle.observed_at > known.observed_at) known = obstacle;
    return;
  }
  if (tracks_.size() == kCapacity) {
    if (!make_room_for(obstacle, robot_m, now)) return;
    place = std::ranges::lower_bound(tracks_, track);
  }
  obstacles_.insert(obstacles_.begin() + (place - tracks_.begin()), obstacle);
  tracks_.insert(place, track);
}

bool ObservedObstacles::make_room_for(const MovingObstacle& obstacle, const Vec2& robot_m, Time now) {
  drop_old(now);
  if (tracks_.size() < kCapacity) return true;
  const auto distance_m = [&](const MovingObstacle& o) { return min_distance_m(o, robot_m, now); };
  const auto farthest = std::ranges::max_element(obstacles_, {}, distance_m);
  const bool is_nearer = distance_m(obstacle) < distance_m(*farthest);
  completeness_.on_forgotten({robot_m, distance_m(is_nearer ? *farthest : obstacle), now, max_speed_mps_},
                             now + kMaxObservationAge + max_clock_difference_);
  if (is_nearer) {
    tracks_.erase(tracks_.begin() + (farthest - obstacles_.begin()));
    obstacles_.erase(farthest);
  }
  return is_nearer;
}

void ObservedObstacles::drop_old(Time now) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (now - obstacles_[i].observed_at > kMaxObservationAge + max_clock_difference_) continue;
    tracks_[kept] = tracks_[i];
    obstacles_[kept++] = obstacles_[i];
  }
  tracks_.resize(kept);
  obstacles_.resize(kept);
}

std::span<const MovingObstacle> ObservedObstacles::recent(Time now, Duration max_lag) {
  drop_old(now);
  if (max_lag == Duration{0}) return obstacles_;
  recent_ = obstacles_;
  for (MovingObstacle& obstacle : recent_) obstacle.observed_at -= max_lag;
  return recent_;
}

}  // namespace sidestep
