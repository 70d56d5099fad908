// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "deploy/trial/conformance/motion_examination.hpp"

namespace sidestep {
namespace {

/// Drives at full speed to the other end of the field and turns by 90 degrees meanwhile, before the robot has
/// learned by how much its base deviates from its commands. In a run, all robots start like this. The row
/// "tracking" has the result, because it depends on the latency, which is measured in between.
class FirstDriveStep final : public ConformanceStep {
 public:
  std::string name() const override { return "first drive"; }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    if (!since_) begin(context);
    keep_report(context);
    const bool has_stopped = context.stream.own_stops() > own_stops_before_;
    const bool is_over = is_at(context, goal_m_) || has_stopped || probe.now() - *since_ > kDriveTimeout;
    if (!is_over) {
      context.stream.extend(drive_to(goal_m_, context.scenario.limits, context.scenario.limits.speed_mps));
      return false;
    }
    context.stream.forget();
    probe.desired_heading_rad.reset();
    probe.on_sample(nullptr);
    // It cannot be repeated, because the robot has learned.
    context.first_drive.has_own_stop = has_stopped && !probe.why_busy();
    return true;
  }

 private:
  void begin(ConformanceContext& context) {
    since_ = context.probe.now();
    own_stops_before_ = context.stream.own_stops();
    const RobotReport& report = *context.probe.robot_report();
    const Vec2 place_m = report.executing.trajectory.state_at(report.valid_at).position_m;
    const double end_m = context.scenario.field.length_m / 2 - context.scenario.radius_m - kEdge_m;
    context.probe.desired_heading_rad = wrapped_rad(report.heading_rad + std::numbers::pi / 2);
    goal_m_ = {place_m.x() > 0 ? -end_m : end_m, place_m.y()};
    context.probe.on_sample([&context](const MotionSample& sample) {
      keep_error(context, sample);
      if (sample.is_off_reference) return;
      const double error_m = (sample.seen_m - sample.reference.state.position_m).norm();
      context.first_drive.error_m = std::max(context.first_drive.error_m, error_m);
    });
  }

  std::optional<Time> since_;
  Vec2 goal_m_{0, 0};
  int own_stops_before_ = 0;
};

}  // namespace

std::unique_ptr<ConformanceStep> make_first_drive_step() { return std::make_unique<FirstDriveStep>(); }

}  // namespace sidestep
