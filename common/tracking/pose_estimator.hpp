// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// The wheel encoders' measurement over the last period, in the world frame.
struct Odometry {
  Vec2 velocity_mps{0, 0};
  double angular_radps = 0;
};

/// The robot's sensor model. Noises and errors are standard deviations.
struct EstimatorSettings {
  double velocity_noise_mps = 0.01;   ///< noise of one odometry measurement, on each axis
  double scale_error = 0.005;         ///< constant relative error of the odometry
  double fix_noise_m = 0.0005;        ///< noise of a fix from vision, on each axis
  double velocity_gain = 0.08;        ///< weight of measurements against the motor model; 1: no model
  Duration period{1'000'000};         ///< period of the odometry
  double commanded_noise_mps = 0.01;  ///< error of an unmeasured, commanded velocity, on each axis
};

/// A robot's estimate of its own pose: dead reckoning from the last fix. A Kalman filter over position and
/// odometry scale is updated at the fixes' capture times.
class PoseEstimator {
 public:
  /// Standard deviation, on each axis, of the place at which a robot starts or is put down.
  static constexpr double kKnownPlaceDeviation_m = 0.0005;

  /// Starts at a pose whose position has this standard deviation on each axis.
  PoseEstimator(const Vec2& position_m, double heading_rad, Time now, const EstimatorSettings& settings,
                double deviation_m = kKnownPlaceDeviation_m);

  /// Integrates the measured velocity, or the commanded velocity if not `is_measured`, over the period that
  /// ends now. The accelerations are those of the motor model. A gap in time clears the history, so that
  /// fixes from before the gap are refused.
  void advance(Time now, const Odometry& odometry, const Vec2& acceleration_mps2,
               double angular_acceleration_radps2, bool is_measured = true);

  /// Corrects the estimate with a fix from vision. Returns false and changes nothing if the fix is not
  /// finite, from the future, older than kHistoryPeriods, or not newer than the last one.
  ///
  /// Fixes that agree with each other but not with the odometry show that the robot was displaced without its
  /// wheels measuring it; the estimate then follows the fixes. If the motion was only commanded, the robot
  /// may follow its commands less or more than before, and the scale is learned anew.
  bool correct(Time captured_at, const Vec2& position_m, double heading_rad);

  /// The robot's clock was set by `change`. Shifts all recorded times, so that their age stays the same.
  void set_clock(Duration change) {
    time_ += change;
    anchor_time_ += change;
  }

  Time time() const { return time_; }
  Vec2 position_m() const { return anchor_m_ + (odometry_m_ - anchor_odometry_m_) * (1 - scale_); }
  const Vec2& velocity_mps() const { return velocity_mps_; }
  /// The heading without wrapping: it counts full turns.
  double heading_rad() const { return heading_anchor_rad_ + turned_rad_; }
  double angular_radps() const { return angular_radps_; }
  /// Estimated relative error of the odometry: its measurements are approximately (1 + scale_error) x truth.
  double scale_error() const { return scale_; }
  /// The filter's estimate of the root mean square position error.
  double position_error_rms_m() const;
  /// The filter's estimate of the standard deviation of scale_error().
  double odometry_scale_stddev() const { return std::sqrt(std::max(covariance_(2, 2), 0.0)); }
  /// Whether the pose is usable. A value that is not finite never becomes finite again.
  bool is_finite() const {
    return position_m().allFinite() && std::isfinite(heading_rad()) && covariance_.allFinite();
  }
  /// The displacement that the last fix showed but the wheels did not measure; 0 if none.
  double jump_m() const { return jump_m_; }

  static constexpr std::int64_t kHistoryPeriods = 512;

 private:
  struct Sample {
    Vec2 odometry_m{0, 0};  ///< integrated since creation
    double turned_rad = 0;  ///< integrated since creation
  };
  /// The difference between a fix and its prediction.
  struct Innovation {
    Vec2 offset_m{0, 0};
    double variance_m2 = 0;  ///< expected variance on each axis
  };
  /// If part of the motion since the anchor was only commanded, all of it counts as commanded.
  bool has_unmeasured_motion() const { return commanded_at_ > anchor_time_; }
  bool detect_displacement(const Innovation& latest);
  void decorrelate_scale();
  Eigen::Matrix3d covariance_after(double elapsed_s, const Vec2& moved_m) const;

  std::vector<Sample> history_;  ///< ring buffer with one sample per period
  std::int64_t count_ = 0;       ///< number of samples since creation or the last gap

  Time time_;
  Vec2 odometry_m_{0, 0};
  double turned_rad_ = 0;
  Vec2 velocity_mps_{0, 0};
  double angular_radps_ = 0;

  Time anchor_time_;  ///< capture time of the last fix
  Vec2 anchor_m_;
  Vec2 anchor_odometry_m_{0, 0};
  double scale_ = 0;
  Eigen::Matrix3d covariance_;  ///< covariance of the position at the anchor, and of the scale
  double heading_anchor_rad_;   ///< heading at which turned_rad_ was 0
  double jump_m_ = 0;
  Time commanded_at_ = Time::min();               ///< last time at which only a commanded velocity was known
  std::array<Innovation, 3> recent_innovations_;  ///< latest first, before clamping
  EstimatorSettings settings_;
};

}  // namespace sidestep
