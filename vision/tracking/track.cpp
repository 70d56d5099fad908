// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/track.hpp"

#include <algorithm>
#include <tuple>

namespace sidestep {
namespace {

using Angle = ConstantVelocityFilter<1>::Vector;

double squared(double x) { return x * x; }

/// Variance by which a wrong date displaces an observation of something that moves at this speed.
double date_variance(double speed, Duration date_uncertainty) {
  return squared(speed * to_seconds(date_uncertainty));
}

auto order_key(const Observation& o) {
  return std::make_tuple(o.captured_at, o.camera, o.position_m.x(), o.position_m.y(), o.heading_rad);
}

PoseFilter started(const Observation& observation, const TrackModel& model) {
  return {ConstantVelocityFilter<2>(observation.position_m, squared(model.position_noise_m),
                                    squared(model.start_speed_mps)),
          ConstantVelocityFilter<1>(Angle(observation.heading_rad), squared(model.heading_noise_rad),
                                    squared(model.start_turn_radps))};
}

void predict(PoseFilter& filter, Duration dt, const TrackModel& model) {
  filter.position.predict(to_seconds(dt), model.motion, model.rolling_mps2);
  filter.heading.predict(to_seconds(dt), model.turning);
}

/// Corrects a filter that has been predicted to the observation's time. Returns false and leaves it unchanged
/// if the observation lies outside the gate.
bool correct(PoseFilter& filter, const Observation& observation, const TrackModel& model) {
  const Vec2 offset = observation.position_m - filter.position.position();
  const Angle turn(wrapped_rad(observation.heading_rad - filter.heading.position()(0)));
  const Duration date_uncertainty = observation.date_uncertainty;
  const double position_variance =
      squared(model.position_noise_m) + date_variance(filter.position.velocity().norm(), date_uncertainty);
  const double heading_variance =
      squared(model.heading_noise_rad) + date_variance(filter.heading.velocity()(0), date_uncertainty);
  const double gate = squared(model.gate_sigma);
  if (filter.position.squared_distance(offset, position_variance) > gate ||
      filter.heading.squared_distance(turn, heading_variance) > gate) {
    return false;
  }
  filter.position.correct(offset, position_variance);
  filter.heading.correct(turn, heading_variance);
  return true;
}

/// Sets state.last to the mean of all observations captured at the same time as this one.
void record_observation(TrackState& state, const Observation& observation) {
  if (state.last_count == 0 || observation.captured_at != state.last.captured_at) {
    state.last = observation;
    state.last_count = 1;
    return;
  }
  ++state.last_count;
  state.last.date_uncertainty = std::max(state.last.date_uncertainty, observation.date_uncertainty);
  state.last.position_m += (observation.position_m - state.last.position_m) / state.last_count;
  const double turn = wrapped_rad(observation.heading_rad - state.last.heading_rad);
  state.last.heading_rad = wrapped_rad(state.last.heading_rad + turn / state.last_count);
}

void discard_candidate(TrackState& state) {
  state.rejected += static_cast<std::uint64_t>(state.candidate_hits);
  state.candidate_hits = 0;
}

bool extend_track(TrackState& state, const Observation& observation, const TrackModel& model) {
  PoseFilter filter = state.filter;
  predict(filter, observation.captured_at - state.last.captured_at, model);
  if ((observation.position_m - filter.position.position()).norm() > model.gate_m ||
      !correct(filter, observation, model)) {
    return false;
  }
  state.filter = filter;
  record_observation(state, observation);
  return true;
}

bool extend_candidate(TrackState& state, const Observation& observation, const TrackModel& model) {
  PoseFilter candidate = state.candidate;
  predict(candidate, observation.captured_at - state.candidate_at, model);
  if (!correct(candidate, observation, model)) return false;
  state.candidate = candidate;
  state.candidate_at = observation.captured_at;
  ++state.candidate_hits;
  return true;
}

/// Whether the observation continues the confirmed track better than the candidate: it is nearer to the
/// track.
bool is_better_candidate(const TrackState& state, const Observation& observation) {
  const Vec2& track_m = state.filter.position.position();
  return state.is_confirmed && (observation.position_m - track_m).squaredNorm() <
                                   (state.candidate.position.position() - track_m).squaredNorm();
}

/// Extends the candidate, replaces it, or rejects the observation. A candidate persists until it has not been
/// observed for max_gap, so that ghosts in between do not displace it.
void update_candidate(TrackState& state, const Observation& observation, const TrackModel& model) {
  const bool is_live =
      state.candidate_hits > 0 && observation.captured_at - state.candidate_at <= model.max_gap;
  if (is_live && extend_candidate(state, observation, model)) return;
  if (is_live && !is_better_candidate(state, observation)) {
    ++state.rejected;
    return;
  }
  discard_candidate(state);
  state.candidate = started(observation, model);
  state.candidate_at = observation.captured_at;
  state.candidate_hits = 1;
}

/// Whether the robot was pushed: then it is observed repeatedly near its track, and ghosts are not.
bool is_displaced(const TrackState& state, const Observation& observation, const TrackModel& model) {
  return state.is_confirmed && state.candidate_hits >= model.displaced_hits &&
         (observation.position_m - state.last.position_m).norm() <= model.gate_m;
}

}  // namespace

TrackState advanced(const TrackState& state, const Observation& observation, const TrackModel& model) {
  TrackState next = state;
  const Duration gap = observation.captured_at - state.last.captured_at;
  if (next.is_confirmed && gap > model.drop_after) next.is_confirmed = false;
  if (next.is_confirmed && extend_track(next, observation, model)) {
    discard_candidate(next);
    return next;
  }
  update_candidate(next, observation, model);
  const bool is_confirmed =
      next.candidate_hits >= model.confirm_hits && (!next.is_confirmed || gap >= model.relocate_after);
  if (is_confirmed || is_displaced(next, observation, model)) {
    next.is_confirmed = true;
    next.filter = next.candidate;
    next.candidate_hits = 0;
    next.last_count = 0;
    record_observation(next, observation);
  }
  return next;
}

// An observation that continues the track discards the candidate.
bool is_seen_elsewhere(const TrackState& state, const TrackModel& model) {
  return state.is_confirmed && state.candidate_hits >= model.displaced_hits;
}

std::optional<Estimate> estimate_at(const TrackState& state, Time t, const TrackModel& model) {
  const Duration gap = t - state.last.captured_at;
  if (!state.is_confirmed || gap > model.drop_after) return std::nullopt;
  PoseFilter filter = state.filter;
  predict(filter, gap, model);
  // Errors of consecutive dates have the same cause, so the filter does not average them out.
  const double date_variance_m2 =
      date_variance(filter.position.velocity().norm(), state.last.date_uncertainty);
  return Estimate{filter.position.position(),
                  filter.position.velocity(),
                  wrapped_rad(filter.heading.position()(0)),
                  filter.heading.velocity()(0),
                  filter.position.covariance()(0, 0) + date_variance_m2,
                  filter.position.covariance()(1, 1)};
}

bool Track::add(const Observation& observation, const TrackModel& model) {
  std::size_t index = size_;
  while (index > 0 && order_key(observation) < order_key(entry(index - 1).observation)) --index;
  if (index > 0 && order_key(observation) == order_key(entry(index - 1).observation)) return false;
  if (size_ == kCapacity) {
    if (index == 0) {
      ++too_late_;
      return false;
    }
    base_ = entry(0).after;
    first_ = (first_ + 1) % kCapacity;
    --size_;
    --index;
  }
  for (std::size_t i = size_; i > index; --i) entry(i).observation = entry(i - 1).observation;
  entry(index).observation = observation;
  ++size_;
  for (std::size_t i = index; i < size_; ++i) {
    entry(i).after = advanced(i == 0 ? base_ : entry(i - 1).after, entry(i).observation, model);
  }
  return true;
}

}  // namespace sidestep
