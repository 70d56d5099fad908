// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "deploy/trial/conformance/motion_examination.hpp"
#include "deploy/trial/conformance/straight_run.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

// How far a base may be driven by its last command and coast, for the choice of the speed.
constexpr Duration kAssumedMotion = 1600ms;
constexpr Duration kMaxSilence = 4s, kSeenAtRest = 400ms, kMinSilence = 700ms, kReturnTimeout = 8s;

/// Where vision sees a robot that moves along x without commands, and whether it rests.
class SilentMotion {
 public:
  SilentMotion(Time begin, double tolerance_m) : begin_(begin), tolerance_m_(tolerance_m) {}

  void add(const RobotObservation& seen) {
    if (seen.observed_at <= begin_ || (last_ && seen.observed_at <= last_->observed_at)) return;
    last_ = seen;
    end_m_ = std::max(end_m_, seen.position_m.x());
    if (!first_at_rest_ || (seen.position_m - first_at_rest_->position_m).norm() > tolerance_m_)
      first_at_rest_ = seen;
  }
  /// How long the robot has moved; nullopt while it moves.
  std::optional<Duration> moved_for() const {
    if (!last_ || last_->observed_at - begin_ < kMinSilence) return std::nullopt;
    if (last_->observed_at - first_at_rest_->observed_at < kSeenAtRest) return std::nullopt;
    return first_at_rest_->observed_at - begin_;
  }
  bool is_seen() const { return last_.has_value(); }
  /// The farthest position along x.
  double end_m() const { return end_m_; }

 private:
  Time begin_;
  double tolerance_m_, end_m_ = -INFINITY;
  std::optional<RobotObservation> first_at_rest_, last_;
};

/// Drives straight, and stops the process that drives the robot, so that commands end without a stop.
class SilenceStep final : public ConformanceStep {
 public:
  explicit SilenceStep(const Scenario& scenario)
      : run_(scenario, scenario.limits.speed_mps, kAssumedMotion) {}

  std::string name() const override { return "silence"; }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    const Time now = probe.now();
    if (!last_) {
      const StraightRun::Phase phase = run_.update(context);
      if (phase == StraightRun::Phase::kUnderWay) return false;
      if (phase == StraightRun::Phase::kGivenUp) return give_up(context);
      last_ = context.stream.last();
    }
    if (!motion_) {
      // The motors have then been sent what they do until the last version brakes. If commands end there, the
      // version is shortest beside the motion.
      brakes_at_ = last_->trajectory.start() + 3 * probe.cycle();
      if (probe.robot_now() < brakes_at_ - probe.robot_report()->lead) return false;
      motion_.emplace(now, 0.003 + kNoiseDeviations * context.vision_noise_m);
      silent_since_ = now;
      context.stream.forget();
      context.settings.stop_driver(true);
      is_silent_ = true;
    }
    if (is_silent_) {
      if (probe.seen()) motion_->add(*probe.seen());
      const double edge_m = context.scenario.field.length_m / 2 - context.scenario.radius_m - 0.1;
      is_at_edge_ = motion_->end_m() > edge_m;
      if (!motion_->moved_for() && now - silent_since_ < kMaxSilence && !is_at_edge_) return false;
      context.settings.stop_driver(false);
      is_silent_ = false;
      silent_until_ = now;
    }
    // The robot must find its pose again, and reports then.
    const bool has_returned = probe.report_at() > silent_until_ + kSeenAtRest && context.stream.is_at_rest();
    if (!has_returned && now - silent_until_ < kReturnTimeout) return false;
    context.stream.forget();
    add_row(context);
    return true;
  }

 private:
  bool give_up(ConformanceContext& context) {
    context.stream.stop();
    context.report.rows.push_back(
        {name(), Conformity::kNotJudged,
         fmt::format("the robot could not be accelerated to {:.2f} m/s", run_.speed_mps())});
    return true;
  }

  void add_row(ConformanceContext& context) {
    auto& rows = context.report.rows;
    const Trajectory& trajectory = last_->trajectory;
    const State begin = trajectory.state_at(brakes_at_);
    const double speed_mps = begin.velocity_mps.norm();
    const auto moved_for = motion_->moved_for();
    if (!motion_->is_seen()) {
      rows.push_back({name(), Conformity::kNotJudged, "vision did not see the robot when commands ended"});
      return;
    }
    if (!moved_for) {
      rows.push_back({name(), Conformity::kFailed,
                      fmt::format("when commands end at {:.2f} m/s, it still moves {}", speed_mps,
                                  is_at_edge_ ? "at the edge of the field" : "after 4 s")});
      return;
    }
    const double moved_m = motion_->end_m() - begin.position_m.x();
    const double beyond_m = std::max(0.0, motion_->end_m() - trajectory.rest_position_m().x());
    // The last command may have been sent up to a cycle before the driver stopped. A base that brakes moves
    // as far as the square of its speed.
    const double latest_m = beyond_m + to_seconds(context.probe.cycle()) * speed_mps;
    const double ratio = context.scenario.limits.speed_mps / speed_mps;
    const double silence_m = latest_m * std::max(1.0, ratio * ratio);
    const double max_m = context.settings.max_silence_m;
    std::string figures = fmt::format(
        "when commands end at {:.2f} m/s, it moves on for {:.1f} s and {:.2f} m, {:.2f} m beyond the stop of "
        "its version; at most {:.2f} m at {:.2f} m/s",
        speed_mps, to_seconds(*moved_for), moved_m, beyond_m, silence_m, context.scenario.limits.speed_mps);
    figures += fmt::format("; allowed {:g} m", max_m);
    const bool is_passed = silence_m <= max_m + kNoiseDeviations * context.vision_noise_m;
    if (!is_passed)
      figures +=
          fmt::format("; if robots may touch when sidestep-robot is killed, allow it by --silence-m {:.1f}",
                      std::ceil(silence_m * 10) / 10);
    rows.push_back({name(), passed_if(is_passed), figures});
    context.report.figures.silence_m = silence_m;
  }

  StraightRun run_;
  std::optional<Version> last_;
  std::optional<SilentMotion> motion_;
  Time brakes_at_{}, silent_since_{}, silent_until_{};
  bool is_silent_ = false, is_at_edge_ = false;
};

}  // namespace

std::unique_ptr<ConformanceStep> make_silence_step(const Scenario& scenario) {
  return std::make_unique<SilenceStep>(scenario);
}

}  // namespace sidestep
