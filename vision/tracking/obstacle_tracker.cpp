// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/obstacle_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sidestep {
namespace {

constexpr double kGateDeviations = 5;
constexpr double kRadiusGain = 0.3;

void fill(msg::TrackedObstacle& message, std::uint32_t number, Time observed_at, double radius_m,
          const ConstantVelocityFilter<2>& filter) {
  message.obstacle(number);
  message.observed_at_ns(to_ns(observed_at));
  message.x_m(filter.position().x());
  message.y_m(filter.position().y());
  message.vx_mps(filter.velocity().x());
  message.vy_mps(filter.velocity().y());
  message.radius_m(radius_m);
  message.position_variance_m2(filter.covariance()(0, 0));
}

}  // namespace

void ObstacleTracker::update(const Frame& frame) {
  if (frame.obstacles().empty()) return;
  drop_stale_tracks(frame.captured_at());
  std::array<bool, msg::MAX_OBSTACLES> is_used{};
  associate(frame, is_used);
  for (std::size_t i = 0; i < frame.obstacles().size(); ++i) {
    if (!is_used[i]) start_track(frame.captured_at(), frame.obstacles()[i]);
  }
}

void ObstacleTracker::associate(const Frame& frame, std::array<bool, msg::MAX_OBSTACLES>& is_used) {
  const Time at = frame.captured_at();
  const auto observations = frame.obstacles();
  std::array<bool, kMaxTracks> is_updated{};
  for (std::size_t round = 0; round < observations.size(); ++round) {
    double min_distance = std::numeric_limits<double>::infinity();
    std::size_t nearest_track = 0, nearest_observation = 0;
    for (std::size_t t = 0; t < count_; ++t) {
      if (is_updated[t]) continue;
      const double gate = gate_m(tracks_[t], at);
      for (std::size_t o = 0; o < observations.size(); ++o) {
        if (is_used[o] || (observations[o].position_m - tracks_[t].filter.position()).norm() > gate) continue;
        const double distance = predicted_distance_m(tracks_[t], at, observations[o].position_m);
        if (distance >= min_distance) continue;
        min_distance = distance;
        nearest_track = t;
        nearest_observation = o;
      }
    }
    if (!std::isfinite(min_distance)) return;
    is_updated[nearest_track] = is_used[nearest_observation] = true;
    update_track(tracks_[nearest_track], at, observations[nearest_observation]);
  }
}

double ObstacleTracker::predicted_distance_m(const Track& track, Time at, const Vec2& position_m) const {
  const Vec2 predicted =
      track.filter.position() + track.filter.velocity() * to_seconds(at - track.observed_at);
  return (position_m - predicted).norm();
}

/// Maximum distance from the last estimate at which the obstacle can be observed at a time.
double ObstacleTracker::gate_m(const Track& track, Time at) const {
  const double deviation =
      std::sqrt(track.filter.covariance()(0, 0)) + std::sqrt(2.0) * settings_.position_noise_m;
  return settings_.max_speed_mps * std::abs(to_seconds(at - track.observed_at)) + kGateDeviations * deviation;
}

void ObstacleTracker::update_track(Track& track, Time at, const ObstacleObservation& observation) {
  if (at <= track.observed_at) return;
  const double variance = settings_.position_noise_m * settings_.position_noise_m;
  track.filter.predict(to_seconds(at - track.observed_at), settings_.motion);
  const Vec2 innovation = observation.position_m - track.filter.position();
  if (track.filter.squared_distance(innovation, variance) > kGateDeviations * kGateDeviations) {
    // The obstacle has turned abruptly: the velocity estimate is void.
    track.filter = {observation.position_m, variance, settings_.max_speed_mps * settings_.max_speed_mps};
  } else {
    track.filter.correct(innovation, variance);
  }
  track.radius_m += kRadiusGain * (observation.radius_m - track.radius_m);
  track.observed_at = at;
  if (++track.hits >= settings_.confirm_hits && track.number == 0) track.number = ++last_number_;
}

void ObstacleTracker::start_track(Time at, const ObstacleObservation& observation) {
  if (count_ == kMaxTracks) {
    ++rejected_;
    return;
  }
  const double variance = settings_.position_noise_m * settings_.position_noise_m;
  const ConstantVelocityFilter<2> filter(observation.position_m, variance,
                                         settings_.max_speed_mps * settings_.max_speed_mps);
  tracks_[count_++] = {settings_.confirm_hits <= 1 ? ++last_number_ : 0, 1, at, observation.radius_m, filter};
}

void ObstacleTracker::drop_stale_tracks(Time now) {
  const auto end = tracks_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto kept_end = std::remove_if(tracks_.begin(), end, [&](const Track& track) {
    return now - track.observed_at > settings_.drop_after;
  });
  count_ = static_cast<std::size_t>(kept_end - tracks_.begin());
}

void ObstacleTracker::world_at(Time t, msg::WorldState& world) const {
  std::array<const Track*, kMaxTracks> current{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Track& track = tracks_[i];
    if (track.number > 0 && t - track.observed_at <= settings_.drop_after) current[count++] = &track;
  }
  const auto end = current.begin() + static_cast<std::ptrdiff_t>(count);
  if (count > msg::MAX_OBSTACLES) {
    std::nth_element(
        current.begin(), current.begin() + msg::MAX_OBSTACLES, end, [](const Track* a, const Track* b) {
          return a->observed_at != b->observed_at ? a->observed_at > b->observed_at : a->number < b->number;
        });
    count = msg::MAX_OBSTACLES;
  }
  std::sort(current.begin(), current.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Track* a, const Track* b) { return a->number < b->number; });
  world.obstacle_count(static_cast<std::uint8_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const Track& track = *current[i];
    fill(world.obstacles()[i], track.number, track.observed_at, track.radius_m, track.filter);
  }
}

}  // namespace sidestep
