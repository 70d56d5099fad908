// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/batch_clearance.hpp"

#include <algorithm>

#include "common/motion/clearance.hpp"

namespace sidestep::batch {
namespace {

// Larger than all rounding errors of this file and of the exact clearance, and much smaller than the margin.
constexpr double kRounding_m = 1e-6;
// Position and start time of unused lanes.
constexpr double kFarAway_m = 1e6;
constexpr double kDistantPast_s = -1e6;

}  // namespace

ComparisonSettings comparison_settings(double begin_s, double step_s, double acceleration,
                                       double extra_clearance_m) {
  return {begin_s, step_s, acceleration, extra_clearance_m + kClearanceTolerance_m + kRounding_m,
          extra_clearance_m + kRounding_m};
}

Track track_of(const TrackBlock& tracks, std::size_t lane) {
  Track track{};
  for (std::size_t k = 0; k < kSamples; ++k) {
    track.x_m[k] = tracks.x_m[k].lane[lane];
    track.y_m[k] = tracks.y_m[k].lane[lane];
  }
  return track;
}

Track track_of(const TrajectoryBounds& bounds, Time begin, double step_s) {
  const double from_s = to_seconds(begin - bounds.start);
  Track track{};
  for (std::size_t k = 0; k < kSamples; ++k) {
    const double elapsed = from_s + static_cast<double>(k) * step_s;
    const double t = std::min(std::max(elapsed, -step_s), bounds.first_s);
    const double u = std::min(std::max(elapsed - bounds.first_s, 0.0), bounds.second_s);
    const Vec2 position = bounds.at_start.position_m +
                          t * (bounds.at_start.velocity_mps + t * bounds.first_half_mps2) +
                          u * (bounds.second_velocity_mps + u * bounds.second_half_mps2);
    track.x_m[k] = position.x();
    track.y_m[k] = position.y();
  }
  return track;
}

void BatchClearance::reset(Time base) {
  base_ = base;
  count_ = 0;
  is_sampled_ = false;
}

void BatchClearance::begin_block() {
  const std::size_t block = count_ / kLanes;
  if (block == motions_.size()) {
    motions_.emplace_back();
    separations_.emplace_back();
    tracks_.emplace_back();
    gaps_.emplace_back();
    for (auto* masks : {&exact_, &later_, &clear_, &blocked_}) masks->push_back(0);
  }
  // With these values set, other stale values in unused lanes have no effect.
  std::fill_n(motions_[block].x_m.lane, kLanes, kFarAway_m);
  std::fill_n(motions_[block].start_s.lane, kLanes, kDistantPast_s);
  std::fill_n(separations_[block].start_s.lane, kLanes, kDistantPast_s);
  exact_[block] = 0;
}

void BatchClearance::add(const TrajectoryBounds& bounds, double min_separation_m) {
  const std::size_t block = count_ / kLanes, lane = count_ % kLanes;
  if (lane == 0) begin_block();
  ++count_;
  is_sampled_ = false;
  if (!bounds.is_batchable) {
    exact_[block] = static_cast<std::uint8_t>(exact_[block] | 1u << lane);
    return;
  }
  MotionBlock& m = motions_[block];
  m.start_s.lane[lane] = to_seconds(bounds.start - base_);
  m.first_s.lane[lane] = bounds.first_s;
  m.x_m.lane[lane] = bounds.at_start.position_m.x();
  m.y_m.lane[lane] = bounds.at_start.position_m.y();
  m.vx_mps.lane[lane] = bounds.at_start.velocity_mps.x();
  m.vy_mps.lane[lane] = bounds.at_start.velocity_mps.y();
  m.half_ax.lane[lane] = bounds.first_half_mps2.x();
  m.half_ay.lane[lane] = bounds.first_half_mps2.y();
  m.second_s.lane[lane] = bounds.second_s;
  m.second_vx.lane[lane] = bounds.second_velocity_mps.x();
  m.second_vy.lane[lane] = bounds.second_velocity_mps.y();
  m.second_half_ax.lane[lane] = bounds.second_half_mps2.x();
  m.second_half_ay.lane[lane] = bounds.second_half_mps2.y();
  separations_[block].start_s.lane[lane] = m.start_s.lane[lane];
  separations_[block].min_separation_m.lane[lane] = min_separation_m;
  separations_[block].acceleration_mps2.lane[lane] = bounds.acceleration_mps2;
}

void BatchClearance::sample(Time begin, double min_span_s) {
  const double begin_s = to_seconds(begin - base_);
  if (is_sampled_ && begin_s == begin_s_ && kSteps * step_s_ >= min_span_s) return;
  const double rest_s = kernels_->comparison.find_rest(motions_.data(), blocks(), begin_s + min_span_s,
                                                       begin_s + kMaxHorizon_s, later_.data());
  begin_s_ = begin_s;
  step_s_ = (rest_s - begin_s) / kSteps;
  kernels_->comparison.sample(motions_.data(), blocks(), begin_s_, step_s_, tracks_.data());
  is_sampled_ = true;
}

void BatchClearance::compare(const Track& reference, double acceleration, double extra_clearance_m) {
  const ComparisonSettings settings = comparison_settings(begin_s_, step_s_, acceleration, extra_clearance_m);
  kernels_->comparison.compare(settings, reference, tracks_.data(), separations_.data(), false, blocks(),
                               false, gaps_.data());
  kernels_->comparison.decide(gaps_.data(), blocks(), clear_.data(), blocked_.data());
}

bool BatchClearance::are_all_clear() const {
  for (std::size_t block = 0; block < blocks(); ++block) {
    if (exact_[block] != 0 || later_[block] != 0 || clear_[block] != 0xff) return false;
  }
  return true;
}

Track BatchClearance::track(std::size_t lane) const {
  return track_of(tracks_[lane / kLanes], lane % kLanes);
}

double BatchClearance::start_s(std::size_t lane) const {
  return separations_[lane / kLanes].start_s.lane[lane % kLanes] - begin_s_;
}

}  // namespace sidestep::batch
