// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/motion_predictor.hpp"

namespace sidestep {

using batch::kPredictionLanes;
using batch::kPredictionSamples;

MotionPredictor::MotionPredictor(const MotionLimits& limits, const batch::Kernels& kernels)
    : kernels_(&kernels),
      settings_{static_cast<float>(limits.speed_mps), static_cast<float>(limits.acceleration_mps2),
                static_cast<float>(limits.deceleration_mps2)} {}

std::size_t MotionPredictor::block_count() const { return (size_ + kPredictionLanes - 1) / kPredictionLanes; }

std::size_t MotionPredictor::add(const State& state, const Intent& intent) {
  const std::size_t lane = size_++, i = lane % kPredictionLanes;
  if (courses_.size() < block_count()) courses_.resize(block_count());
  batch::CourseBlock& c = courses_[lane / kPredictionLanes];
  const auto set = [i](batch::PredictionRow& row, double value) { row.lane[i] = static_cast<float>(value); };
  set(c.x_m, state.position_m.x());
  set(c.y_m, state.position_m.y());
  set(c.vx_mps, state.velocity_mps.x());
  set(c.vy_mps, state.velocity_mps.y());
  set(c.intent_vx, intent.velocity_mps.x());
  set(c.intent_vy, intent.velocity_mps.y());
  set(c.velocity_duration_s, intent.velocity_duration_s);
  set(c.waypoint_x, intent.waypoint_m.x());
  set(c.waypoint_y, intent.waypoint_m.y());
  set(c.goal_x, intent.goal_m.x());
  set(c.goal_y, intent.goal_m.y());
  return lane;
}

void MotionPredictor::predict() {
  if (predictions_.size() < block_count()) predictions_.resize(block_count());
  kernels_->prediction.roll_out(settings_, courses_.data(), block_count(), predictions_.data());
}

batch::Prediction MotionPredictor::prediction_of(std::size_t lane) const {
  const batch::PredictionBlock& block = predictions_[lane / kPredictionLanes];
  batch::Prediction prediction{};
  for (std::size_t i = 0; i < kPredictionSamples; ++i) {
    prediction.x_m[i] = block.x_m[i].lane[lane % kPredictionLanes];
    prediction.y_m[i] = block.y_m[i].lane[lane % kPredictionLanes];
  }
  return prediction;
}

double MotionPredictor::arrival_s(std::size_t lane) const {
  return predictions_[lane / kPredictionLanes].arrival_s.lane[lane % kPredictionLanes];
}

}  // namespace sidestep
