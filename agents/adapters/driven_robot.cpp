// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/driven_robot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "agents/adapters/motion_under_way.hpp"
#include "common/robot/conversion.hpp"

namespace sidestep {
namespace {

// These values suit bases that follow commands as accurately as the league's simulators.
constexpr double kVelocityNoise_mps = 0.05;  ///< standard deviation of a base's velocity from its command
/// Standard deviation of a velocity that the base itself has measured.
constexpr double kOdometryNoise_mps = 0.01;
constexpr double kPositionGain_ps = 4;
/// Maximum speed that is added to the reference's speed to return to it.
constexpr double kMaxCorrection_mps = 0.3;
constexpr double kHeadingGain_ps = 4;
/// Maximum product of speed and turning speed. A base whose velocity follows its commands a few hundredths of
/// a second late drives in the direction of an earlier heading, so a fast turn at full speed would take it
/// tens of millimetres off its reference.
constexpr double kMaxTurnTimesSpeed_mps2 = 1;
/// A base follows its turning speed at once if that changes no faster.
constexpr double kTurnAcceleration_radps2 = 20;

using std::chrono::milliseconds;

// A base stops within this time after its last command, whichever process sent it.
constexpr Duration kStoppingTime = milliseconds(500);
// The first fixes of a robot at rest agree if all lie within kAgreement standard deviations plus
// kMinAgreement_m of a single fix.
constexpr double kAgreement = 5, kMinAgreement_m = 0.003;
// If this process pauses for longer, the base's motion during the pause is unknown.
constexpr Duration kMaxPause = milliseconds(200);
// Odometry that is older than this is no longer used.
constexpr Duration kOdometryTimeout = milliseconds(150);
// A base at rest within this distance of its reference is not corrected.
constexpr double kRestTolerance_m = 0.001;

robot::Settings<float> side_settings(const DriveSettings& settings) {
  robot::Settings<float> side;
  side.tracking_bound_m = static_cast<float>(settings.tracking_bound_m);
  side.drift_bound_m = static_cast<float>(drift_bound_m(settings.tracking_bound_m));
  side.deceleration_mps2 = static_cast<float>(settings.limits.deceleration_mps2);
  side.actuation_lead_ns = settings.latency.count();
  return side;
}

EstimatorSettings estimator_settings(const DriveSettings& settings) {
  EstimatorSettings estimator;
  estimator.period = DrivenRobot::kPeriod;
  estimator.velocity_noise_mps = kOdometryNoise_mps;
  estimator.commanded_noise_mps = kVelocityNoise_mps;
  estimator.scale_error = settings.scale_error;
  estimator.fix_noise_m = settings.fix_noise_m;
  estimator.velocity_gain = 1;
  return estimator;
}

/// Maximum error of an odometry timestamp: at the speed limit it displaces the estimate by the drift bound.
Duration max_timestamp_error(const DriveSettings& settings) {
  return from_seconds(drift_bound_m(settings.tracking_bound_m) / settings.limits.speed_mps);
}

/// Maximum distance between fixes of a base at rest.
double fix_tolerance_m(const DriveSettings& settings) {
  return kAgreement * settings.fix_noise_m + kMinAgreement_m;
}

template <typename Vector>
Vector limited(const Vector& vector, double max_norm) {
  const double norm = vector.norm();
  return norm <= max_norm ? vector : Vector(vector * (max_norm / norm));
}

bool is_finite(const BodyVelocity& velocity) {
  return velocity.linear_mps.allFinite() && std::isfinite(velocity.turn_radps);
}

robot::Vec<float> to_single(const Vec2& v) { return {static_cast<float>(v.x()), static_cast<float>(v.y())}; }
Vec2 to_double(const robot::Vec<float>& v) { return {v.x, v.y}; }

}  // namespace

DriveSettings drive_settings(const Scenario& scenario, Duration latency) {
  DriveSettings settings;
  settings.latency = latency;
  settings.tracking_bound_m = scenario.tracking_bound_m;
  settings.limits = scenario.limits;
  settings.fix_noise_m = scenario.vision.position_noise_m;
  settings.scale_error = scenario.odometry.scale_error;
  return settings;
}

DrivenRobot::DrivenRobot(RobotId robot, const DriveSettings& settings, const robot::DurableState& remembered,
                         Time now)
    : robot_(robot),
      settings_(settings),
      side_(side_settings(settings), remembered),
      commands_(settings.latency),
      timestamp_check_(max_timestamp_error(settings)),
      estimator_({0, 0}, 0, now, estimator_settings(settings)),
      base_rest_(fix_tolerance_m(settings)),
      moved_at_(now + kStoppingTime) {}

void DrivenRobot::on_command(const Command& command, Time now, robot::StableMemory& memory) {
  if (!pass_command(command, now, side_, memory)) return;
  target_heading_rad_ = wrapped_rad(command.desired_heading_rad);
  if (!command.fix) return;
  if (command.fix->captured_at <= now) base_rest_.on_fix(*command.fix);
  if (!side_.has_pose())
    add_first_fix(*command.fix, now);
  else if (command.fix->captured_at <= now)
    use_fix(*command.fix);
}

void DrivenRobot::use_fix(const PoseFix& fix) {
  if (fix.captured_at <= estimator_.time())
    estimator_.correct(fix.captured_at, fix.position_m, fix.heading_rad);
  else if (!waiting_fix_)
    waiting_fix_ = fix;
}

void DrivenRobot::on_odometry(const OdometryReport& report, Time now) {
  if (timestamp_check_.admit(report.measured_at, now))
    measured_.add(report);
  else
    ++misdated_;
}

void DrivenRobot::on_malformed_command(Time now) { side_.on_malformed_command(to_ns(now)); }

// Several fixes must agree: a single fix may be wrong, and a base that is being pushed changes its position.
void DrivenRobot::add_first_fix(const PoseFix& fix, Time now) {
  const bool is_usable =
      fix.captured_at > moved_at_ && fix.captured_at <= now &&
      (first_fix_count_ == 0 || fix.captured_at > first_fixes_[first_fix_count_ - 1].captured_at);
  if (!is_usable) return;
  const double tolerance_m = fix_tolerance_m(settings_);
  const auto agrees = [&](const PoseFix& other) {
    return (other.position_m - fix.position_m).norm() <= tolerance_m;
  };
  const auto end = first_fixes_.begin() + static_cast<std::ptrdiff_t>(first_fix_count_);
  if (!std::all_of(first_fixes_.begin(), end, agrees)) first_fix_count_ = 0;
  first_fixes_[first_fix_count_++] = fix;
  if (first_fix_count_ < first_fixes_.size()) return;
  first_fix_count_ = 0;
  estimator_ = PoseEstimator(fix.position_m, fix.heading_rad, estimator_.time(),
                             estimator_settings(settings_), settings_.fix_noise_m);
  target_heading_rad_ = fix.heading_rad;
  side_.find_pose();
}

Odometry DrivenRobot::commanded(Time from, Time to, double heading_rad) const {
  const BodyVelocity body = commands_.mean(from, to);
  const double middle_rad = heading_rad + 0.5 * body.turn_radps * to_seconds(to - from);
  return {rotated(body.linear_mps, middle_rad), body.turn_radps};
}

void DrivenRobot::forget_pose(Time now) {
  if (!side_.is_lifted()) side_.lose_pose();
  first_fix_count_ = 0;
  moved_at_ = now + kStoppingTime;
  estimator_ = PoseEstimator({0, 0}, 0, now, estimator_settings(settings_));
  measured_ = {};
  waiting_fix_.reset();
}

void DrivenRobot::advance(Time now) {
  if (now - estimator_.time() > kMaxPause) return forget_pose(now);
  // The base's own measurement is more accurate than the commands, but arrives later.
  const bool is_measured = now - measured_.until() <= kOdometryTimeout;
  const Time until = is_measured ? std::min(now, measured_.until()) : now;
  while (estimator_.time() + kPeriod <= until) {
    const Time from = estimator_.time();
    Odometry motion = commanded(from, from + kPeriod, estimator_.heading_rad());
    const auto body = measured_.mean(from, from + kPeriod);
    if (body) {
      const double middle_rad = estimator_.heading_rad() + 0.5 * body->turn_radps * to_seconds(kPeriod);
      motion = {rotated(body->linear_mps, middle_rad), body->turn_radps};
    }
    estimator_.advance(from + kPeriod, motion, {0, 0}, 0, body.has_value());
    if (waiting_fix_ && waiting_fix_->captured_at <= estimator_.time())
      use_fix(*std::exchange(waiting_fix_, std::nullopt));
  }
}

DrivenRobot::Pose DrivenRobot::predicted(Time at) const {
  Pose pose{estimator_.position_m(), estimator_.heading_rad()};
  for (Time from = estimator_.time(); from < at; from += kPeriod) {
    const Time to = std::min(from + kPeriod, at);
    const Odometry motion = commanded(from, to, pose.heading_rad);
    pose.position_m += (1 - estimator_.scale_error()) * to_seconds(to - from) * motion.velocity_mps;
    pose.heading_rad += to_seconds(to - from) * motion.angular_radps;
  }
  return pose;
}

robot::Estimate<float> DrivenRobot::estimate(Time now) const {
  robot::Estimate<float> estimate;
  const double obeyed = 1 - estimator_.scale_error();
  const Pose pose = predicted(now);
  estimate.position_m = to_single(pose.position_m);
  estimate.velocity_mps = to_single(obeyed * commanded(now - kPeriod, now, pose.heading_rad).velocity_mps);
  estimate.jump_m = static_cast<float>(estimator_.jump_m());
  if (side_.needs_uncertainty(to_ns(now), estimate.position_m))
    estimate.position_error_rms_m = static_cast<float>(estimator_.position_error_rms_m());
  if (side_.is_stop_due(to_ns(now), estimate)) estimate.under_way = under_way(now, pose);
  return estimate;
}

robot::MotionUnderWay<float> DrivenRobot::under_way(Time now, const Pose& pose) const {
  std::array<PathPoint, CommandedMotion::kRemembered + 2> path;
  std::size_t count = 0;
  path[count++] = {Duration{0}, pose.position_m};
  const double obeyed = 1 - estimator_.scale_error();
  double heading_rad = pose.heading_rad;
  const Time end = now + settings_.latency;
  for (Time from = now; from < end;) {
    const Time to = commands_.next_change(from, end);
    const Odometry motion = commanded(from, to, heading_rad);
    const double seconds = to_seconds(to - from);
    path[count] = {to - now, path[count - 1].position_m + obeyed * seconds * motion.velocity_mps};
    ++count;
    heading_rad += seconds * motion.angular_radps;
    from = to;
  }
  const Vec2 last_mps = obeyed * rotated(commands_.latest().linear_mps, heading_rad);
  return fit_motion_under_way({path.data(), count}, last_mps);
}

BodyVelocity DrivenRobot::track(Time now) const {
  // The command acts from `begin` on, for one period.
  const Time begin = now + settings_.latency, middle = begin + kPeriod / 2;
  const Pose pose = predicted(begin);
  const auto at_begin = robot::motion_at<float>(side_.planned(to_ns(begin)), to_ns(begin));
  const auto at_middle = robot::motion_at<float>(side_.planned(to_ns(middle)), to_ns(middle));
  Vec2 error_m = to_double(at_begin.position_m) - pose.position_m;
  const Vec2 planned_mps = to_double(at_middle.velocity_mps);
  if (planned_mps.isZero(0) && error_m.norm() < kRestTolerance_m) error_m.setZero();
  const Vec2 velocity_mps = planned_mps + limited(Vec2(kPositionGain_ps * error_m), kMaxCorrection_mps);
  BodyVelocity command;
  const double heading_error = wrapped_rad(target_heading_rad_ - pose.heading_rad);
  const double max_radps =
      std::min(settings_.turn_radps, kMaxTurnTimesSpeed_mps2 / std::max(planned_mps.norm(), 1e-3));
  const double turn_radps = std::clamp(kHeadingGain_ps * heading_error, -max_radps, max_radps);
  const double last_radps = commands_.latest().turn_radps;
  const double change_radps = kTurnAcceleration_radps2 * to_seconds(kPeriod);
  command.turn_radps = std::clamp(turn_radps, last_radps - change_radps, last_radps + change_radps);
  const double middle_rad = pose.heading_rad + 0.5 * command.turn_radps * to_seconds(kPeriod);
  command.linear_mps = rotated(Vec2(velocity_mps / (1 - estimator_.scale_error())), -middle_rad);
  return command;
}

BodyVelocity DrivenRobot::tick(Time now, robot::StableMemory& memory) {
  while (side_.switch_next(to_ns(now))) {
  }
  advance(now);
  const bool had_pose = side_.has_pose();
  side_.check_reference(to_ns(now), estimate(now), memory);
  if (had_pose && !side_.has_pose()) forget_pose(now);
  BodyVelocity command;
  if (side_.has_pose() && !side_.is_lifted() && !stands_still_) command = track(now);
  if (!is_finite(command)) {
    forget_pose(now);
    command = {};
  }
  commands_.add(now, command);
  return command;
}

bool DrivenRobot::is_at_rest(Time now) const {
  if (!side_.has_pose() || side_.is_lifted()) return true;
  return !side_.has_pending() && to_ns(now - settings_.latency) >= side_.executing().end_ns();
}

RobotReport DrivenRobot::robot_report(Time now) {
  RobotReport robot_report = from_plain(side_.robot_report(to_ns(now)), robot_);
  const Pose pose = predicted(now);
  const Vec2 reference_m = robot_report.executing.trajectory.state_at(now).position_m;
  robot_report.estimate = {pose.position_m, commanded(now - kPeriod, now, pose.heading_rad).velocity_mps};
  robot_report.heading_rad = wrapped_rad(pose.heading_rad);
  robot_report.tracking_error_m = (pose.position_m - reference_m).norm();
  robot_report.uncertainty = {estimator_.position_error_rms_m(), estimator_.odometry_scale_stddev()};
  return robot_report;
}

}  // namespace sidestep
