// SPDX-License-Identifier: Apache-2.0
#include "simulator/pose_estimator.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kVelocityGain = 0.08;  // of a velocity measurement against the motor model
constexpr double kHeadingGain = 0.05;   // of a heading fix
constexpr double kStartDeviation_m = 0.0005;
constexpr double kSlipVariance_m2ps = 1e-8;  // wheels are never perfect
constexpr double kScaleDriftPerSqrtSecond = 2e-5;
constexpr double kFixFloor_m = 0.0005;  // fixes are filtered by vision, so their errors are not independent
constexpr double kOutlierDeviations = 4;
// Sums of two or three offsets so far from what is expected come by chance once in a thousand robot-hours.
constexpr double kSurpriseDeviations = 5;
constexpr double kAgreement =
    0.35;  // least projection of an offset on the one before, of the larger's length

}  // namespace

PoseEstimator::PoseEstimator(const Vec2& position_m, double heading_rad, Time now,
                             const EstimatorSettings& settings)
    : past_(kMemory),
      count_(1),
      time_(now),
      anchor_time_(now),
      anchor_m_(position_m),
      covariance_(Eigen::Matrix3d::Zero()),
      heading_anchor_rad_(heading_rad),
      settings_(settings) {
  covariance_.diagonal() << kStartDeviation_m * kStartDeviation_m, kStartDeviation_m * kStartDeviation_m,
      settings.scale_error * settings.scale_error;
}

void PoseEstimator::advance(Time now, const Odometry& odometry, const Vec2& acceleration_mps2,
                            double angular_acceleration_radps2) {
  constexpr double dt = kPhysicsStepSeconds;
  if (now - time_ != kPhysicsStep) count_ = 0;
  time_ = now;
  path_m_ += odometry.velocity_mps * dt;
  turned_rad_ += odometry.angular_radps * dt;
  past_[static_cast<std::size_t>(count_ % kMemory)] = {path_m_, turned_rad_};
  ++count_;

  // The measurement is the mean of the period, half a period ago.
  velocity_mps_ += acceleration_mps2 * dt;
  const Vec2 measured = odometry.velocity_mps * (1 - scale_) + acceleration_mps2 * (0.5 * dt);
  velocity_mps_ += kVelocityGain * (measured - velocity_mps_);
  angular_radps_ += angular_acceleration_radps2 * dt;
  angular_radps_ +=
      kVelocityGain * (odometry.angular_radps + angular_acceleration_radps2 * (0.5 * dt) - angular_radps_);
}

bool PoseEstimator::correct(Time captured_at, const Vec2& position_m, double heading_rad) {
  if (!position_m.allFinite() || !std::isfinite(heading_rad)) return false;
  if (captured_at <= anchor_time_ || captured_at > time_) return false;
  const std::int64_t remembered = std::min(count_, kMemory);
  const Duration age = time_ - captured_at;
  const std::int64_t back = age / kPhysicsStep;
  if (back + 1 >= remembered) return false;

  const double rest = to_seconds(age - back * kPhysicsStep) / kPhysicsStepSeconds;
  const Sample& later = past_[static_cast<std::size_t>((count_ - 1 - back) % kMemory)];
  const Sample& earlier = past_[static_cast<std::size_t>((count_ - 2 - back) % kMemory)];
  const Vec2 path = later.path_m + (earlier.path_m - later.path_m) * rest;
  const double turned = later.turned_rad + (earlier.turned_rad - later.turned_rad) * rest;

  const Vec2 moved = path - anchor_path_m_;
  const double elapsed_s = to_seconds(captured_at - anchor_time_);
  covariance_ = covariance_after(elapsed_s, moved);

  const double fix_variance = settings_.fix_noise_m * settings_.fix_noise_m + kFixFloor_m * kFixFloor_m;
  const Vec2 predicted = anchor_m_ + moved * (1 - scale_);
  Vec2 innovation = position_m - predicted;
  jump_m_ = 0;
  const double expected = 0.5 * (covariance_(0, 0) + covariance_(1, 1)) + fix_variance;
  if (was_moved_past_wheels({innovation, expected})) {
    jump_m_ = innovation.norm();
    covariance_.topLeftCorner<2, 2>() += jump_m_ * jump_m_ * Eigen::Matrix2d::Identity();
  }
  const Eigen::Matrix2d innovation_variance =
      covariance_.topLeftCorner<2, 2>() + fix_variance * Eigen::Matrix2d::Identity();
  const Eigen::Matrix<double, 3, 2> gain = covariance_.leftCols<2>() * innovation_variance.inverse();
  const double most = kOutlierDeviations * std::sqrt(0.5 * innovation_variance.trace());
  if (innovation.norm() > most) innovation *= most / innovation.norm();
  const Eigen::Vector3d correction = gain * innovation;
  covariance_ -= gain * covariance_.topRows<2>();
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();

  anchor_time_ = captured_at;
  anchor_path_m_ = path;
  anchor_m_ = predicted + correction.head<2>();
  scale_ += correction.z();
  heading_anchor_rad_ = wrapped_rad(heading_anchor_rad_ +
                                    kHeadingGain * wrapped_rad(heading_rad - heading_anchor_rad_ - turned));
  return true;
}

Eigen::Matrix3d PoseEstimator::covariance_after(double elapsed_s, const Vec2& moved_m) const {
  Eigen::Matrix3d advance = Eigen::Matrix3d::Identity();
  advance.topRightCorner<2, 1>() = -moved_m;
  const double noise_variance = settings_.velocity_noise_mps * settings_.velocity_noise_mps;
  const double walk = (noise_variance * kPhysicsStepSeconds + kSlipVariance_m2ps) * elapsed_s;
  const double drift = kScaleDriftPerSqrtSecond * kScaleDriftPerSqrtSecond * elapsed_s;
  Eigen::Matrix3d covariance = advance * covariance_ * advance.transpose();
  covariance.diagonal() += Eigen::Vector3d(walk, walk, drift);
  return covariance;
}

double PoseEstimator::deviation_m() const {
  const auto now = covariance_after(to_seconds(time_ - anchor_time_), path_m_ - anchor_path_m_);
  return std::sqrt(std::max(0.0, now(0, 0) + now(1, 1)));
}

bool PoseEstimator::was_moved_past_wheels(const Innovation& latest) {
  std::move_backward(surprises_.begin(), surprises_.end() - 1, surprises_.end());
  surprises_[0] = latest;
  Innovation sum = latest;
  for (std::size_t count = 1; count < surprises_.size(); ++count) {
    // One wild fix is not believed: what it says has to be said again.
    const Vec2 &later = surprises_[count - 1].offset_m, &earlier = surprises_[count].offset_m;
    const double larger = std::max(later.squaredNorm(), earlier.squaredNorm());
    if (later.dot(earlier) < kAgreement * larger) return false;
    sum.offset_m += earlier;
    sum.variance_m2 += surprises_[count].variance_m2;
    if (sum.offset_m.squaredNorm() > kSurpriseDeviations * kSurpriseDeviations * sum.variance_m2) {
      surprises_.fill({});
      return true;
    }
  }
  return false;
}

}  // namespace sidestep
