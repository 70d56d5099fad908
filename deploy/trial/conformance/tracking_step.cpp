// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <vector>

#include "deploy/trial/conformance/figure_of_eight.hpp"
#include "deploy/trial/conformance/motion_examination.hpp"
#include "deploy/trial/conformance/turn_rate.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

// The part of the acceleration limit that the curves of the figure of eight use.
constexpr double kUsedAcceleration = 0.5;
constexpr double kSpeedRamp_mps2 = 1, kMaxAmplitude_m = 3;
constexpr int kSpeedLevels = 4, kTurningLevels = 2;
constexpr Duration kLevelTime = 5s;
// The time between two turns.
constexpr Duration kTurnTime = 1500ms;
// Noise of the fastest turn.
constexpr double kTurnNoise_radps = 0.1;

/// The errors at one speed.
struct SpeedLevel {
  double speed_mps = 0;
  std::size_t samples = 0;
  double max_error_m = 0;
};

/// Drives figures of eight, faster and faster. With `turns` the robot also turns by 90 degrees and back, as
/// robots do whose heading differs from that of their goal.
class TrackingStep final : public ConformanceStep {
 public:
  TrackingStep(const Scenario& scenario, bool turns)
      : turns_(turns),
        rule_(turns ? "turning" : "tracking"),
        limits_(scenario.limits),
        amplitude_m_(amplitude(scenario)),
        path_(amplitude_m_) {
    max_speed_mps_ = std::min(limits_.speed_mps, std::sqrt(2 * kSpeedRamp_mps2 * amplitude_m_));
    const int count = turns ? kTurningLevels : kSpeedLevels;
    for (int i = 1; i <= count; ++i) levels_.push_back({max_speed_mps_ * i / count});
  }

