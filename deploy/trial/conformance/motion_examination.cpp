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

}  // namespace

/// A robot whose motors respond later or earlier than it assumes cannot follow its reference; only the
/// latency row then fails. If reports were missing during the step, this process, the robot's, or the network
/// between them paused, and versions may have come too late.
Conformity judged(bool is_passed, const ConformanceContext& context, std::string& figures) {
  if (is_passed) return Conformity::kPassed;
  if (context.is_late) {
    figures += "; its latency prevents it from following";
    return Conformity::kNotJudged;
  }
  const RobotProbe& probe = context.probe;
  if (probe.longest_gap() <= probe.max_gap()) return Conformity::kFailed;
  figures +=
      fmt::format("; a computer or the network is too busy: reports came {:.0f} ms apart, not {:.0f} ms",
                  to_seconds(probe.longest_gap()) * 1e3, to_seconds(probe.max_gap()) * 1e3);
  return Conformity::kNotJudged;
}

void keep_error(ConformanceContext& context, const MotionSample& sample) {
  if (sample.is_off_reference) return;
  const double error_m = (sample.seen_m - sample.reference.state.position_m).norm();
  auto& bound_m = context.report.figures.tracking_bound_m;
  bound_m = std::max(bound_m.value_or(0), std::ceil(kTrackingBoundRatio * error_m * 1e3) * 1e-3);
}

double bound_for_dead_reckoning_m(const LocalisationUncertainty& uncertainty, const Scenario& scenario,
                                  Duration lead) {
  const double speed_mps = scenario.limits.speed_mps;
  const double way_m = speed_mps * to_seconds(lead + 2 * scenario.cycle) +
                       speed_mps * speed_mps / (2 * scenario.limits.deceleration_mps2);
  const double error_m =
      std::hypot(3 * uncertainty.position_error_rms_m, 4 * uncertainty.odometry_scale_stddev * way_m);
  return error_m / drift_bound_m(1);
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
