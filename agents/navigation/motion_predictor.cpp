// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/motion_predictor.hpp"

namespace sidestep {

using batch::kForecastLanes;
using batch::kForecastSamples;

Forecasts::Forecasts(const MotionLimits& limits, const batch::Kernels& kernels)
    : kernels_(&kernels),
      settings_{static_cast<float>(limits.speed_mps), static_cast<float>(limits.acceleration_mps2),
                static_cast<float>(limits.deceleration_mps2)} {}

std::size_t Forecasts::block_count() const { return (size_ + kForecastLanes - 1) / kForecastLanes; }

std::size_t Forecasts::add(const State& state, const Intent& intent) {
  const std::size_t lane = size_++, i = lane % kForecastLanes;
  if (courses_.size() < block_count()) courses_.resize(block_count());
  batch::CourseBlock& c = courses_[lane / kForecastLanes];
  const auto set = [i](batch::ForecastRow& row, double value) { row.lane[i] = static_cast<float>(value); };
  set(c.x_m, state.position_m.x());
  set(c.y_m, state.position_m.y());
  set(c.vx_mps, state.velocity_mps.x());
  set(c.vy_mps, state.velocity_mps.y());
  set(c.hold_vx, intent.velocity_mps.x());
  set(c.hold_vy, intent.velocity_mps.y());
  set(c.hold_s, intent.hold_s);
  set(c.way_x, intent.waypoint_m.x());
  set(c.way_y, intent.waypoint_m.y());
  set(c.goal_x, intent.goal_m.x());
  set(c.goal_y, intent.goal_m.y());
  return lane;
}

void Forecasts::drive() {
  if (driven_.size() < block_count()) driven_.resize(block_count());
  kernels_->forecasting.drive(settings_, courses_.data(), block_count(), driven_.data());
}

batch::Forecast Forecasts::of(std::size_t lane) const {
  const batch::ForecastBlock& block = driven_[lane / kForecastLanes];
  batch::Forecast forecast;
  for (std::size_t i = 0; i < kForecastSamples; ++i) {
    forecast.x_m[i] = block.x_m[i].lane[lane % kForecastLanes];
    forecast.y_m[i] = block.y_m[i].lane[lane % kForecastLanes];
  }
  return forecast;
}

double Forecasts::arrival_s(std::size_t lane) const {
  return driven_[lane / kForecastLanes].arrival_s.lane[lane % kForecastLanes];
}

}  // namespace sidestep
