// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/straight_run.hpp"

#include <algorithm>
#include <cmath>

#include "deploy/trial/conformance/motion_examination.hpp"

namespace sidestep {

StraightRun::StraightRun(const Scenario& scenario, double speed_mps, Duration free)
    : end_m_(scenario.field.length_m / 2 - scenario.radius_m - 0.1), begin_m_(0, 0) {
  const double room_m = scenario.field.length_m - 2 * (scenario.radius_m + kEdge_m);
  const double f = 0.8 * scenario.limits.acceleration_mps2, d = scenario.limits.deceleration_mps2;
  // v² (1/f + 1/d) / 2 + t v = 0.8 room
  const double a = 0.5 * (1 / f + 1 / d), t = to_seconds(free);
  speed_mps_ = std::min(speed_mps, (std::sqrt(t * t + 4 * a * 0.8 * room_m) - t) / (2 * a));
  begin_m_ = {-room_m / 2, 0};
}

StraightRun::Phase StraightRun::update(ConformanceContext& context) {
  RobotProbe& probe = context.probe;
  const Time now = probe.now();
  if (!since_) since_ = now;
  if (!has_begun_) {
    context.stream.extend(drive_to(begin_m_, context.scenario.limits, 0.5));
    if (!is_at(context, begin_m_) && now - *since_ < kDriveTimeout) return Phase::kUnderWay;
    has_begun_ = true;
    since_ = now;
  }
  const double speed_mps = speed_mps_;
  context.stream.extend(
      [speed_mps](const State& from, Time) { return Vec2((Vec2(speed_mps, 0) - from.velocity_mps) / 0.05); });
  const auto& last = context.stream.last();
  const bool is_fast =
      last && last->trajectory.state_at(last->trajectory.start() + 3 * probe.cycle()).velocity_mps.x() >
                  0.97 * speed_mps_;
  const bool is_at_end = last && last->trajectory.rest_position_m().x() > end_m_;
  if (is_fast || is_at_end) return Phase::kFast;
  return now - *since_ > kDriveTimeout ? Phase::kGivenUp : Phase::kUnderWay;
}

}  // namespace sidestep
