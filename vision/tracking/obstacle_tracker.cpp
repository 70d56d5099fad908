// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/obstacle_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sidestep {
namespace {

constexpr double kGateDeviations = 5;
constexpr double kRadiusGain = 0.3;

void fill(msg::TrackedObstacle& message, std::uint32_t number, Time seen_at, double radius_m,
          const ConstantVelocityFilter<2>& filter) {
  message.obstacle(number);
  message.seen_at_ns(to_ns(seen_at));
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
  drop_unseen(frame.captured_at());
  std::array<bool, msg::MAX_OBSTACLES> is_taken{};
  match(frame, is_taken);
  for (std::size_t i = 0; i < frame.obstacles().size(); ++i) {
    if (!is_taken[i]) begin(frame.captured_at(), frame.obstacles()[i]);
  }
}

void ObstacleTracker::match(const Frame& frame, std::array<bool, msg::MAX_OBSTACLES>& is_taken) {
  const Time at = frame.captured_at();
  const auto sights = frame.obstacles();
  std::array<bool, kMostTracks> is_followed{};
  for (std::size_t round = 0; round < sights.size(); ++round) {
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t track = 0, sight = 0;
    for (std::size_t t = 0; t < count_; ++t) {
      if (is_followed[t]) continue;
      const double gate = gate_m(tracks_[t], at);
      for (std::size_t s = 0; s < sights.size(); ++s) {
        if (is_taken[s] || (sights[s].position_m - tracks_[t].filter.position()).norm() > gate) continue;
        const double distance = distance_m(tracks_[t], at, sights[s].position_m);
        if (distance >= nearest) continue;
        nearest = distance;
        track = t;
        sight = s;
      }
    }
    if (!std::isfinite(nearest)) return;
    is_followed[track] = is_taken[sight] = true;
    follow(tracks_[track], at, sights[sight]);
  }
}

double ObstacleTracker::distance_m(const Track& track, Time at, const Vec2& position_m) const {
  const Vec2 predicted = track.filter.position() + track.filter.velocity() * to_seconds(at - track.seen_at);
  return (position_m - predicted).norm();
}

/// How far from where it was seen it can be seen at a time.
double ObstacleTracker::gate_m(const Track& track, Time at) const {
  const double deviation =
      std::sqrt(track.filter.covariance()(0, 0)) + std::sqrt(2.0) * settings_.position_noise_m;
  return settings_.speed_mps * std::abs(to_seconds(at - track.seen_at)) + kGateDeviations * deviation;
}

void ObstacleTracker::follow(Track& track, Time at, const ObstacleObservation& sight) {
  if (at <= track.seen_at) return;
  const double variance = settings_.position_noise_m * settings_.position_noise_m;
  track.filter.predict(to_seconds(at - track.seen_at), settings_.motion);
  const Vec2 offset = sight.position_m - track.filter.position();
  if (track.filter.squared_distance(offset, variance) > kGateDeviations * kGateDeviations) {
    // It has turned round: what was known of its velocity is void.
    track.filter = {sight.position_m, variance, settings_.speed_mps * settings_.speed_mps};
  } else {
    track.filter.correct(offset, variance);
  }
  track.radius_m += kRadiusGain * (sight.radius_m - track.radius_m);
  track.seen_at = at;
  if (++track.hits >= settings_.confirm_hits && track.number == 0) track.number = ++numbers_;
}

void ObstacleTracker::begin(Time at, const ObstacleObservation& sight) {
  if (count_ == kMostTracks) {
    ++rejected_;
    return;
  }
  const double variance = settings_.position_noise_m * settings_.position_noise_m;
  const ConstantVelocityFilter<2> filter(sight.position_m, variance,
                                         settings_.speed_mps * settings_.speed_mps);
  tracks_[count_++] = {settings_.confirm_hits <= 1 ? ++numbers_ : 0, 1, at, sight.radius_m, filter};
}

void ObstacleTracker::drop_unseen(Time now) {
  const auto end = tracks_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto kept = std::remove_if(
      tracks_.begin(), end, [&](const Track& track) { return now - track.seen_at > settings_.drop_after; });
  count_ = static_cast<std::size_t>(kept - tracks_.begin());
}

void ObstacleTracker::world_at(Time t, msg::WorldState& world) const {
  std::array<const Track*, kMostTracks> shown;
  std::size_t count = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Track& track = tracks_[i];
    if (track.number > 0 && t - track.seen_at <= settings_.drop_after) shown[count++] = &track;
  }
  const auto end = shown.begin() + static_cast<std::ptrdiff_t>(count);
  if (count > msg::MAX_OBSTACLES) {
    std::nth_element(shown.begin(), shown.begin() + msg::MAX_OBSTACLES, end,
                     [](const Track* a, const Track* b) {
                       return a->seen_at != b->seen_at ? a->seen_at > b->seen_at : a->number < b->number;
                     });
    count = msg::MAX_OBSTACLES;
  }
  std::sort(shown.begin(), shown.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Track* a, const Track* b) { return a->number < b->number; });
  world.obstacle_count(static_cast<std::uint8_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    fill(world.obstacles()[i], shown[i]->number, shown[i]->seen_at, shown[i]->radius_m, shown[i]->filter);
  }
}

}  // namespace sidestep
