// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace sidestep {

/// Process noise of a constant-velocity model. SI units; for angles read rad in place of m.
struct MotionNoise {
  double acceleration_psd_m2ps3 = 0;  ///< power spectral density of white acceleration
  double manoeuvre_mps2 = 0;  ///< standard deviation of an acceleration held constant over the prediction;
                              ///< dominates over long gaps
};

/// Constant-velocity Kalman filter with white-noise acceleration (Bar-Shalom, Li, Kirubarajan 2001,
/// section 6.2), the same noise on each axis, so that all axes share one covariance of (position, velocity).
template <int Dim>
class ConstantVelocityFilter {
 public:
  using Vector = Eigen::Matrix<double, Dim, 1>;

  ConstantVelocityFilter() = default;
  /// Starts at a position with zero velocity of the given variance.
  ConstantVelocityFilter(const Vector& position, double position_variance, double velocity_variance);

  /// Predicts by `dt_s`, backwards when negative. `deceleration_mps2` is rolling friction: it acts against
  /// the velocity until rest.
  void predict(double dt_s, const MotionNoise& noise, double deceleration_mps2 = 0);
  /// Updates with a measured position, given as its difference from position(), and its variance per axis.
  void correct(const Vector& innovation, double variance);
  /// Squared Mahalanobis distance of a measured position; chi-squared with Dim degrees of freedom.
  double squared_distance(const Vector& innovation, double variance) const {
    return innovation.squaredNorm() / (covariance_(0, 0) + variance);
  }

  const Vector& position() const { return position_; }
  const Vector& velocity() const { return velocity_; }
  /// Covariance of (position, velocity), per axis.
  const Eigen::Matrix2d& covariance() const { return covariance_; }

 private:
  Vector position_ = Vector::Zero();
  Vector velocity_ = Vector::Zero();
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Zero();
};

extern template class ConstantVelocityFilter<1>;
extern template class ConstantVelocityFilter<2>;

}  // namespace sidestep
