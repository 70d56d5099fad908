// SPDX-License-Identifier: Apache-2.0
#include "common/motion/forecast.hpp"

namespace sidestep {

using batch::kForecastSamples;
using batch::kLanes;

Forecasts::Forecasts(const MotionLimits& limits, const batch::Kernels& kernels)
    : kernels_(&kernels), settings_{limits.speed_mps, limits.acceleration_mps2, limits.deceleration_mps2} {}

std::size_t Forecasts::block_count() const { return (size_ + kLanes - 1) / kLanes; }

std::size_t Forecasts::add(const State& state, const Intent& intent) {
  const std::size_t lane = size_++, i = lane % kLanes;
  if (courses_.size() < block_count()) courses_.resize(block_count());
  batch::CourseBlock& c = courses_[lane / kLanes];
  c.x_m.lane[i] = state.position_m.x();
  c.y_m.lane[i] = state.position_m.y();
  c.vx_mps.lane[i] = state.velocity_mps.x();
  c.vy_mps.lane[i] = state.velocity_mps.y();
  c.hold_vx.lane[i] = intent.velocity_mps.x();
  c.hold_vy.lane[i] = intent.velocity_mps.y();
  c.hold_s.lane[i] = intent.hold_s;
  c.way_x.lane[i] = intent.waypoint_m.x();
  c.way_y.lane[i] = intent.waypoint_m.y();
  c.goal_x.lane[i] = intent.goal_m.x();
  c.goal_y.lane[i] = intent.goal_m.y();
  return lane;
}

void Forecasts::drive() {
  if (driven_.size() < block_count()) driven_.resize(block_count());
  kernels_->forecasting.drive(settings_, courses_.data(), block_count(), driven_.data());
}

batch::Forecast Forecasts::of(std::size_t lane) const {
  const batch::ForecastBlock& block = driven_[lane / kLanes];
  batch::Forecast forecast;
  for (std::size_t i = 0; i < kForecastSamples; ++i) {
    forecast.x_m[i] = block.x_m[i].lane[lane % kLanes];
    forecast.y_m[i] = block.y_m[i].lane[lane % kLanes];
  }
  return forecast;
}

double Forecasts::arrival_s(std::size_t lane) const {
  return driven_[lane / kLanes].arrival_s.lane[lane % kLanes];
}

}  // namespace sidestep
