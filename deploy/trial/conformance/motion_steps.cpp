// SPDX-License-Identifier: Apache-2.0
// How well the robot follows its reference: at rest, on a figure of eight, without commands, and braking.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <vector>

#include "common/motion/safety_budget.hpp"
#include "deploy/trial/conformance/conformance_step.hpp"
#include "deploy/trial/conformance/stop_observation.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr Duration kRestTime = 1500ms, kSettlingTime = 700ms, kDriveTimeout = 20s;
// Distance from the field's edge, in addition to the robot's radius.
constexpr double kEdge_m = 0.35;
// The part of the acceleration limit that the curves of the figure of eight use.
constexpr double kUsedAcceleration = 0.5;
constexpr double kSpeedRamp_mps2 = 1, kMaxAmplitude_m = 3;
constexpr int kSpeedLevels = 4;
constexpr Duration kLevelTime = 5s;
// Errors up to this many standard deviations may be due to vision's noise.
constexpr double kNoiseDeviations = 4;
// Ratio of the tracking bound to the largest measured error.
constexpr double kTrackingBoundRatio = 1.25;
// Number of starts from which the latency is measured, and how often vision must see them: slow cameras need
// more starts.
constexpr int kStarts = 8, kMaxStarts = 24;
constexpr std::size_t kMinStartSamples = 10;
// The part of each start that is evaluated: later, the robot's control corrects for the latency.
constexpr Duration kStartBegin = 20ms, kStartEnd = 200ms;
constexpr Duration kMaxLate = 150ms;

Conformity passed_if(bool is_passed) { return is_passed ? Conformity::kPassed : Conformity::kFailed; }

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

/// Keeps the largest error of all steps, for the scenario's tracking bound.
void keep_error(ConformanceContext& context, const MotionSample& sample) {
  if (sample.is_off_reference) return;
  const double error_m = (sample.seen_m - sample.reference.state.position_m).norm();
  auto& bound_m = context.report.figures.tracking_bound_m;
  bound_m = std::max(bound_m.value_or(0), std::ceil(kTrackingBoundRatio * error_m * 1e3) * 1e-3);
}

/// The tracking bound within which the robot can stop from full speed without further observations
/// (coordinator/PROTOCOL.md, "Dead reckoning"): three standard deviations of its estimate, and four of the
/// error that grows with the distance driven, are within the drift bound.
double bound_for_dead_reckoning_m(const LocalisationUncertainty& uncertainty, const Scenario& scenario,
                                  Duration lead) {
  const double speed_mps = scenario.limits.speed_mps;
  const double way_m = speed_mps * to_seconds(lead + 2 * scenario.cycle) +
                       speed_mps * speed_mps / (2 * scenario.limits.deceleration_mps2);
  const double error_m =
      std::hypot(3 * uncertainty.position_error_rms_m, 4 * uncertainty.odometry_scale_stddev * way_m);
  return error_m / drift_bound_m(1);
}

/// A policy that drives to a point and stops there.
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

class RestStep final : public ConformanceStep {
 public:
  std::string name() const override { return "rest"; }

  bool update(ConformanceContext& context) override {
    const Time now = context.probe.now();
    if (!since_) {
      since_ = now;
      context.probe.on_sample([this](const MotionSample& sample) { seen_m_.push_back(sample.seen_m); });
    }
    if (now - *since_ < kRestTime) return false;
    context.probe.on_sample(nullptr);
    if (seen_m_.size() < 5) {
      context.report.rows.push_back(
          {"vision", Conformity::kNotJudged, fmt::format("{} observations at rest", seen_m_.size())});
      return true;
    }
    Vec2 mean(0, 0), square(0, 0);
    for (const Vec2& p : seen_m_) mean += p / static_cast<double>(seen_m_.size());
    for (const Vec2& p : seen_m_) square += (p - mean).cwiseAbs2() / static_cast<double>(seen_m_.size());
    context.vision_noise_m = std::sqrt(square.maxCoeff());
    const double rate_hz = static_cast<double>(seen_m_.size()) / to_seconds(now - *since_);
    context.report.rows.push_back({"vision", Conformity::kPassed,
                                   fmt::format("{:.0f} observations a second, {:.2f} mm of noise", rate_hz,
                                               context.vision_noise_m * 1e3)});
    return true;
  }

 private:
  std::optional<Time> since_;
  std::vector<Vec2> seen_m_;
};

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
    if (!start_ && !context.stream.is_at_rest() && now - *since_ < 2 * kDriveTimeout) return false;
    if (starts_ < kStarts || (samples_.size() < kMinStartSamples && starts_ < kMaxStarts)) {
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
    samples_.push_back({start_->trajectory, robot_at, sample.seen_m - rest_error_sum_m_ / before_count_});
  }

  /// The delay with which the reference fits the observations best.
  Duration measured_late() const {
    Duration best{0};
    double least = INFINITY;
    for (Duration late = -kMaxLate; late <= kMaxLate; late += 500us) {
      double sum = 0;
      for (const Start& start : samples_)
        sum += (start.seen_m - start.trajectory.state_at(start.at - late).position_m).squaredNorm();
      if (sum < least) least = sum, best = late;
    }
    return best;
  }

  void add_row(ConformanceContext& context) {
    if (samples_.size() < kMinStartSamples) {
      context.report.rows.push_back(
          {"latency", Conformity::kNotJudged,
           fmt::format("vision saw {} starts of the robot {} times, fewer than {} times", starts_,
                       samples_.size(), kMinStartSamples)});
      return;
    }
    const Duration late = measured_late();
    context.is_late =
        std::abs(to_seconds(late)) * context.scenario.limits.speed_mps > context.scenario.tracking_bound_m;
    context.report.rows.push_back(latency_row(context.probe.robot_report()->lead, late, !context.is_late));
  }

  std::optional<Time> since_;
  bool has_begun_ = false;
  int starts_ = 0;
  std::optional<Version> start_;
  Vec2 rest_error_sum_m_{0, 0};  ///< the sum of the errors at rest, before the latest start
  int before_count_ = 0;
  struct Start {
    Trajectory trajectory;
    Time at;  ///< measured with the robot's clock
    Vec2 seen_m;
  };
  std::vector<Start> samples_;
};

