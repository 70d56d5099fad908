// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/firmware.hpp"

#include <algorithm>
#include <cmath>

#include "common/robot/conversion.hpp"

namespace sidestep {
namespace {

// Gains of the tracking control.
constexpr double kPositionGain_ps2 = 8000, kVelocityGain_ps = 180;
constexpr double kHeadingGain_ps = 8, kTurningSpeed_radps = 4, kTurningGain_ps = 25;

// A robot without a pose is at rest if its wheels have been slower than this for this long. The velocity
// estimate, which starts at zero, converges in less time.
constexpr double kRestSpeed_mps = 0.02;
constexpr Duration kRestTime = std::chrono::milliseconds(100);
// Standard deviation, on each axis, of the first fix of a robot that has just come to rest.
constexpr double kFirstFixDeviation_m = 0.002;

robot::Settings<double> side_settings(const FirmwareSettings& settings) {
  robot::Settings<double> side;
  side.tracking_bound_m = settings.tracking_bound_m;
  side.drift_bound_m = drift_bound_m(settings.tracking_bound_m);
  side.deceleration_mps2 = settings.deceleration_mps2;
  return side;
}

}  // namespace

Firmware::Firmware(RobotId robot, const Vec2& start_m, double heading_rad, Time now,
                   const FirmwareSettings& settings)
    : robot_(robot),
      side_(side_settings(settings), {}),
      settings_(settings),
      decay_(std::exp(-kPhysicsStepSeconds / settings.body.lag_s)),
      // The motors hold a command for a whole period, so it acts half a period late on average.
      look_ahead_(from_seconds(settings.body.lag_s) + kPhysicsStep / 2),
      max_position_error_m_(settings.body.acceleration_mps2 *
                            std::pow(kVelocityGain_ps / kPositionGain_ps2, 2)),
      estimator_(start_m, heading_rad, now, settings.estimator),
      target_heading_rad_(heading_rad) {
  side_.begin_at_rest(start_m.x(), start_m.y());
  executing_ = from_plain(side_.executing(), robot_);
}

// Updates executing_ if number or start differ: a switch changes the number, and lifting changes the start.
void Firmware::update_executing() {
  const robot::Version& executing = side_.executing();
  if (executing.number != executing_.number || executing.start_ns != to_ns(executing_.trajectory.start()))
    executing_ = from_plain(executing, robot_);
}

void Firmware::on_command(const Command& command, Time now) {
  const bool is_obeyed = pass_command(command, now, side_, flash_);
  update_executing();
  if (!is_obeyed) return;
  target_heading_rad_ = wrapped_rad(command.desired_heading_rad);
  if (command.fix && !has_pose())
    find_pose(*command.fix, now);
  else if (command.fix)
    estimator_.correct(command.fix->captured_at, command.fix->position_m, command.fix->heading_rad);
}

void Firmware::on_malformed_command(Time now) {
  side_.on_malformed_command(to_ns(now));
  update_executing();
}

bool Firmware::switch_next(Time now) {
  const bool has_switched = side_.switch_next(to_ns(now));
  if (has_switched) update_executing();
  return has_switched;
}

Actuation Firmware::tick(Time now, const Odometry& odometry) {
  auto& modelled = modelled_.acceleration_mps2;
  auto& modelled_angular = modelled_.angular_acceleration_radps2;
  modelled = last_actuation_.acceleration_mps2 + (modelled - last_actuation_.acceleration_mps2) * decay_;
  modelled_angular = last_actuation_.angular_acceleration_radps2 +
                     (modelled_angular - last_actuation_.angular_acceleration_radps2) * decay_;
  estimator_.advance(now, odometry, modelled, modelled_angular);

  while (side_.switch_next(to_ns(now))) {
  }
  const bool had_pose = has_pose();
  side_.check_reference(to_ns(now), estimate(now), flash_);
  const bool is_number = has_pose() && std::isfinite(estimator_.heading_rad());
  if (had_pose && !is_lifted() && !is_number) forget_pose(now);
  update_executing();
  if (is_lifted()) return last_actuation_ = {};
  return last_actuation_ = has_pose() ? track(now) : brake_by_wheels(now);
}

robot::Estimate<double> Firmware::estimate(Time now) const {
  robot::Estimate<double> estimate;
  estimate.position_m = to_plain(estimator_.position_m());
  estimate.velocity_mps = to_plain(estimator_.velocity_mps());
  estimate.jump_m = estimator_.jump_m();
  if (side_.needs_uncertainty(to_ns(now), estimate.position_m))
    estimate.position_error_rms_m = estimator_.position_error_rms_m();
  return estimate;
}

Actuation Firmware::track(Time now) const {
  const State reference = executing_.trajectory.state_at(now);
  const Vec2& modelled = modelled_.acceleration_mps2;
  // With a motor lag T, p + T v and v + T a respond to the commanded acceleration as a double integrator
  // without lag.
  const double lag = settings_.body.lag_s;
  const std::int64_t ahead_ns = to_ns(now + look_ahead_);
  const auto planned = robot::motion_at<double>(side_.planned(ahead_ns), ahead_ns);
  const Vec2 ahead_velocity_mps(planned.velocity_mps.x, planned.velocity_mps.y);
  const Vec2 ahead_acceleration_mps2(planned.acceleration_mps2.x, planned.acceleration_mps2.y);
  Vec2 position_error = reference.position_m + lag * reference.velocity_mps -
                        (estimator_.position_m() + lag * estimator_.velocity_mps());
  // With these gains both the speed of the approach and its deceleration are proportional to the distance.
  // The distance is clamped so that the motors can provide that deceleration; without the clamp a robot far
  // from its reference would overshoot and oscillate about it.
  if (position_error.squaredNorm() > max_position_error_m_ * max_position_error_m_)
    position_error *= max_position_error_m_ / position_error.norm();
  const Vec2 velocity_error = ahead_velocity_mps - (estimator_.velocity_mps() + lag * modelled);
  Vec2 acceleration =
      ahead_acceleration_mps2 + kPositionGain_ps2 * position_error + kVelocityGain_ps * velocity_error;
  const double max_acceleration = settings_.body.acceleration_mps2;
  if (acceleration.squaredNorm() > max_acceleration * max_acceleration)
    acceleration *= max_acceleration / acceleration.norm();

  return {acceleration, turn()};
}

double Firmware::turn() const {
  double heading_error = target_heading_rad_ - estimator_.heading_rad();
  if (std::abs(heading_error) > 3) heading_error = wrapped_rad(heading_error);
  const double turn_rate =
      std::clamp(kHeadingGain_ps * heading_error, -kTurningSpeed_radps, kTurningSpeed_radps);
  const double max_angular = settings_.body.angular_acceleration_radps2;
  return std::clamp(kTurningGain_ps * (turn_rate - estimator_.angular_radps()), -max_angular, max_angular);
}

void Firmware::lift(Time now) {
  const Vec2 position_m = estimator_.position_m();
  side_.lift(to_ns(now), position_m.x(), position_m.y());
  update_executing();
}

void Firmware::put_down(double heading_rad, Time now) {
  side_.put_down();
  target_heading_rad_ = heading_rad;
  estimator_ = PoseEstimator(executing_.trajectory.rest_position_m(), heading_rad, now, settings_.estimator);
  last_actuation_ = modelled_ = {};
}

void Firmware::switch_on(Time now) {
  estimator_ = PoseEstimator(estimator_.position_m(), estimator_.heading_rad(), now, settings_.estimator);
  last_actuation_ = modelled_ = {};
  side_.switch_on();
  moved_at_ = now;
}

void Firmware::set_clock_back(Time before, Time now) {
  side_.set_clock_back(to_ns(now));
  update_executing();
  estimator_.set_clock(now - before);
  moved_at_ = std::min(moved_at_, now);
}

void Firmware::forget_pose(Time now) {
  estimator_ = PoseEstimator(Vec2(0, 0), 0, now, settings_.estimator);
  last_actuation_ = modelled_ = {};
  side_.lose_pose();
  moved_at_ = now;
}

Actuation Firmware::brake_by_wheels(Time now) {
  const Vec2& velocity = estimator_.velocity_mps();
  if (!velocity.allFinite() || !std::isfinite(estimator_.angular_radps())) {
    forget_pose(now);
    return {};
  }
  if (!(velocity.norm() <= kRestSpeed_mps)) moved_at_ = now;
  const double lag = settings_.body.lag_s;
  Vec2 braking = -kVelocityGain_ps * (velocity + lag * modelled_.acceleration_mps2);
  if (braking.norm() > settings_.deceleration_mps2) braking *= settings_.deceleration_mps2 / braking.norm();
  const double max_angular = settings_.body.angular_acceleration_radps2;
  return {braking, std::clamp(-kTurningGain_ps * estimator_.angular_radps(), -max_angular, max_angular)};
}

void Firmware::find_pose(const PoseFix& fix, Time now) {
  const bool is_usable = fix.position_m.allFinite() && std::isfinite(fix.heading_rad) &&
                         fix.captured_at > moved_at_ + kRestTime && fix.captured_at <= now;
  if (!is_usable) return;
  estimator_ = PoseEstimator(fix.position_m, fix.heading_rad, now, settings_.estimator, kFirstFixDeviation_m);
  side_.find_pose();
}

RobotReport Firmware::robot_report(Time now) {
  RobotReport robot_report = from_plain(side_.robot_report(to_ns(now)), robot_);
  update_executing();
  const Vec2 position =
      estimator_.position_m() + estimator_.velocity_mps() * to_seconds(now - estimator_.time());
  const Vec2 reference = executing_.trajectory.state_at(now).position_m;
  robot_report.estimate = {position, estimator_.velocity_mps()};
  robot_report.heading_rad = wrapped_rad(estimator_.heading_rad());
  robot_report.tracking_error_m = (position - reference).norm();
  robot_report.uncertainty = {estimator_.position_error_rms_m(), estimator_.odometry_scale_stddev()};
  return robot_report;
}

}  // namespace sidestep
