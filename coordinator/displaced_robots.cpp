// SPDX-License-Identifier: Apache-2.0
#include "coordinator/displaced_robots.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

// Covers systematic errors of vision, such as calibration errors.
constexpr double kObservationError_m = 0.01;
// Random errors exceed six standard deviations once in 10^8 observations.
constexpr double kSigmas = 6;
// Random errors of 0.5 mm turn the direction by 1/20 rad over the short baseline, and by 1/200 rad over the
// long baseline.
constexpr double kLongBaseline_m = 0.15;
constexpr double kShortBaseline_m = 0.015;
constexpr Duration kMaxBaseline{700'000'000};

}  // namespace

double DisplacedRobots::allowed_m(const RobotObservation& observation) const {
  return margin_m_ / 2 + std::max(kObservationError_m, kSigmas * std::sqrt(observation.position_variance_m2));
}

bool DisplacedRobots::contains(RobotId robot) const {
  const auto found = tracks_.find(robot);
  return found != tracks_.end() && found->second.is_displaced;
}

void DisplacedRobots::clear() {
  tracks_.clear();
  count_ = 0;
}

bool DisplacedRobots::observe(const RobotObservation& observation, const Ledger& ledger) {
  Track& track = tracks_[observation.robot];
  if (track.count > 0 && observation.observed_at <= track.back(0).observed_at) return track.is_compared;
  track.observations[track.count++ % Track::kCapacity] = observation;
  const auto distance =
      ledger.distance_from_versions_m(observation.robot, observation.position_m, observation.observed_at);
  track.is_compared = distance.has_value();
  const bool agrees = distance && *distance <= allowed_m(observation) && !rests_elsewhere(track, ledger);
  track.agreeing = agrees ? track.agreeing + 1 : 0;
  const bool was_displaced = track.is_displaced;
  if (distance && !agrees) track.is_displaced = true;
  if (track.agreeing >= kObservationsUntilBack) track.is_displaced = false;
  if (track.is_displaced != was_displaced) count_ += track.is_displaced ? 1 : -1;
  return track.is_compared;
}

bool DisplacedRobots::rests_elsewhere(const Track& track, const Ledger& ledger) const {
  if (track.count < kObservationsOfRest) return false;
  const RobotObservation& last = track.back(0);
  if (!ledger.rests_since(last.robot, track.back(kObservationsOfRest - 1).observed_at)) return false;
  const auto distance =
      ledger.distance_from_versions_m(last.robot, track.mean_position_m(), last.observed_at);
  return distance && *distance > margin_m_ / 2;
}

std::optional<RobotObservation> DisplacedRobots::last_observation(RobotId robot) const {
  const auto found = tracks_.find(robot);
  if (found == tracks_.end() || found->second.count == 0) return std::nullopt;
  RobotObservation last = found->second.back(0);
  last.velocity_mps = found->second.mean_velocity_mps();
  return last;
}

Vec2 DisplacedRobots::Track::mean_position_m() const {
  Vec2 sum_m(0, 0);
  for (std::size_t age = 0; age < kObservationsOfRest; ++age) sum_m += back(age).position_m;
  return sum_m / static_cast<double>(kObservationsOfRest);
}

Vec2 DisplacedRobots::Track::mean_velocity_mps() const {
  const RobotObservation& last = back(0);
  const RobotObservation* begin = nullptr;
  double longest_m = kShortBaseline_m;
  for (std::size_t age = 1; age < std::min(count, kCapacity); ++age) {
    if (last.observed_at - back(age).observed_at > kMaxBaseline) break;
    const double distance_m = (last.position_m - back(age).position_m).norm();
    if (distance_m < longest_m) continue;
    begin = &back(age);
    longest_m = distance_m;
    if (distance_m >= kLongBaseline_m) break;
  }
  if (!begin) return Vec2(0, 0);
  return (last.position_m - begin->position_m) / to_seconds(last.observed_at - begin->observed_at);
}

}  // namespace sidestep
