// SPDX-License-Identifier: Apache-2.0
#include "common/tracking/kalman.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

Eigen::Matrix2d process_noise(double dt_s, const MotionNoise& noise) {
  const double dt2 = dt_s * dt_s;
  const double q = noise.acceleration_psd_m2ps3, a2 = noise.manoeuvre_mps2 * noise.manoeuvre_mps2;
  const double position = q * std::abs(dt_s) * dt2 / 3 + a2 * dt2 * dt2 / 4;
  const double cross = q * dt_s * std::abs(dt_s) / 2 + a2 * dt2 * dt_s / 2;
  const double velocity = q * std::abs(dt_s) + a2 * dt2;
  return (Eigen::Matrix2d() << position, cross, cross, velocity).finished();
}

}  // namespace

template <int Dim>
ConstantVelocityFilter<Dim>::ConstantVelocityFilter(const Vector& position, double position_variance,
                                                    double velocity_variance)
    : position_(position) {
  covariance_.diagonal() << position_variance, velocity_variance;
}

template <int Dim>
void ConstantVelocityFilter<Dim>::predict(double dt_s, const MotionNoise& noise, double deceleration_mps2) {
  const double speed = velocity_.norm();
  if (deceleration_mps2 > 0 && speed > 0 && dt_s > 0) {
    const double rolling_s = std::min(dt_s, speed / deceleration_mps2);
    const Vector velocity_loss = velocity_ / speed * deceleration_mps2 * rolling_s;
    position_ += (velocity_ - velocity_loss / 2) * rolling_s;
    velocity_ -= velocity_loss;
  } else {
    position_ += velocity_ * dt_s;
  }
  const Eigen::Matrix2d transition = (Eigen::Matrix2d() << 1, dt_s, 0, 1).finished();
  covariance_ = (transition * covariance_ * transition.transpose()).eval() + process_noise(dt_s, noise);
}

template <int Dim>
void ConstantVelocityFilter<Dim>::correct(const Vector& innovation, double variance) {
  const double innovation_variance = covariance_(0, 0) + variance;
  const Eigen::Vector2d gain = covariance_.col(0) / innovation_variance;
  position_ += gain(0) * innovation;
  velocity_ += gain(1) * innovation;
  covariance_ -= (gain * gain.transpose() * innovation_variance).eval();
}

template class ConstantVelocityFilter<1>;
template class ConstantVelocityFilter<2>;

}  // namespace sidestep