/// The lemniscate of Gerono: x = a sin(t), y = a/2 sin(2 t).
class FigureOfEight {
 public:
  explicit FigureOfEight(double amplitude_m) : amplitude_m_(amplitude_m) {}
  Vec2 at(double t) const { return amplitude_m_ * Vec2(std::sin(t), 0.5 * std::sin(2 * t)); }
  Vec2 derivative(double t) const { return amplitude_m_ * Vec2(std::cos(t), std::cos(2 * t)); }
  double curvature_pm(double t) const {
    const Vec2 first = derivative(t), second = -amplitude_m_ * Vec2(std::sin(t), 2 * std::sin(2 * t));
    return std::abs(cross(first, second)) / std::pow(first.norm(), 3);
  }

 private:
  double amplitude_m_;
};

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

/// Reports a false position to the robot, as if it had been moved.
class OwnStopStep final : public ConformanceStep {
 public:
  std::string name() const override { return "own stop"; }

  bool update(ConformanceContext& context) override {
    RobotProbe& probe = context.probe;
    const RobotReport& robot_report = *probe.robot_report();
    const Time now = probe.now();
    if (!since_) {
      since_ = now;
      before_ = robot_report.executing.number;
      context.stream.stop();
      probe.fix_error_m = Vec2(0.3, 0);
    }
    if (!own_ && robot_report.is_off_reference && robot_report.executing.number != before_) {
      own_ = robot_report;
      took_ = now - *since_;
    }
    if (!own_ && now - *since_ < 2s) return false;
    // Reports the true position again, which is another displacement.
    probe.fix_error_m = Vec2(0, 0);
    if (now - *since_ < took_ + 2s) return false;
    context.stream.forget();
    constexpr VersionNumber kGap = VersionNumber{1} << 20;
    const VersionNumber highest = std::max(before_, probe.incarnation);
    const bool is_numbered = own_ && own_->executing.number >= highest + kGap;
    const bool is_resting = own_ && own_->executing.trajectory.residual_speed_mps() < 1e-5;
    context.report.rows.push_back(
        {"own stop", passed_if(is_numbered && is_resting),
         own_ ? fmt::format("{:.0f} ms after pose fixes showed it elsewhere; numbered {} above all others; "
                            "inflation {:.0f} mm",
                            to_seconds(took_) * 1e3, own_->executing.number - highest,
                            own_->executing.inflation_m * 1e3)
              : "no own stop, although pose fixes showed the robot 0.3 m off its reference"});
    return true;
  }

 private:
  std::optional<Time> since_;
  VersionNumber before_ = 0;
  std::optional<RobotReport> own_;
  Duration took_{0};
};

}  // namespace

std::unique_ptr<ConformanceStep> make_rest_step() { return std::make_unique<RestStep>(); }
std::unique_ptr<ConformanceStep> make_latency_step() { return std::make_unique<LatencyStep>(); }
std::unique_ptr<ConformanceStep> make_tracking_step(const Scenario& scenario) {
  return std::make_unique<TrackingStep>(scenario);
}
std::unique_ptr<ConformanceStep> make_lost_commands_step() {
  return std::make_unique<NoMoreCommandsStep>("lost commands", 0.3, true);
}
std::unique_ptr<ConformanceStep> make_braking_step(const Scenario& scenario) {
  return std::make_unique<NoMoreCommandsStep>("braking", scenario.limits.speed_mps, false);
}
std::unique_ptr<ConformanceStep> make_own_stop_step() { return std::make_unique<OwnStopStep>(); }

std::vector<std::unique_ptr<ConformanceStep>> conformance_steps(const Scenario& scenario) {
  std::vector<std::unique_ptr<ConformanceStep>> steps;
  steps.push_back(make_reports_step());
  steps.push_back(make_clock_step());
  steps.push_back(make_new_agent_step());
  steps.push_back(make_fence_step());
  steps.push_back(make_switch_step());
  steps.push_back(make_versions_step());
  steps.push_back(make_rest_step());
  steps.push_back(make_latency_step());
  steps.push_back(make_tracking_step(scenario));
  steps.push_back(make_lost_commands_step());
  steps.push_back(make_braking_step(scenario));
  steps.push_back(make_takeover_step());
  steps.push_back(make_own_stop_step());
  return steps;
}

}  // namespace sidestep
