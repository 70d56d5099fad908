// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/candidate_set.hpp"

#include <algorithm>
#include <limits>

#include "common/motion/robot_model.hpp"

namespace sidestep {
namespace {

using batch::kLanes;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t blocks_for(std::size_t count) { return (count + kLanes - 1) / kLanes; }

/// Settings with which batch::ChoiceKernels::limit limits sampled accelerations in the same way as
/// limit_acceleration().
batch::LimitSettings limit_settings(const Vec2& velocity, const Vec2& desired, const MotionLimits& limits,
                                    Duration duration) {
  const double seconds = to_seconds(duration);
  const Vec2 forward = forward_of(velocity);
  return {forward.x(),
          forward.y(),
          velocity.x(),
          velocity.y(),
          is_at_rest(velocity),
          1 / (limits.acceleration_mps2 * limits.acceleration_mps2),
          1 / (limits.deceleration_mps2 * limits.deceleration_mps2),
          is_at_rest(velocity) ? 0 : 1 / velocity.norm(),
          limits.speed_mps,
          seconds,
          1 / seconds,
          desired.x(),
          desired.y()};
}

}  // namespace

CandidateSet::CandidateSet(int samples, const MotionLimits& limits, const batch::Kernels& kernels)
    : kernels_(&kernels),
      limits_(limits),
      count_(static_cast<std::size_t>(samples) + 1),
      sampled_x_(count_),
      sampled_y_(count_),
      accelerations_(blocks_for(count_)),
      motions_(blocks_for(count_)),
      tracks_(blocks_for(count_)),
      gaps_(blocks_for(count_)) {}

void CandidateSet::sample_accelerations(const Vec2& velocity, const Vec2& desired, Duration hold_time,
                                        double max_speed, Rng& rng) {
  batch::LimitSettings settings = limit_settings(velocity, desired, limits_, hold_time);
  settings.speed_limit_mps = max_speed;
  sample_in_velocity_frame(settings.is_at_rest, limits_, rng, count_ - 1, sampled_x_.data(),
                           sampled_y_.data());
  for (std::size_t i = 1; i < count_; ++i) {
    accelerations_[i / kLanes].x.lane[i % kLanes] = sampled_x_[i - 1];
    accelerations_[i / kLanes].y.lane[i % kLanes] = sampled_y_[i - 1];
  }
  kernels_->choice.limit(settings, accelerations_.data(), accelerations_.size());
  accelerations_[0].x.lane[0] = desired.x();
  accelerations_[0].y.lane[0] = desired.y();
  accelerations_[0].distance2.lane[0] = 0;
  for (std::size_t i = count_; i < accelerations_.size() * kLanes; ++i)
    accelerations_[i / kLanes].distance2.lane[i % kLanes] = kInfinity;
  for (batch::GapBlock& gap : gaps_) {
    std::fill_n(gap.clear.lane, kLanes, kInfinity);
    std::fill_n(gap.blocked.lane, kLanes, kInfinity);
  }
  accepted_.reset();
}

void CandidateSet::prefer(std::span<const Vec2> accelerations) {
  constexpr double kStep = 1e-12;  // ranks them in their order, before all samples
  for (std::size_t i = 1; i < count_ && i <= accelerations.size(); ++i) {
    batch::AccelerationBlock& block = accelerations_[i / kLanes];
    block.x.lane[i % kLanes] = accelerations[i - 1].x();
    block.y.lane[i % kLanes] = accelerations[i - 1].y();
    block.distance2.lane[i % kLanes] = kStep * static_cast<double>(i);
  }
}

void CandidateSet::sample_motions(const State& at_start, double hold_s, double step_s) {
  const batch::StopSettings settings{at_start.position_m.x(),
                                     at_start.position_m.y(),
                                     at_start.velocity_mps.x(),
                                     at_start.velocity_mps.y(),
                                     hold_s,
                                     limits_.deceleration_mps2};
  step_s_ = step_s;
  kernels_->choice.stop(settings, accelerations_.data(), accelerations_.size(), motions_.data());
  kernels_->comparison.sample(motions_.data(), motions_.size(), 0, step_s, tracks_.data());
}

void CandidateSet::compare(const batch::Track& other, double start_s, double min_separation_m,
                           double other_acceleration) {
  // The factor covers rounding errors.
  const double own_acceleration = 1.001 * std::max(limits_.acceleration_mps2, limits_.deceleration_mps2);
  batch::SeparationBlock separation{};
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    separation.start_s.lane[lane] = start_s;
    separation.min_separation_m.lane[lane] = min_separation_m;
    separation.acceleration_mps2.lane[lane] = own_acceleration;
  }
  kernels_->comparison.compare(batch::comparison_settings(0, step_s_, other_acceleration, 0), other,
                               tracks_.data(), &separation, true, tracks_.size(), true, gaps_.data());
}

std::optional<std::size_t> CandidateSet::take_nearest(double spread) {
  const Vec2 accepted = accepted_ ? acceleration(*accepted_) : Vec2(0, 0);
  const double spread2 = accepted_ ? spread * spread : 0;
  const std::size_t nearest = kernels_->choice.choose(
      accepted.x(), accepted.y(), spread2, accelerations_.data(), gaps_.data(), accelerations_.size());
  accepted_.reset();
  if (nearest >= count_) return std::nullopt;
  accelerations_[nearest / kLanes].distance2.lane[nearest % kLanes] = kInfinity;
  return nearest;
}

Vec2 CandidateSet::acceleration(std::size_t index) const {
  const batch::AccelerationBlock& block = accelerations_[index / kLanes];
  return {block.x.lane[index % kLanes], block.y.lane[index % kLanes]};
}

bool CandidateSet::is_certainly_clear(std::size_t index) const {
  return gaps_[index / kLanes].clear.lane[index % kLanes] >= 0;
}

}  // namespace sidestep
