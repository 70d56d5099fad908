// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/batch/dispatch.hpp"
#include "common/motion/intent.hpp"
#include "common/motion/limits.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// Predicts the motion of robots from their states and intents within their motion limits, in steps of
/// batch::kPredictionStep_s. Predictions are not commitments: safety does not depend on them. Does not
/// allocate once warm.
class MotionPredictor {
 public:
  explicit MotionPredictor(const MotionLimits& limits, const batch::Kernels& kernels = batch::best_kernels());

  void clear() { size_ = 0; }
  /// Adds a robot and returns its lane.
  std::size_t add(const State& state, const Intent& intent);
  /// Computes the predictions of all robots added.
  void predict();

  std::size_t size() const { return size_; }
  std::size_t block_count() const;
  const batch::PredictionBlock* blocks() const { return predictions_.data(); }
  /// Predicted positions of a robot at the ends of the steps.
  batch::Prediction prediction_of(std::size_t lane) const;
  /// Predicted time from the robot's state to its arrival at the goal. For arrivals beyond the prediction
  /// horizon, the time for the remaining path is estimated and added.
  double arrival_s(std::size_t lane) const;

 private:
  const batch::Kernels* kernels_;
  batch::DrivingSettings settings_;
  std::size_t size_ = 0;
  std::vector<batch::CourseBlock> courses_;
  std::vector<batch::PredictionBlock> predictions_;
};

}  // namespace sidestep
