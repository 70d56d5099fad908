// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/candidate_choice.hpp"

#include <algorithm>
#include <limits>

#include "common/motion/robot_model.hpp"

namespace sidestep {
namespace {

using batch::kLanes;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t blocks_for(std::size_t count) { return (count + kLanes - 1) / kLanes; }

}  // namespace

CandidateChoice::CandidateChoice(int samples, const MotionLimits& limits, const batch::Kernels& kernels)
    : kernels_(&kernels),
      limits_(limits),
      count_(static_cast<std::size_t>(samples) + 1),
      drawn_x_(count_),
      drawn_y_(count_),
      accelerations_(blocks_for(count_)),
      motions_(blocks_for(count_)),
      tracks_(blocks_for(count_)),
      gaps_(blocks_for(count_)) {}

void CandidateChoice::draw(const Vec2& velocity, const Vec2& desired, Duration phase, Rng& rng) {
  const batch::LimitSettings settings = limit_settings(velocity, desired, limits_, phase);
  sample_ahead(settings.is_at_rest, limits_, rng, count_ - 1, drawn_x_.data(), drawn_y_.data());
  for (std::size_t i = 1; i < count_; ++i) {
    accelerations_[i / kLanes].x.lane[i % kLanes] = drawn_x_[i - 1];
    accelerations_[i / kLanes].y.lane[i % kLanes] = drawn_y_[i - 1];
  }
  kernels_->choosing.limit(settings, accelerations_.data(), accelerations_.size());
  accelerations_[0].x.lane[0] = desired.x();
  accelerations_[0].y.lane[0] = desired.y();
  accelerations_[0].distance2.lane[0] = 0;
  for (std::size_t i = count_; i < accelerations_.size() * kLanes; ++i)
    accelerations_[i / kLanes].distance2.lane[i % kLanes] = kInfinity;
  for (batch::GapBlock& gap : gaps_) {
    std::fill_n(gap.clear.lane, kLanes, kInfinity);
    std::fill_n(gap.blocked.lane, kLanes, kInfinity);
  }
  last_kept_.reset();
}

void CandidateChoice::sample(const State& at_start, double phase_s, double step_s) {
  const batch::StopSettings settings{at_start.position_m.x(),
                                     at_start.position_m.y(),
                                     at_start.velocity_mps.x(),
                                     at_start.velocity_mps.y(),
                                     phase_s,
                                     limits_.deceleration_mps2};
  step_s_ = step_s;
  kernels_->choosing.stop(settings, accelerations_.data(), accelerations_.size(), motions_.data());
  kernels_->comparing.sample(motions_.data(), motions_.size(), 0, step_s, tracks_.data());
}

void CandidateChoice::compare(const batch::Track& other, double start_s, double min_separation_m,
                              double other_acceleration) {
  // A little more than the largest, for rounding.
  const double own = 1.001 * std::max(limits_.acceleration_mps2, limits_.deceleration_mps2);
  batch::KeepBlock keep;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    keep.start_s.lane[lane] = start_s;
    keep.min_separation_m.lane[lane] = min_separation_m;
    keep.acceleration_mps2.lane[lane] = own;
  }
  kernels_->comparing.compare(batch::comparison(0, step_s_, other_acceleration, 0), other, tracks_.data(),
                              &keep, true, tracks_.size(), true, gaps_.data());
}

std::optional<std::size_t> CandidateChoice::take_nearest(double spread) {
  const Vec2 kept = last_kept_ ? acceleration(*last_kept_) : Vec2(0, 0);
  const double spread2 = last_kept_ ? spread * spread : 0;
  const std::size_t nearest = kernels_->choosing.choose(kept.x(), kept.y(), spread2, accelerations_.data(),
                                                        gaps_.data(), accelerations_.size());
  last_kept_.reset();
  if (nearest >= count_) return std::nullopt;
  accelerations_[nearest / kLanes].distance2.lane[nearest % kLanes] = kInfinity;
  return nearest;
}

Vec2 CandidateChoice::acceleration(std::size_t index) const {
  const batch::AccelerationBlock& block = accelerations_[index / kLanes];
  return {block.x.lane[index % kLanes], block.y.lane[index % kLanes]};
}

bool CandidateChoice::is_certainly_clear(std::size_t index) const {
  return gaps_[index / kLanes].clear.lane[index % kLanes] >= 0;
}

}  // namespace sidestep
