// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "deploy/trial/conformance/figure_of_eight.hpp"
#include "deploy/trial/conformance/motion_examination.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

// The part of the acceleration limit that the curves of the figure of eight use.
constexpr double kUsedAcceleration = 0.5;
constexpr double kSpeedRamp_mps2 = 1, kMaxAmplitude_m = 3;
constexpr int kSpeedLevels = 4;
constexpr Duration kLevelTime = 5s;

/// The errors at one speed.
struct SpeedLevel {
  double speed_mps = 0;
  std::size_t samples = 0;
  double max_error_m = 0;
};

class TrackingStep final : public ConformanceStep {
 public:
  explicit TrackingStep(const Scenario& scenario)
      : limits_(scenario.limits), amplitude_m_(amplitude(scenario)), path_(amplitude_m_) {
    max_speed_mps_ = std::min(limits_.speed_mps, std::sqrt(2 * kSpeedRamp_mps2 * amplitude_m_));
    for (int i = 1; i <= kSpeedLevels; ++i) levels_.push_back({max_speed_mps_ * i / kSpeedLevels});
  }

  std::string name() const override {
    return has_begun_ ? fmt::format("tracking at {:.1f} m/s", speed_mps_)
                      : "tracking: on the way to the centre";
  }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    const Time now = probe.now();
    if (!since_) since_ = now;
    if (!has_begun_) {
      context.stream.extend(drive_to({0, 0}, limits_, 0.5));
      if (!is_at(context, {0, 0})) return now - *since_ > kDriveTimeout && give_up(context);
      has_begun_ = true;
      broken_before_ = context.stream.broken();
      level_since_ = now;
      probe.on_sample([this, &context](const MotionSample& sample) {
        keep_error(context, sample);
        add(sample);
      });
    }
    keep_uncertainty(context);
    const bool is_broken = context.stream.broken() > broken_before_;
    if (is_broken && !broken_at_mps_) broken_at_mps_ = speed_mps_;
    if (level_ < levels_.size() && (now - level_since_ > kLevelTime || is_broken)) {
      level_ = is_broken ? levels_.size() : level_ + 1;
      level_since_ = now;
    }
    if (level_ < levels_.size() || speed_mps_ > 0.1) {
      context.stream.extend([this](const State& from, Time) { return follow(from); });
      return false;
    }
    context.stream.stop();
    if (!context.stream.is_at_rest() && now - level_since_ < kDriveTimeout) return false;
    probe.on_sample(nullptr);
    add_rows(context);
    return true;
  }

 private:
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
    samples_.push_back({error_m, velocity_mps});
  }

  /// At the highest speed, when the filter has learned the odometry's error, raises the bound for dead
  /// reckoning.
  void keep_uncertainty(ConformanceContext& context) {
    if (level_ + 1 != levels_.size()) return;
    const RobotReport& robot_report = *context.probe.robot_report();
    const double needed_m =
        bound_for_dead_reckoning_m(robot_report.uncertainty, context.scenario, robot_report.lead);
    auto& bound_m = context.report.figures.tracking_bound_m;
    bound_m = std::max(bound_m.value_or(0), std::ceil(needed_m * 1e3) * 1e-3);
  }

  bool give_up(ConformanceContext& context) {
    context.probe.on_sample(nullptr);
    context.report.rows.push_back(
        {"tracking", Conformity::kFailed, "the robot does not reach the middle of the field"});
    return true;
  }

  void add_rows(ConformanceContext& context) {
    const double bound_m = context.scenario.tracking_bound_m,
                 noise_m = kNoiseDeviations * context.vision_noise_m;
    double max_error_m = 0;
    for (const Sample& sample : samples_) max_error_m = std::max(max_error_m, sample.error_m.norm());
    std::string figures;
    for (const SpeedLevel& level : levels_) {
      if (level.samples > 0)
        figures += fmt::format("{:.1f} mm at {:.1f} m/s, ", level.max_error_m * 1e3, level.speed_mps);
    }
    figures += fmt::format("bound {:.1f} mm", bound_m * 1e3);
    const bool is_within = max_error_m <= bound_m + noise_m && !broken_at_mps_;
    if (broken_at_mps_)
      figures += fmt::format("; the robot left the reference at {:.1f} m/s", *broken_at_mps_);
    const Conformity conformity = judged(is_within, context, figures);
    context.report.rows.push_back({"tracking", conformity, figures});
    // The figure of eight cannot be driven at the scenario's speed on a small field.
    context.report.figures.limits = limits_;
    if (is_within && !context.is_late)
      context.report.figures.limits.speed_mps =
          std::min(limits_.speed_mps, std::floor(max_speed_mps_ * 10 + 0.5) / 10);
  }

  struct Sample {
    Vec2 error_m, velocity_mps;
  };
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
  int broken_before_ = 0;
  std::optional<double> broken_at_mps_;  ///< the speed at which the robot left the reference
};

}  // namespace

std::unique_ptr<ConformanceStep> make_tracking_step(const Scenario& scenario) {
  return std::make_unique<TrackingStep>(scenario);
}

}  // namespace sidestep
