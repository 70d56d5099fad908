// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace sidestep {

/// Process noise of a constant-velocity model, in SI units. For angles, read rad instead of m.
struct MotionNoise {
  double acceleration_psd_m2ps3 = 0;  ///< power spectral density of white acceleration
  double manoeuvre_mps2 = 0;  ///< standard deviation of an acceleration held constant over the prediction;
                              ///< dominates over long gaps
};

/// Constant-velocity Kalman filter with white-noise acceleration (Bar-Shalom, Li, Kirubarajan 2001, section
/// 6.2). The noise is the same on each axis, so all axes share one covariance of (position, velocity).
template <int Dim>
class ConstantVelocityFilter {
 public:
  using Vector = Eigen::Matrix<double, Dim, 1>;

  ConstantVelocityFilter() = default;
  /// Starts at a position with zero velocity. The variances are those of the initial state.
  ConstantVelocityFilter(const Vector& position, double position_variance, double velocity_variance);

  /// Predicts by `dt_s`; negative values predict backwards. `deceleration_mps2` is rolling friction: it acts
  /// against the velocity until rest.
  void predict(double dt_s, const MotionNoise& noise, double deceleration_mps2 = 0);
  /// Corrects the state with a measured position, given as its difference from position() and its variance
  /// per axis.
  void correct(const Vector& innovation, double variance);
  /// Squared Mahalanobis distance of a measured position. It is chi-squared distributed with Dim degrees of
  /// freedom.
  double squared_distance(const Vector& innovation, double variance) const {
    return innovation.squaredNorm() / (covariance_(0, 0) + variance);
  }

  const Vector& position() const { return position_; }
  const Vector& velocity() const { return velocity_; }
  /// Covariance of (position, velocity) on each axis.
  const Eigen::Matrix2d& covariance() const { return covariance_; }

 private:
  Vector position_ = Vector::Zero();
  Vector velocity_ = Vector::Zero();
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Zero();
};

extern template class ConstantVelocityFilter<1>;
extern template class ConstantVelocityFilter<2>;

}  // namespace sidestep
