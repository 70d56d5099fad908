// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "deploy/trial/conformance/latency_fit.hpp"
#include "deploy/trial/conformance/motion_examination.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

// Number of starts from which the latency is measured, and how often vision must see them: slow cameras need
// more starts.
constexpr int kStarts = 8, kMaxStarts = 24;
constexpr std::size_t kMinStartSamples = 10;
constexpr Duration kExact = 3ms;
// The part of each start that is evaluated: later, the robot's control corrects for the latency.
constexpr Duration kStartBegin = 20ms, kStartEnd = 200ms;

/// Starts from rest repeatedly. How far the robot is then behind its reference shows how late its motors
/// respond, compared with what the robot assumes.
class LatencyStep final : public ConformanceStep {
 public:
  std::string name() const override { return "latency"; }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    const Time now = probe.now();
    if (!since_) {
      since_ = now;
      probe.on_sample([this, &context](const MotionSample& sample) {
        keep_error(context, sample);
        add(sample);
      });
    }
    if (!has_begun_) {
      // In the middle of the field there is room in all directions.
      context.stream.extend(drive_to({0, 0}, context.scenario.limits, 0.5));
      if (!is_at(context, {0, 0}) && now - *since_ < kDriveTimeout) return false;
      has_begun_ = true;
      context.stream.stop();
    }
    keep_report(context);
    if (!start_ && !context.stream.is_at_rest() && now - *since_ < 2 * kDriveTimeout) return false;
    if (starts_ < kStarts || (fit_.observations() < kMinStartSamples && starts_ < kMaxStarts)) {
      start(context);
      return false;
    }
    if (probe.robot_now() < start_->trajectory.end() + kSettlingTime) return false;
    probe.on_sample(nullptr);
    add_row(context);
    return true;
  }

 private:
  void start(ConformanceContext& context) {
    RobotProbe& probe = context.probe;
    if (start_ && probe.robot_now() < start_->trajectory.end() + 2 * kSettlingTime) return;
    context.stream.forget();
    const Time at = probe.robot_now() + context.stream.notice() + 200ms;
    const State from = probe.robot_report()->executing.trajectory.state_at(at);
    const Vec2 direction =
        rotated(Vec2(1, 0), std::numbers::pi * (starts_ % 2 + 0.25 * std::floor(starts_ / 2.0)));
    Trajectory trajectory(at, {from.position_m, Vec2(0, 0)});
    trajectory.append(250ms, 0.8 * context.scenario.limits.acceleration_mps2 * direction);
    append_stop(trajectory, context.scenario.limits.deceleration_mps2);
    start_ = context.stream.next(trajectory);
    fit_.begin_start(trajectory);
    probe.version = start_;
    rest_error_sum_m_ = Vec2(0, 0);
    before_count_ = 0;
    ++starts_;
  }

  void add(const MotionSample& sample) {
    if (!start_) return;
    const Time robot_at = sample.robot_at;
    const Duration after = robot_at - start_->trajectory.start();
    if (after < Duration{0}) {
      rest_error_sum_m_ += sample.seen_m - sample.reference.state.position_m;
      ++before_count_;
    }
    const bool is_executed = sample.reference.state.velocity_mps.norm() > 0 && !sample.is_off_reference;
    if (after < kStartBegin || after > kStartEnd || before_count_ == 0 || !is_executed) return;
    fit_.add(robot_at, sample.seen_m - rest_error_sum_m_ / before_count_);
  }

  void add_row(ConformanceContext& context) {
    if (fit_.observations() < kMinStartSamples) {
      context.report.rows.push_back(
          {"latency", Conformity::kNotJudged,
           fmt::format("vision saw {} starts of the robot {} times, fewer than {} times", starts_,
                       fit_.observations(), kMinStartSamples)});
      return;
    }
    const Duration lead = context.probe.robot_report()->lead;
    const LatencyFit::Result result = fit_.result();
    const MeasuredLatency measured{lead, result.late, result.uncertainty, context.scenario.limits.speed_mps};
    // The rest of the bound is for other errors. A latency within kExact is as exact as it can be measured.
    const double bound_m = context.scenario.tracking_bound_m;
    const double max_error_m =
        std::max(0.25 * bound_m, std::min(bound_m, to_seconds(kExact) * measured.speed_mps));
    context.is_late = !(std::abs(to_seconds(result.late)) * measured.speed_mps <= max_error_m);
    context.report.rows.push_back(latency_row(measured, max_error_m));
    if (context.report.rows.back().conformity != Conformity::kNotJudged || lead + result.late > Duration{0})
      context.report.figures.latency = std::max(Duration{0}, lead + result.late);
  }

  std::optional<Time> since_;
  bool has_begun_ = false;
  int starts_ = 0;
  std::optional<Version> start_;
  Vec2 rest_error_sum_m_{0, 0};  ///< the sum of the errors at rest, before the latest start
  int before_count_ = 0;
  LatencyFit fit_;
};

}  // namespace

std::unique_ptr<ConformanceStep> make_latency_step() { return std::make_unique<LatencyStep>(); }

}  // namespace sidestep
