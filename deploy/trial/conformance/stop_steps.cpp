// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "deploy/trial/conformance/motion_examination.hpp"
#include "deploy/trial/conformance/stop_observation.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

/// Accelerates on a straight line, and then sends nothing that would continue the motion.
class NoMoreCommandsStep final : public ConformanceStep {
 public:
  NoMoreCommandsStep(std::string rule, double speed_mps, bool is_silent)
      : rule_(std::move(rule)), speed_mps_(speed_mps), is_silent_(is_silent) {}

  std::string name() const override { return rule_; }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    const Time now = probe.now();
    if (!since_) prepare(context);
    if (!has_begun_) {
      context.stream.extend(drive_to(begin_m_, context.scenario.limits, 0.5));
      if (!is_at(context, begin_m_) && now - *since_ < kDriveTimeout) return false;
      has_begun_ = true;
      since_ = now;
    }
    if (!observation_) {
      const double speed_mps = speed_mps_;
      context.stream.extend([speed_mps](const State& from, Time) {
        return Vec2((Vec2(speed_mps, 0) - from.velocity_mps) / 0.05);
      });
      const auto& last = context.stream.last();
      const bool is_fast =
          last && last->trajectory.state_at(last->trajectory.start() + 3 * probe.cycle()).velocity_mps.x() >
                      0.97 * speed_mps_;
      const bool is_at_end =
          last && last->trajectory.rest_position_m().x() >
                      context.scenario.field.length_m / 2 - context.scenario.radius_m - 0.1;
      if (!is_fast && !is_at_end) return now - *since_ > kDriveTimeout && give_up(context);
      // The last version is sent until the robot has it.
      observation_.emplace(*last);
      probe.on_sample([this, &context](const MotionSample& sample) {
        keep_error(context, sample);
        observation_->add(sample);
      });
    }
    if (probe.robot_now() < observation_->stop().start() - context.stream.notice() + 2 * probe.cycle())
      return false;
    context.stream.stop();
    probe.sends_commands = !is_silent_;
    if (!observation_->is_over(probe.robot_now())) return false;
    probe.sends_commands = true;
    probe.on_sample(nullptr);
    judge(context);
    return true;
  }

 private:
  void prepare(ConformanceContext& context) {
    const Scenario& scenario = context.scenario;
    const double room_m = scenario.field.length_m - 2 * (scenario.radius_m + kEdge_m);
    const double f = 0.8 * scenario.limits.acceleration_mps2, d = scenario.limits.deceleration_mps2;
    speed_mps_ = std::min(speed_mps_, std::sqrt(2 * 0.8 * room_m / (1 / f + 1 / d)));
    begin_m_ = {-room_m / 2, 0};
    since_ = context.probe.now();
  }

  bool give_up(ConformanceContext& context) {
    context.stream.stop();
    context.report.rows.push_back(
        {rule_, Conformity::kNotJudged,
         fmt::format("the robot could not be accelerated to {:.2f} m/s", speed_mps_)});
    return true;
  }

  void judge(ConformanceContext& context) {
    if (const auto reason = observation_->why_not_judged()) {
      context.report.rows.push_back({rule_, Conformity::kNotJudged, *reason});
      return;
    }
    const double overshoot_m = observation_->overshoot_m(), error_m = observation_->rest_error_m();
    const Trajectory& stop = observation_->stop();
    const double from_mps = stop.state_at(stop.start() + 3 * context.probe.cycle()).velocity_mps.norm();
    const double d = context.scenario.limits.deceleration_mps2;
    const double braking_mps2 = from_mps * from_mps / (2 * (from_mps * from_mps / (2 * d) + overshoot_m));
    const double allowed_m = context.scenario.tracking_bound_m + kNoiseDeviations * context.vision_noise_m;
    const bool is_passed = overshoot_m <= allowed_m && error_m <= allowed_m;
    std::string figures = fmt::format(
        "from {:.2f} m/s it overshoots by {:.1f} mm and rests {:.1f} mm off its place: {:.2f} m/s² of "
        "{:g}",
        from_mps, overshoot_m * 1e3, error_m * 1e3, braking_mps2, d);
    if (observation_->has_own_stop()) figures += "; the robot made its own stop";
    const Conformity conformity = judged(is_passed, context, figures);
    context.report.rows.push_back({rule_, conformity, figures});
    if (!is_silent_) context.report.figures.is_within_limits = is_passed;
  }

  std::string rule_;
  double speed_mps_;
  bool is_silent_;
  Vec2 begin_m_{0, 0};
  std::optional<Time> since_;  ///< the beginning of the way to begin_m_, then of the acceleration
  bool has_begun_ = false;
  std::optional<StopObservation> observation_;
};

}  // namespace

std::unique_ptr<ConformanceStep> make_lost_commands_step() {
  return std::make_unique<NoMoreCommandsStep>("lost commands", 0.3, true);
}
std::unique_ptr<ConformanceStep> make_braking_step(const Scenario& scenario) {
  return std::make_unique<NoMoreCommandsStep>("braking", scenario.limits.speed_mps, false);
}

}  // namespace sidestep
