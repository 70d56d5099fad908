// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/batch/dispatch.hpp"
#include "common/motion/intent.hpp"
#include "common/motion/limits.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// Robots driven in thought, with the limits that they have and what they mean to do, over steps of
/// batch::kPredictionStep_s. Nobody promises to move like that. Allocates nothing once warm.
class MotionPredictor {
 public:
  explicit MotionPredictor(const MotionLimits& limits, const batch::Kernels& kernels = batch::best_kernels());

  void clear() { size_ = 0; }
  /// Returns the robot's lane.
  std::size_t add(const State& state, const Intent& intent);
  /// Drives all that were added.
  void drive();

  std::size_t size() const { return size_; }
  std::size_t block_count() const;
  const batch::PredictionBlock* blocks() const { return driven_.data(); }
  /// Where a robot is expected at the ends of the steps.
  batch::Prediction of(std::size_t lane) const;
  /// When it is expected at its goal, after its state; beyond the forecast by what is left of its way.
  double arrival_s(std::size_t lane) const;

 private:
  const batch::Kernels* kernels_;
  batch::DrivingSettings settings_;
  std::size_t size_ = 0;
  std::vector<batch::CourseBlock> courses_;
  std::vector<batch::PredictionBlock> driven_;
};

}  // namespace sidestep
