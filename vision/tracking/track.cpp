// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/track.hpp"

#include <tuple>

namespace sidestep {
namespace {

using Angle = ConstantVelocityFilter<1>::Vector;

double squared(double x) { return x * x; }

auto order_of(const Sight& s) {
  return std::make_tuple(s.captured_at, s.camera, s.position_m.x(), s.position_m.y(), s.heading_rad);
}

PoseFilter started(const Sight& sight, const TrackModel& model) {
  return {ConstantVelocityFilter<2>(sight.position_m, squared(model.position_noise_m),
                                    squared(model.start_speed_mps)),
          ConstantVelocityFilter<1>(Angle(sight.heading_rad), squared(model.heading_noise_rad),
                                    squared(model.start_turn_radps))};
}

void predict(PoseFilter& filter, Duration dt, const TrackModel& model) {
  filter.position.predict(to_seconds(dt), model.motion, model.rolling_mps2);
  filter.heading.predict(to_seconds(dt), model.turning);
}

/// Corrects a filter that has been predicted to the sight's time, unless the sight lies outside the gate.
bool correct(PoseFilter& filter, const Sight& sight, const TrackModel& model) {
  const Vec2 offset = sight.position_m - filter.position.position();
  const Angle turn(wrapped_rad(sight.heading_rad - filter.heading.position()(0)));
  const double position_variance = squared(model.position_noise_m);
  const double heading_variance = squared(model.heading_noise_rad);
  const double gate = squared(model.gate_sigma);
  if (filter.position.squared_distance(offset, position_variance) > gate ||
      filter.heading.squared_distance(turn, heading_variance) > gate) {
    return false;
  }
  filter.position.correct(offset, position_variance);
  filter.heading.correct(turn, heading_variance);
  return true;
}

/// The mean of all sights captured at once, and of the latest only.
void see(TrackState& state, const Sight& sight) {
  if (state.seen_count == 0 || sight.captured_at != state.seen.captured_at) {
    state.seen = sight;
    state.seen_count = 1;
    return;
  }
  ++state.seen_count;
  state.seen.position_m += (sight.position_m - state.seen.position_m) / state.seen_count;
  const double turn = wrapped_rad(sight.heading_rad - state.seen.heading_rad);
  state.seen.heading_rad = wrapped_rad(state.seen.heading_rad + turn / state.seen_count);
}

void forget_candidate(TrackState& state) {
  state.rejected += static_cast<std::uint64_t>(state.candidate_hits);
  state.candidate_hits = 0;
}

bool follow_track(TrackState& state, const Sight& sight, const TrackModel& model) {
  PoseFilter filter = state.filter;
  predict(filter, sight.captured_at - state.seen.captured_at, model);
  if ((sight.position_m - filter.position.position()).norm() > model.gate_m ||
      !correct(filter, sight, model)) {
    return false;
  }
  state.filter = filter;
  see(state, sight);
  return true;
}

bool follow_candidate(TrackState& state, const Sight& sight, const TrackModel& model) {
  PoseFilter candidate = state.candidate;
  predict(candidate, sight.captured_at - state.candidate_at, model);
  if (!correct(candidate, sight, model)) return false;
  state.candidate = candidate;
  state.candidate_at = sight.captured_at;
  ++state.candidate_hits;
  return true;
}

/// Where a track goes on elsewhere, what is near to it is the better candidate.
bool is_better(const TrackState& state, const Sight& sight) {
  const Vec2& track_m = state.filter.position.position();
  return state.is_confirmed && (sight.position_m - track_m).squaredNorm() <
                                   (state.candidate.position.position() - track_m).squaredNorm();
}

/// A candidate stands until it has not been seen for a while, so that ghosts in between do not hinder it.
void consider(TrackState& state, const Sight& sight, const TrackModel& model) {
  const bool is_live = state.candidate_hits > 0 && sight.captured_at - state.candidate_at <= model.max_gap;
  if (is_live && follow_candidate(state, sight, model)) return;
  if (is_live && !is_better(state, sight)) {
    ++state.rejected;
    return;
  }
  forget_candidate(state);
  state.candidate = started(sight, model);
  state.candidate_at = sight.captured_at;
  state.candidate_hits = 1;
}

/// A robot that was pushed is seen a little beside its track, again and again; ghosts are not.
bool was_moved(const TrackState& state, const Sight& sight, const TrackModel& model) {
  return state.is_confirmed && state.candidate_hits >= model.near_hits &&
         (sight.position_m - state.seen.position_m).norm() <= model.gate_m;
}

}  // namespace

TrackState advanced(const TrackState& state, const Sight& sight, const TrackModel& model) {
  TrackState next = state;
  const Duration unseen = sight.captured_at - state.seen.captured_at;
  if (next.is_confirmed && unseen > model.drop_after) next.is_confirmed = false;
  if (next.is_confirmed && follow_track(next, sight, model)) {
    forget_candidate(next);
    return next;
  }
  consider(next, sight, model);
  const bool is_believed =
      next.candidate_hits >= model.confirm_hits && (!next.is_confirmed || unseen >= model.relocate_after);
  if (is_believed || was_moved(next, sight, model)) {
    next.is_confirmed = true;
    next.filter = next.candidate;
    next.candidate_hits = 0;
    next.seen_count = 0;
    see(next, sight);
  }
  return next;
}

std::optional<Estimate> estimate_at(const TrackState& state, Time t, const TrackModel& model) {
  const Duration unseen = t - state.seen.captured_at;
  if (!state.is_confirmed || unseen > model.drop_after) return std::nullopt;
  PoseFilter filter = state.filter;
  predict(filter, unseen, model);
  return Estimate{filter.position.position(),
                  filter.position.velocity(),
                  wrapped_rad(filter.heading.position()(0)),
                  filter.heading.velocity()(0),
                  filter.position.covariance()(0, 0),
                  filter.position.covariance()(1, 1)};
}

bool Track::add(const Sight& sight, const TrackModel& model) {
  std::size_t place = size_;
  while (place > 0 && order_of(sight) < order_of(entry(place - 1).sight)) --place;
  if (place > 0 && order_of(sight) == order_of(entry(place - 1).sight)) return false;
  if (size_ == kCapacity) {
    if (place == 0) {
      ++too_late_;
      return false;
    }
    base_ = entry(0).after;
    first_ = (first_ + 1) % kCapacity;
    --size_;
    --place;
  }
  for (std::size_t i = size_; i > place; --i) entry(i).sight = entry(i - 1).sight;
  entry(place).sight = sight;
  ++size_;
  for (std::size_t i = place; i < size_; ++i) {
    entry(i).after = advanced(i == 0 ? base_ : entry(i - 1).after, entry(i).sight, model);
  }
  return true;
}

}  // namespace sidestep
