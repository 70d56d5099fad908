// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/motion_examination.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "common/motion/safety_budget.hpp"

namespace sidestep {
namespace {

// Ratio of the tracking bound to the largest measured error.
constexpr double kTrackingBoundRatio = 1.25;
// Ratio of the drift bound to three standard deviations of the estimate and four of the odometry's error.
constexpr double kUncertaintyRatio = 1.25;

void raise_bound(ConformanceContext& context, double needed_m) {
  auto& bound_m = context.report.figures.tracking_bound_m;
  bound_m = std::max(bound_m.value_or(0), std::ceil(needed_m * 1e3) * 1e-3);
}

}  // namespace

Conformity judged(bool is_passed, const ConformanceContext& context, std::string& figures) {
  if (is_passed) return Conformity::kPassed;
  if (context.is_late) {
    figures += "; its latency prevents it from following";
    return Conformity::kNotJudged;
  }
  return unless_busy(false, context.probe, figures);
}

void keep_error(ConformanceContext& context, const MotionSample& sample) {
  if (sample.is_off_reference) return;
  raise_bound(context, kTrackingBoundRatio * (sample.seen_m - sample.reference.state.position_m).norm());
}

void keep_report(ConformanceContext& context) {
  const RobotReport& report = *context.probe.robot_report();
  if (report.is_off_reference || report.is_lifted) {
    context.reported_error_m.reset();
    return;
  }
  if (context.reported_at == report.valid_at) return;
  const double error_m = report.tracking_error_m + 2 * report.uncertainty.position_error_rms_m;
  // An error in two reports in a row may have lasted for as long as the control may take.
  if (context.reported_error_m)
    raise_bound(context,
                kTrackingBoundRatio * std::min(*context.reported_error_m, error_m) / drift_bound_m(1));
  context.reported_error_m = error_m;
  context.reported_at = report.valid_at;
}

void keep_uncertainty(ConformanceContext& context) {
  const RobotReport& report = *context.probe.robot_report();
  const MotionLimits& limits = context.scenario.limits;
  const double way_m = limits.speed_mps * to_seconds(report.lead + 2 * context.scenario.cycle) +
                       limits.speed_mps * limits.speed_mps / (2 * limits.deceleration_mps2);
  const LocalisationUncertainty& uncertainty = report.uncertainty;
  const double error_m =
      std::hypot(3 * uncertainty.position_error_rms_m, 4 * uncertainty.odometry_scale_stddev * way_m);
  raise_bound(context, kUncertaintyRatio * error_m / drift_bound_m(1));
}

VersionStream::Policy drive_to(const Vec2& goal_m, const MotionLimits& limits, double speed_mps) {
  return [=](const State& from, Time) -> Vec2 {
    const Vec2 ahead_m = goal_m - from.position_m;
    const double distance_m = ahead_m.norm();
    const double wanted_mps = std::min(speed_mps, std::sqrt(2 * 0.3 * limits.deceleration_mps2 * distance_m));
    const Vec2 wanted = distance_m > 0.003 ? Vec2(ahead_m * (wanted_mps / distance_m)) : Vec2(0, 0);
    return (wanted - from.velocity_mps) / 0.15;
  };
}

bool is_at(const ConformanceContext& context, const Vec2& goal_m) {
  const Trajectory& trajectory = context.probe.robot_report()->executing.trajectory;
  const State now = trajectory.state_at(context.probe.robot_report()->valid_at);
  return (now.position_m - goal_m).norm() < 0.05 && now.velocity_mps.norm() < 0.05;
}

}  // namespace sidestep
