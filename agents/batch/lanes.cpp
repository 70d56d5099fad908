// SPDX-License-Identifier: Apache-2.0
#include "agents/batch/lanes.hpp"

#include <algorithm>

#include "common/motion/clearance.hpp"

namespace sidestep::batch {
namespace {

// Far above all rounding, here and in the exact clearance; far below what matters.
constexpr double kRounding_m = 1e-6;
// Where lanes are that do not count.
constexpr double kNowhere_m = 1e6;
constexpr double kLongAgo_s = -1e6;

}  // namespace

ComparisonSettings comparison(double begin_s, double step_s, double acceleration, double extra_clearance_m) {
  return {begin_s, step_s, acceleration, extra_clearance_m + kClearanceTolerance_m + kRounding_m, extra_clearance_m + kRounding_m};
}

Track track_of(const TrackBlock& tracks, std::size_t lane) {
  Track track;
  for (std::size_t k = 0; k < kSamples; ++k) {
    track.x_m[k] = tracks.x_m[k].lane[lane];
    track.y_m[k] = tracks.y_m[k].lane[lane];
  }
  return track;
}

Track track_of(const TrajectoryBounds& outline, Time begin, double step_s) {
  const double from_s = to_seconds(begin - outline.start);
  Track track;
  for (std::size_t k = 0; k < kSamples; ++k) {
    const double into = from_s + static_cast<double>(k) * step_s;
    const double t = std::min(std::max(into, -step_s), outline.first_s);
    const double u = std::min(std::max(into - outline.first_s, 0.0), outline.second_s);
    const Vec2 position = outline.at_start.position_m +
                          t * (outline.at_start.velocity_mps + t * outline.first_half_mps2) +
                          u * (outline.second_velocity_mps + u * outline.second_half_mps2);
    track.x_m[k] = position.x();
    track.y_m[k] = position.y();
  }
  return track;
}

void Lanes::restart(Time base) {
  base_ = base;
  count_ = 0;
  is_sampled_ = false;
}

void Lanes::begin_block() {
  const std::size_t block = count_ / kLanes;
  if (block == motions_.size()) {
    motions_.emplace_back();
    keeps_.emplace_back();
    tracks_.emplace_back();
    gaps_.emplace_back();
    for (auto* masks : {&exact_, &later_, &clear_, &blocked_}) masks->push_back(0);
  }
  // Whatever else is left there from another time does not matter.
  std::fill_n(motions_[block].x_m.lane, kLanes, kNowhere_m);
  std::fill_n(motions_[block].start_s.lane, kLanes, kLongAgo_s);
  std::fill_n(keeps_[block].start_s.lane, kLanes, kLongAgo_s);
  exact_[block] = 0;
}

void Lanes::add(const TrajectoryBounds& outline, double min_separation_m) {
  const std::size_t block = count_ / kLanes, lane = count_ % kLanes;
  if (lane == 0) begin_block();
  ++count_;
  is_sampled_ = false;
  if (!outline.is_plain) {
    exact_[block] = static_cast<std::uint8_t>(exact_[block] | 1u << lane);
    return;
  }
  MotionBlock& m = motions_[block];
  m.start_s.lane[lane] = to_seconds(outline.start - base_);
  m.first_s.lane[lane] = outline.first_s;
  m.x_m.lane[lane] = outline.at_start.position_m.x();
  m.y_m.lane[lane] = outline.at_start.position_m.y();
  m.vx_mps.lane[lane] = outline.at_start.velocity_mps.x();
  m.vy_mps.lane[lane] = outline.at_start.velocity_mps.y();
  m.half_ax.lane[lane] = outline.first_half_mps2.x();
  m.half_ay.lane[lane] = outline.first_half_mps2.y();
  m.second_s.lane[lane] = outline.second_s;
  m.second_vx.lane[lane] = outline.second_velocity_mps.x();
  m.second_vy.lane[lane] = outline.second_velocity_mps.y();
  m.second_half_ax.lane[lane] = outline.second_half_mps2.x();
  m.second_half_ay.lane[lane] = outline.second_half_mps2.y();
  keeps_[block].start_s.lane[lane] = m.start_s.lane[lane];
  keeps_[block].min_separation_m.lane[lane] = min_separation_m;
  keeps_[block].acceleration_mps2.lane[lane] = outline.acceleration_mps2;
}

void Lanes::sample(Time begin, double at_least_s) {
  const double begin_s = to_seconds(begin - base_);
  if (is_sampled_ && begin_s == begin_s_ && kSteps * step_s_ >= at_least_s) return;
  const double rest_s = kernels_->comparing.rest(motions_.data(), blocks(), begin_s + at_least_s,
                                                 begin_s + kLongest_s, later_.data());
  begin_s_ = begin_s;
  step_s_ = (rest_s - begin_s) / kSteps;
  kernels_->comparing.sample(motions_.data(), blocks(), begin_s_, step_s_, tracks_.data());
  is_sampled_ = true;
}

void Lanes::compare(const Track& one, double acceleration, double extra_clearance_m) {
  const ComparisonSettings settings = comparison(begin_s_, step_s_, acceleration, extra_clearance_m);
  kernels_->comparing.compare(settings, one, tracks_.data(), keeps_.data(), false, blocks(), false,
                              gaps_.data());
  kernels_->comparing.decide(gaps_.data(), blocks(), clear_.data(), blocked_.data());
}

bool Lanes::are_all_clear() const {
  for (std::size_t block = 0; block < blocks(); ++block) {
    if (exact_[block] != 0 || later_[block] != 0 || clear_[block] != 0xff) return false;
  }
  return true;
}

Track Lanes::track(std::size_t lane) const { return track_of(tracks_[lane / kLanes], lane % kLanes); }

double Lanes::start_s(std::size_t lane) const {
  return keeps_[lane / kLanes].start_s.lane[lane % kLanes] - begin_s_;
}

}  // namespace sidestep::batch
