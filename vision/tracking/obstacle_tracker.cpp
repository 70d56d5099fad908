// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/obstacle_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "common/protocol/obstacle_bounds.hpp"

namespace sidestep {
namespace {

constexpr MotionNoise kObstacleMotion{2, 5};  ///< people turn abruptly
/// Number of observations before a track is confirmed. While frames are incomplete, one observation is
/// enough, because an obstacle that the last frame left out is not new.
constexpr int kConfirmHits = 2;
constexpr Duration kDropAfter{1'000'000'000};  ///< time without an observation after which a track ends

constexpr double kGateDeviations = 5;
constexpr double kRadiusGain = 0.3;

void fill(msg::TrackedObstacle& message, std::uint32_t number, Time observed_at, double radius_m,
          const ConstantVelocityFilter<2>& filter, double variance_m2) {
  message.obstacle(number);
  message.observed_at_ns(to_ns(observed_at));
  message.x_m(filter.position().x());
  message.y_m(filter.position().y());
  message.vx_mps(filter.velocity().x());
  message.vy_mps(filter.velocity().y());
  message.radius_m(radius_m);
  message.position_variance_m2(variance_m2);
}

/// Distance of the observed edge from the frame's nearest robot; 0 without robots.
double robot_distance_m(const ObstacleObservation& observation, const Frame& frame) {
  if (frame.robots().empty()) return 0;
  double min_distance = std::numeric_limits<double>::infinity();
  for (const RobotPoseObservation& robot : frame.robots())
    min_distance = std::min(min_distance, (robot.position_m - observation.position_m).norm());
  return std::max(0.0, min_distance - observation.radius_m);
}

}  // namespace

ObstacleTracker::ObstacleTracker(const ObstacleTrackerSettings& settings)
    : settings_(settings),
      incomplete_frames_(settings.max_speed_mps, kObstacleSigmas * settings.position_noise_m, kDropAfter) {
  tracks_.reserve(kMaxTracks);
  pairs_.reserve(std::size_t{4} * kMaxTracks);
  robots_m_.reserve(kMaxRobots);
  listed_.reserve(kMaxTracks);
}

void ObstacleTracker::forget() {
  tracks_.clear();
  incomplete_frames_.clear();
}

void ObstacleTracker::update(const Frame& frame) {
  double complete_within_m = frame.obstacles_complete_within_m();
  const int confirm_hits = incomplete_frames_.is_empty() ? kConfirmHits : 1;
  if (!frame.obstacles().empty()) {
    drop_stale_tracks(frame.captured_at());
    associate(frame);
  }
  for (std::size_t i = 0; i < frame.obstacles().size(); ++i) {
    const ObstacleObservation& observation = frame.obstacles()[i];
    if (is_used_[i] || start_track(frame, observation, confirm_hits)) continue;
    ++rejected_;
    complete_within_m = std::min(complete_within_m, robot_distance_m(observation, frame));
  }
  incomplete_frames_.update(frame, complete_within_m);
}

/// Lists the pairs of tracks and observations within the tracks' gates. Observations are sorted by x, so that
/// a track is compared only with those within its gate on x.
void ObstacleTracker::find_pairs(const Frame& frame) {
  const auto observations = frame.obstacles();
  const auto x_of = [&](std::uint16_t index) { return observations[index].position_m.x(); };
  const std::span<std::uint16_t> by_x(by_x_.data(), observations.size());
  std::iota(by_x.begin(), by_x.end(), std::uint16_t{0});
  std::ranges::sort(by_x, {}, x_of);
  pairs_.clear();
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const Vec2& centre = tracks_[t].filter.position();
    const double gate = gate_m(tracks_[t], frame);
    for (auto o = std::ranges::lower_bound(by_x, centre.x() - gate, {}, x_of); o != by_x.end(); ++o) {
      if (x_of(*o) > centre.x() + gate) break;
      const Vec2& position_m = observations[*o].position_m;
      if ((position_m - centre).norm() > gate) continue;
      const double distance_m = predicted_distance_m(tracks_[t], frame.captured_at(), position_m);
      const double radius_change_m = observations[*o].radius_m - tracks_[t].radius_m;
      pairs_.push_back({std::hypot(distance_m, radius_change_m), static_cast<std::uint16_t>(t), *o});
    }
  }
}

void ObstacleTracker::associate(const Frame& frame) {
  find_pairs(frame);
  std::ranges::sort(pairs_);
  is_used_.fill(false);
  is_updated_.fill(false);
  for (const Pair& pair : pairs_) {
    if (is_updated_[pair.track] || is_used_[pair.observation]) continue;
    is_updated_[pair.track] = is_used_[pair.observation] = true;
    update_track(tracks_[pair.track], frame, frame.obstacles()[pair.observation]);
  }
}

double ObstacleTracker::predicted_distance_m(const Track& track, Time at, const Vec2& position_m) const {
  const Vec2 predicted =
      track.filter.position() + track.filter.velocity() * to_seconds(at - track.observed_at);
  return (position_m - predicted).norm();
}

/// Maximum distance from the last estimate at which the obstacle can be observed in a frame.
double ObstacleTracker::gate_m(const Track& track, const Frame& frame) const {
  const double deviation = std::sqrt(variance_m2(track)) + std::sqrt(2.0) * settings_.position_noise_m;
  const Duration age = std::chrono::abs(frame.captured_at() - track.observed_at) + track.date_uncertainty +
                       frame.date_uncertainty();
  return settings_.max_speed_mps * to_seconds(age) + kGateDeviations * deviation;
}

void ObstacleTracker::update_track(Track& track, const Frame& frame, const ObstacleObservation& observation) {
  const Time at = frame.captured_at();
  if (at <= track.observed_at) return;
  const double variance = settings_.position_noise_m * settings_.position_noise_m;
  track.filter.predict(to_seconds(at - track.observed_at), kObstacleMotion);
  const Vec2 innovation = observation.position_m - track.filter.position();
  if (track.filter.squared_distance(innovation, variance) > kGateDeviations * kGateDeviations) {
    // The obstacle has turned abruptly, so the velocity estimate is discarded.
    track.filter = {observation.position_m, variance, settings_.max_speed_mps * settings_.max_speed_mps};
  } else {
    track.filter.correct(innovation, variance);
  }
  // A larger radius is adopted immediately, because the track may have followed a smaller obstacle at the
  // same place.
  track.radius_m =
      std::max(observation.radius_m, track.radius_m + kRadiusGain * (observation.radius_m - track.radius_m));
  track.observed_at = at;
  track.date_uncertainty = frame.date_uncertainty();
  if (++track.hits >= kConfirmHits && track.number == 0) track.number = ++last_number_;
}

bool ObstacleTracker::start_track(const Frame& frame, const ObstacleObservation& observation,
                                  int confirm_hits) {
  if (tracks_.size() == kMaxTracks) return false;
  const double variance = settings_.position_noise_m * settings_.position_noise_m;
  const ConstantVelocityFilter<2> filter(observation.position_m, variance,
                                         settings_.max_speed_mps * settings_.max_speed_mps);
  tracks_.push_back({confirm_hits <= 1 ? ++last_number_ : 0, 1, frame.captured_at(), frame.date_uncertainty(),
                     observation.radius_m, filter});
  return true;
}

void ObstacleTracker::drop_stale_tracks(Time now) {
  std::erase_if(tracks_, [&](const Track& track) { return now - track.observed_at > kDropAfter; });
}

double ObstacleTracker::min_distance_m(const Track& track, Time t) const {
  double min_squared = std::numeric_limits<double>::infinity();
  for (const Vec2& robot : robots_m_)
    min_squared = std::min(min_squared, (track.filter.position() - robot).squaredNorm());
  return std::sqrt(min_squared) - track.radius_m - kObstacleSigmas * std::sqrt(variance_m2(track)) -
         settings_.max_speed_mps * std::abs(to_seconds(t - track.earliest()));
}

void ObstacleTracker::list_at(Time t, std::span<const msg::TrackedRobot> robots, msg::ObstacleList& list) {
  robots_m_.clear();
  for (const msg::TrackedRobot& robot : robots) robots_m_.emplace_back(robot.x_m(), robot.y_m());
  listed_.clear();
  for (const Track& track : tracks_) {
    if (track.number > 0 && t - track.observed_at <= kDropAfter)
      listed_.push_back({min_distance_m(track, t), &track});
  }
  std::ranges::sort(listed_, {}, [](const ListedTrack& listed) {
    return std::pair(listed.distance_m, listed.track->number);
  });
  const std::size_t count = std::min<std::size_t>(listed_.size(), msg::MAX_OBSTACLES);
  double complete_within_m = incomplete_frames_.complete_within_m(robots_m_, t);
  if (count < listed_.size())
    complete_within_m = robots.empty() ? 0 : std::min(complete_within_m, listed_[count - 1].distance_m);
  list.valid_at_ns(to_ns(t));
  list.complete_within_m(std::max(0.0, complete_within_m));
  list.obstacles().resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Track& track = *listed_[i].track;
    fill(list.obstacles()[i], track.number, track.earliest(), track.radius_m, track.filter,
         variance_m2(track));
  }
}

}  // namespace sidestep
