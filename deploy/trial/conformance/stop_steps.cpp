// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "deploy/trial/conformance/motion_examination.hpp"
#include "deploy/trial/conformance/stop_observation.hpp"
#include "deploy/trial/conformance/straight_run.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

/// Accelerates on a straight line, and then sends nothing that would continue the motion.
class NoMoreCommandsStep final : public ConformanceStep {
 public:
  NoMoreCommandsStep(const Scenario& scenario, std::string rule, double speed_mps, bool is_silent)
      : rule_(std::move(rule)), run_(scenario, speed_mps, Duration{0}), is_silent_(is_silent) {}

  std::string name() const override { return rule_; }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    keep_report(context);
    if (!observation_) {
      const StraightRun::Phase phase = run_.update(context);
      if (phase == StraightRun::Phase::kUnderWay) return false;
      if (phase == StraightRun::Phase::kGivenUp) return give_up(context);
      // The last version is sent until the robot has it.
      observation_.emplace(*context.stream.last());
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
  bool give_up(ConformanceContext& context) {
    context.stream.stop();
    context.report.rows.push_back(
        {rule_, Conformity::kNotJudged,
         fmt::format("the robot could not be accelerated to {:.2f} m/s", run_.speed_mps())});
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
  StraightRun run_;
  bool is_silent_;
  std::optional<StopObservation> observation_;
};

}  // namespace

std::unique_ptr<ConformanceStep> make_lost_commands_step(const Scenario& scenario) {
  return std::make_unique<NoMoreCommandsStep>(scenario, "lost commands", 0.3, true);
}
std::unique_ptr<ConformanceStep> make_braking_step(const Scenario& scenario) {
  return std::make_unique<NoMoreCommandsStep>(scenario, "braking", scenario.limits.speed_mps, false);
}

}  // namespace sidestep