  std::string name() const override {
    return has_begun_ ? fmt::format("{} at {:.1f} m/s", rule_, speed_mps_)
                      : fmt::format("{}: on the way to the centre", rule_);
  }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    const Time now = probe.now();
    if (!since_) since_ = now;
    if (!has_begun_) {
      context.stream.extend(drive_to({0, 0}, limits_, 0.5));
      if (!is_at(context, {0, 0})) return now - *since_ > kDriveTimeout && give_up(context);
      begin(context);
    }
    keep_report(context);
    if (turns_) turn(probe);
    if (now < level_since_) return false;
    if (level_ + 1 == levels_.size()) keep_uncertainty(context);
    const bool has_stopped = context.stream.own_stops() > own_stops_before_;
    const bool is_broken = has_stopped || context.stream.late_versions() > late_before_;
    if (has_stopped && !stopped_at_mps_) stopped_at_mps_ = recent_speed_mps();
    is_late_ = is_late_ || (is_broken && !has_stopped);
    if (level_ < levels_.size() && (now - level_since_ > kLevelTime || is_broken)) {
      level_ = is_broken ? levels_.size() : level_ + 1;
      level_since_ = now;
    }
    if (level_ < levels_.size() || speed_mps_ > 0.1) {
      context.stream.extend([this](const State& from, Time) { return follow(from); });
      return false;
    }
    context.stream.stop();
    probe.desired_heading_rad.reset();
    if (!context.stream.is_at_rest() && now - level_since_ < kDriveTimeout) return false;
    probe.on_sample(nullptr);
    add_rows(context);
    return true;
  }

 private:
  void begin(ConformanceContext& context) {
    has_begun_ = true;
    own_stops_before_ = context.stream.own_stops();
    late_before_ = context.stream.late_versions();
    // A robot that is to turn does so at rest first, where it turns fastest.
    level_since_ = context.probe.now() + (turns_ ? 2 * kTurnTime : Duration{0});
    heading_rad_ = context.probe.robot_report()->heading_rad;
    context.probe.on_sample([this, &context](const MotionSample& sample) {
      keep_error(context, sample);
      add(sample);
    });
  }

  void turn(RobotProbe& probe) {
    if (level_ == levels_.size()) return;
    const bool is_turned = (probe.now() - level_since_ + 2 * kTurnTime) / kTurnTime % 2 == 0;
    probe.desired_heading_rad = wrapped_rad(heading_rad_ + (is_turned ? std::numbers::pi / 2 : 0));
    if (probe.seen() && probe.seen_heading_rad())
      turn_rate_.add(probe.seen()->observed_at, *probe.seen_heading_rad());
  }

  static double amplitude(const Scenario& scenario) {
    const double room_x = scenario.field.length_m / 2 - scenario.radius_m - kEdge_m;
    const double room_y = scenario.field.width_m / 2 - scenario.radius_m - kEdge_m;
    return std::clamp(std::min(room_x, 2 * room_y), 0.2, kMaxAmplitude_m);
  }

  Vec2 follow(const State& from) {
    constexpr double kStep_s = 0.05;
    const double goal_mps = level_ < levels_.size() ? levels_[level_].speed_mps : 0;
    const double curve_mps = std::min(goal_mps, curve_speed_mps());
    speed_mps_ += std::clamp(curve_mps - speed_mps_, -kSpeedRamp_mps2 * kStep_s, kSpeedRamp_mps2 * kStep_s);
    const Vec2 here = path_.at(t_);
    t_ += kStep_s * speed_mps_ / path_.derivative(t_).norm();
    const Vec2 wanted_mps = speed_mps_ * path_.derivative(t_).normalized();
    return (wanted_mps - from.velocity_mps) / kStep_s + 4 * (here - from.position_m);
  }

  /// The speed from which the robot can slow down for the curves ahead.
  double curve_speed_mps() const {
    constexpr double kAhead = 0.02;
    double speed_mps = limits_.speed_mps, distance_m = 0;
    for (double t = t_; distance_m < 2; t += kAhead) {
      const double square =
          kUsedAcceleration * limits_.acceleration_mps2 / std::max(0.01, path_.curvature_pm(t));
      speed_mps = std::min(speed_mps, std::sqrt(square + 2 * kSpeedRamp_mps2 * distance_m));
      distance_m += kAhead * path_.derivative(t).norm();
    }
    return speed_mps;
  }

  void add(const MotionSample& sample) {
    if (sample.is_off_reference) return;
    const Vec2 velocity_mps = sample.reference.state.velocity_mps;
    const Vec2 error_m = sample.seen_m - sample.reference.state.position_m;
    SpeedLevel& level = levels_[std::min(level_, levels_.size() - 1)];
    ++level.samples;
    level.max_error_m = std::max(level.max_error_m, error_m.norm());
    samples_.push_back({sample.robot_at, error_m.norm(), velocity_mps.norm()});
  }

  /// The fastest reference of the last second: when an own stop is reported, the robot is slower already.
  double recent_speed_mps() const {
    double speed_mps = 0;
    for (auto sample = samples_.rbegin(); sample != samples_.rend(); ++sample) {
      if (samples_.back().at - sample->at > 1s) break;
      speed_mps = std::max(speed_mps, sample->speed_mps);
    }
    return speed_mps;
  }

  bool give_up(ConformanceContext& context) {
    context.probe.on_sample(nullptr);
    context.report.rows.push_back(
        {rule_, Conformity::kFailed, "the robot does not reach the middle of the field"});
    return true;
  }

  void add_rows(ConformanceContext& context) {
    const double bound_m = context.scenario.tracking_bound_m,
                 noise_m = kNoiseDeviations * context.vision_noise_m;
    double max_error_m = 0;
    for (const Sample& sample : samples_) max_error_m = std::max(max_error_m, sample.error_m);
    std::string figures;
    bool has_stopped = stopped_at_mps_.has_value();
    if (!turns_) {
      max_error_m = std::max(max_error_m, context.first_drive.error_m);
      has_stopped = has_stopped || context.first_drive.has_own_stop;
      figures = fmt::format("{:.1f} mm on the first drive, ", context.first_drive.error_m * 1e3);
    }
    for (const SpeedLevel& level : levels_) {
      if (level.samples > 0)
        figures += fmt::format("{:.1f} mm at {:.1f} m/s, ", level.max_error_m * 1e3, level.speed_mps);
    }
    figures += fmt::format("bound {:.1f} mm", bound_m * 1e3);
    if (const auto rate_radps = turn_rate_.fastest_radps()) {
      figures += fmt::format("; it turned at up to {:.1f} rad/s", *rate_radps);
      // The fastest of many is too fast by the noise of headings.
      context.report.figures.turn_radps = std::floor((*rate_radps - kTurnNoise_radps) * 10) / 10;
    }
    if (!turns_ && context.first_drive.has_own_stop)
      figures += "; the robot made its own stop on the first drive";
    if (stopped_at_mps_)
      figures += fmt::format("; the robot made its own stop, at up to {:.1f} m/s", *stopped_at_mps_);
    const bool is_within = max_error_m <= bound_m + noise_m && !has_stopped;
    const Conformity conformity = judge(is_within, context, figures);
    context.report.rows.push_back({rule_, conformity, figures});
    if (turns_) return;
    // The figure of eight cannot be driven at the scenario's speed on a small field.
    context.report.figures.limits = limits_;
    if (is_within && !context.is_late)
      context.report.figures.limits.speed_mps =
          std::min(limits_.speed_mps, std::floor(max_speed_mps_ * 10 + 0.5) / 10);
  }

  Conformity judge(bool is_within, const ConformanceContext& context, std::string& figures) const {
    if (is_within && is_late_) {
      figures += "; the robot did not execute a version, which arrived too late or not at all";
      return Conformity::kNotJudged;
    }
    const Conformity conformity = judged(is_within, context, figures);
    if (conformity != Conformity::kFailed) return conformity;
    const double needed_m = context.report.figures.tracking_bound_m.value_or(0);
    if (needed_m > context.scenario.tracking_bound_m)
      figures += fmt::format("; examine it with a tracking_bound_m of at least {:.3f}", needed_m);
    if (turns_)
      figures += "; if the base turns more slowly than it is told, see --turn-speed of sidestep-robot";
    return conformity;
  }

  struct Sample {
    Time at;
    double error_m, speed_mps;
  };
  bool turns_;
  std::string rule_;
  MotionLimits limits_;
  double amplitude_m_;
  FigureOfEight path_;
  double max_speed_mps_ = 0, speed_mps_ = 0, t_ = 0;
  std::vector<SpeedLevel> levels_;
  std::size_t level_ = 0;
  std::vector<Sample> samples_;
  std::optional<Time> since_;
  Time level_since_{};
  bool has_begun_ = false;
  int own_stops_before_ = 0, late_before_ = 0;
  std::optional<double> stopped_at_mps_;  ///< the speed before the robot's own stop
  bool is_late_ = false;                  ///< the robot did not execute a version, and made no own stop
  double heading_rad_ = 0;                ///< at the begin
  TurnRate turn_rate_;
};

}  // namespace

std::unique_ptr<ConformanceStep> make_tracking_step(const Scenario& scenario) {
  return std::make_unique<TrackingStep>(scenario, false);
}
std::unique_ptr<ConformanceStep> make_turning_step(const Scenario& scenario) {
  return std::make_unique<TrackingStep>(scenario, true);
}

}  // namespace sidestep
