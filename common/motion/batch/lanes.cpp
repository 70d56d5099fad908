// SPDX-License-Identifier: Apache-2.0
#include "common/motion/batch/lanes.hpp"

#include <algorithm>
#include <limits>

#include "common/motion/clearance.hpp"

namespace sidestep::batch {
namespace {

// Far above all rounding, here and in the exact clearance; far below what matters.
constexpr double kRounding_m = 1e-7;
// Where a block's unused lanes are.
constexpr double kNowhere_m = 1e6;

}  // namespace

// A function whose second derivative is at most A is within A h^2 / 8 of its chord over a time h.
double deviation_m(double relative_acceleration_mps2, double step_s) {
  return 0.125 * relative_acceleration_mps2 * step_s * step_s;
}

void set_bounds(BoundsBlock& bounds, std::size_t lane, double keep_m, double deviation_m, double room_m) {
  const double allowance = deviation_m + kRounding_m + room_m;
  const double clear_from = keep_m + kClearanceTolerance_m + allowance;
  const double blocked_below = keep_m - allowance;
  bounds.clear_from.lane[lane] = clear_from > 0 ? clear_from * clear_from : 0;
  bounds.blocked_below.lane[lane] = blocked_below > 0 ? blocked_below * blocked_below : -1;
}

Track track_of(const TrackBlock& tracks, std::size_t lane) {
  Track track;
  for (std::size_t k = 0; k < kSamples; ++k) {
    track.x_m[k] = tracks.x_m[k].lane[lane];
    track.y_m[k] = tracks.y_m[k].lane[lane];
  }
  return track;
}

void Lanes::grow() {
  MotionBlock nowhere{};
  std::fill_n(nowhere.x_m.lane, kLanes, kNowhere_m);
  motions_.push_back(nowhere);
  tracks_.emplace_back();
  bounds_.push_back({});
  gaps_.emplace_back();
  keep_m_.resize(motions_.size() * kLanes);
  acceleration_mps2_.resize(motions_.size() * kLanes);
  rest_s_.resize(motions_.size() * kLanes);
}

void Lanes::add(const Outline& outline, double keep_m, Time begin) {
  if (count_ == motions_.size() * kLanes) grow();
  MotionBlock& m = motions_[count_ / kLanes];
  const std::size_t lane = count_ % kLanes;
  const double start_s = to_seconds(outline.start - begin);
  m.start_s.lane[lane] = start_s;
  m.first_s.lane[lane] = to_seconds(outline.first.duration);
  m.x_m.lane[lane] = outline.at_start.position_m.x();
  m.y_m.lane[lane] = outline.at_start.position_m.y();
  m.vx_mps.lane[lane] = outline.at_start.velocity_mps.x();
  m.vy_mps.lane[lane] = outline.at_start.velocity_mps.y();
  m.half_ax.lane[lane] = 0.5 * outline.first.acceleration_mps2.x();
  m.half_ay.lane[lane] = 0.5 * outline.first.acceleration_mps2.y();
  m.second_s.lane[lane] = to_seconds(outline.second.duration);
  m.second_vx.lane[lane] = outline.second_velocity_mps.x();
  m.second_vy.lane[lane] = outline.second_velocity_mps.y();
  m.second_half_ax.lane[lane] = 0.5 * outline.second.acceleration_mps2.x();
  m.second_half_ay.lane[lane] = 0.5 * outline.second.acceleration_mps2.y();
  bounds_[count_ / kLanes].start_s.lane[lane] = start_s;
  keep_m_[count_] = keep_m;
  acceleration_mps2_[count_] = outline.acceleration_mps2;
  rest_s_[count_] = start_s + outline.seconds;
  ++count_;
}

double Lanes::seconds() const {
  double longest = 0;
  for (std::size_t i = 0; i < count_; ++i) longest = std::max(longest, rest_s_[i]);
  return longest;
}

void Lanes::sample(const Kernels& kernels, double step_s) {
  step_s_ = step_s;
  kernels.sample(motions_.data(), blocks(), step_s, tracks_.data());
}

void Lanes::compare(const Kernels& kernels, const Track& one, double acceleration_mps2, double room_m) {
  constexpr double kUndecided = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count_; ++i) {
    const double deviation = deviation_m(acceleration_mps2 + acceleration_mps2_[i], step_s_);
    set_bounds(bounds_[i / kLanes], i % kLanes, keep_m_[i], deviation, room_m);
  }
  for (std::size_t block = 0; block < blocks(); ++block) {
    std::fill_n(gaps_[block].clear.lane, kLanes, kUndecided);
    std::fill_n(gaps_[block].blocked.lane, kLanes, kUndecided);
  }
  kernels.compare(one, tracks_.data(), bounds_.data(), false, blocks(), step_s_, gaps_.data());
}

Track Lanes::track(std::size_t lane) const { return track_of(tracks_[lane / kLanes], lane % kLanes); }

}  // namespace sidestep::batch
