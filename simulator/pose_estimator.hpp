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
#include "simulator/body.hpp"

namespace sidestep {

/// What the wheels' encoders measured over the last control period, in the world's frame.
struct Odometry {
  Vec2 velocity_mps{0, 0};
  double angular_radps = 0;
};

/// What a robot knows about its sensors; standard deviations.
struct EstimatorSettings {
  double velocity_noise_mps = 0.01;  ///< of one odometry measurement, per axis
  double scale_error = 0.005;        ///< of the odometry's constant relative error
  double fix_noise_m = 0.0005;       ///< of a fix, per axis
};

/// A robot's estimate of where it is: odometry dead reckoning from the last fix, and a Kalman filter at the
/// fixes' capture times over position and the odometry's scale error. Starts from the true pose: robots are
/// placed on their marks.
class PoseEstimator {
 public:
  PoseEstimator(const Vec2& position_m, double heading_rad, Time now, const EstimatorSettings& settings);

  /// Takes the measurement over the control period that ends now; the acceleration is the one the robot
  /// believes it had. A gap in time forgets the past, so that older fixes are refused.
  void advance(Time now, const Odometry& odometry, const Vec2& acceleration_mps2,
               double angular_acceleration_radps2);

  /// Corrects by a sight of the robot. False, and nothing changed: not a number, from the future, too old
  /// (beyond kMemory), or not newer than the last one.
  ///
  /// Fixes that agree with each other but not with the odometry mean that something moved the robot past its
  /// wheels: then the estimate goes where they say.
  bool correct(Time captured_at, const Vec2& position_m, double heading_rad);

  Time time() const { return time_; }
  Vec2 position_m() const { return anchor_m_ + (path_m_ - anchor_path_m_) * (1 - scale_); }
  const Vec2& velocity_mps() const { return velocity_mps_; }
  /// Counts whole turns.
  double heading_rad() const { return heading_anchor_rad_ + turned_rad_; }
  double angular_radps() const { return angular_radps_; }
  /// Estimated relative error of the odometry: what it measures is (1 + scale_error) times the truth, nearly.
  double scale_error() const { return scale_; }
  /// Root mean square distance from the truth, as far as the filter can tell.
  double deviation_m() const;
  /// Standard deviation of scale_error(), as far as the filter can tell.
  double scale_deviation() const { return std::sqrt(std::max(0.0, covariance_(2, 2))); }
  /// How far the last fix showed the robot to have been moved past its wheels, 0: it did not.
  double jump_m() const { return jump_m_; }

  static constexpr std::int64_t kMemory = 512;  ///< control periods

 private:
  struct Sample {
    Vec2 path_m{0, 0};  ///< odometry summed since the creation
    double turned_rad = 0;
  };
  /// What a fix said against the prediction.
  struct Innovation {
    Vec2 offset_m{0, 0};
    double variance_m2 = 0;  ///< per axis, as expected
  };
  bool was_moved_past_wheels(const Innovation& latest);
  Eigen::Matrix3d covariance_after(double elapsed_s, const Vec2& moved_m) const;

  std::vector<Sample> past_;  ///< ring, one a control period
  std::int64_t count_ = 0;    ///< samples since the creation or the last gap

  Time time_;
  Vec2 path_m_{0, 0};
  double turned_rad_ = 0;
  Vec2 velocity_mps_{0, 0};
  double angular_radps_ = 0;

  Time anchor_time_;  ///< capture of the last fix
  Vec2 anchor_m_;
  Vec2 anchor_path_m_{0, 0};
  double scale_ = 0;
  Eigen::Matrix3d covariance_;  ///< of position at the anchor and scale
  double heading_anchor_rad_;   ///< heading when turned_rad_ was 0
  double jump_m_ = 0;
  std::array<Innovation, 3> surprises_;  ///< latest first, before any of them was cut off
  EstimatorSettings settings_;
};

}  // namespace sidestep
