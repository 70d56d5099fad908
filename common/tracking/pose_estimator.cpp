// SPDX-License-Identifier: Apache-2.0
#include "common/tracking/pose_estimator.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kExtraFixNoise_m = 0.0005;  ///< covers the correlation of fixes by vision's filter

// Periods may differ from the nominal period by one part in this number, because the robot's clock may drift.
constexpr int kMaxPeriodErrorPart = 1000;
constexpr double kHeadingGain = 0.05;        // gain of a heading fix
constexpr double kSlipVariance_m2ps = 1e-8;  // position variance due to wheel slip
constexpr double kScaleDriftPerSqrtSecond = 2e-5;
constexpr double kOutlierDeviations = 4;
// No odometry has a larger relative error than this many standard deviations.
constexpr double kMaxScaleDeviations = 5;
// The sum of the innovations of two or three fixes exceeds this number of standard deviations by chance once
// in a thousand robot-hours.
constexpr double kJumpDeviations = 5;
// Minimum projection of an innovation on the previous one, relative to the longer of the two.
constexpr double kMinAgreement = 0.35;

}  // namespace

PoseEstimator::PoseEstimator(const Vec2& position_m, double heading_rad, Time now,
                             const EstimatorSettings& settings, double deviation_m)
    : history_(kHistoryPeriods),
      count_(1),
      time_(now),
      anchor_time_(now),
      anchor_m_(position_m),
      covariance_(Eigen::Matrix3d::Zero()),
      heading_anchor_rad_(heading_rad),
      settings_(settings) {
  covariance_.diagonal() << deviation_m * deviation_m, deviation_m * deviation_m,
      settings.scale_error * settings.scale_error;
}

void PoseEstimator::advance(Time now, const Odometry& odometry, const Vec2& acceleration_mps2,
                            double angular_acceleration_radps2, bool is_measured) {
  const double dt = to_seconds(settings_.period);
  if (std::chrono::abs(now - time_ - settings_.period) > settings_.period / kMaxPeriodErrorPart) count_ = 0;
  time_ = now;
  if (!is_measured) commanded_at_ = now;
  odometry_m_ += odometry.velocity_mps * dt;
  turned_rad_ += odometry.angular_radps * dt;
  history_[static_cast<std::size_t>(count_ % kHistoryPeriods)] = {odometry_m_, turned_rad_};
  ++count_;

  // The measurement is the mean over the period, so it is the velocity half a period ago.
  velocity_mps_ += acceleration_mps2 * dt;
  const Vec2 measured = odometry.velocity_mps * (1 - scale_) + acceleration_mps2 * (0.5 * dt);
  velocity_mps_ += settings_.velocity_gain * (measured - velocity_mps_);
  angular_radps_ += angular_acceleration_radps2 * dt;
  angular_radps_ += settings_.velocity_gain *
                    (odometry.angular_radps + angular_acceleration_radps2 * (0.5 * dt) - angular_radps_);
}

bool PoseEstimator::correct(Time captured_at, const Vec2& position_m, double heading_rad) {
  if (!position_m.allFinite() || !std::isfinite(heading_rad)) return false;
  if (captured_at <= anchor_time_ || captured_at > time_) return false;
  const std::int64_t available = std::min(count_, kHistoryPeriods);
  const Duration age = time_ - captured_at;
  const std::int64_t periods_back = age / settings_.period;
  if (periods_back + 1 >= available) return false;

  const double fraction = to_seconds(age - periods_back * settings_.period) / to_seconds(settings_.period);
  const Sample& later = history_[static_cast<std::size_t>((count_ - 1 - periods_back) % kHistoryPeriods)];
  const Sample& earlier = history_[static_cast<std::size_t>((count_ - 2 - periods_back) % kHistoryPeriods)];
  const Vec2 odometry = later.odometry_m + (earlier.odometry_m - later.odometry_m) * fraction;
  const double turned = later.turned_rad + (earlier.turned_rad - later.turned_rad) * fraction;

  const Vec2 moved = odometry - anchor_odometry_m_;
  const double elapsed_s = to_seconds(captured_at - anchor_time_);
  covariance_ = covariance_after(elapsed_s, moved);

  const double fix_variance =
      settings_.fix_noise_m * settings_.fix_noise_m + kExtraFixNoise_m * kExtraFixNoise_m;
  const Vec2 predicted = anchor_m_ + moved * (1 - scale_);
  Vec2 innovation = position_m - predicted;
  jump_m_ = 0;
  const double expected = 0.5 * (covariance_(0, 0) + covariance_(1, 1)) + fix_variance;
  // An event that displaces the robot or misleads vision says nothing about the odometry's scale.
  if (!(innovation.squaredNorm() <= kOutlierDeviations * kOutlierDeviations * expected)) decorrelate_scale();
  if (detect_displacement({innovation, expected})) {
    jump_m_ = innovation.norm();
    // A base may suddenly follow its commands by another part, such as that of a simulator whose computer is
    // busy.
    if (has_unmeasured_motion()) covariance_(2, 2) = settings_.scale_error * settings_.scale_error;
    covariance_.topLeftCorner<2, 2>() += jump_m_ * jump_m_ * Eigen::Matrix2d::Identity();
  }
  const Eigen::Matrix2d innovation_variance =
      covariance_.topLeftCorner<2, 2>() + fix_variance * Eigen::Matrix2d::Identity();
  const Eigen::Matrix<double, 3, 2> gain = covariance_.leftCols<2>() * innovation_variance.inverse();
  const double max_innovation = kOutlierDeviations * std::sqrt(0.5 * innovation_variance.trace());
  if (innovation.norm() > max_innovation) innovation *= max_innovation / innovation.norm();
  const Eigen::Vector3d correction = gain * innovation;
  covariance_ -= gain * covariance_.topRows<2>();
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();

  anchor_time_ = captured_at;
  anchor_odometry_m_ = odometry;
  anchor_m_ = predicted + correction.head<2>();
  scale_ += correction.z();
  // The odometry's relative error e is defined by 1 + e = 1 / (1 - scale).
  if (!(scale_ < 1 && std::abs(scale_ / (1 - scale_)) <= kMaxScaleDeviations * settings_.scale_error)) {
    // Wheels that roll while the robot is displaced can cause such an apparent error.
    scale_ = 0;
    covariance_(2, 2) = settings_.scale_error * settings_.scale_error;
    decorrelate_scale();
  }
  // A robot that was displaced may have been turned by any angle.
  const double heading_gain = jump_m_ > 0 ? 1 : kHeadingGain;
  heading_anchor_rad_ = wrapped_rad(heading_anchor_rad_ +
                                    heading_gain * wrapped_rad(heading_rad - heading_anchor_rad_ - turned));
  return true;
}

void PoseEstimator::decorrelate_scale() {
  covariance_.topRightCorner<2, 1>().setZero();
  covariance_.bottomLeftCorner<1, 2>().setZero();
}

Eigen::Matrix3d PoseEstimator::covariance_after(double elapsed_s, const Vec2& moved_m) const {
  Eigen::Matrix3d transition = Eigen::Matrix3d::Identity();
  transition.topRightCorner<2, 1>() = -moved_m;
  const double noise_mps =
      has_unmeasured_motion() ? settings_.commanded_noise_mps : settings_.velocity_noise_mps;
  const double noise_variance = noise_mps * noise_mps;
  const double position_variance =
      (noise_variance * to_seconds(settings_.period) + kSlipVariance_m2ps) * elapsed_s;
  const double scale_variance = kScaleDriftPerSqrtSecond * kScaleDriftPerSqrtSecond * elapsed_s;
  Eigen::Matrix3d covariance = transition * covariance_ * transition.transpose();
  covariance.diagonal() += Eigen::Vector3d(position_variance, position_variance, scale_variance);
  return covariance;
}

double PoseEstimator::position_error_rms_m() const {
  const auto now = covariance_after(to_seconds(time_ - anchor_time_), odometry_m_ - anchor_odometry_m_);
  return std::sqrt(std::max(now(0, 0) + now(1, 1), 0.0));  // NaN if the sum is NaN
}

bool PoseEstimator::detect_displacement(const Innovation& latest) {
  std::move_backward(recent_innovations_.begin(), recent_innovations_.end() - 1, recent_innovations_.end());
  recent_innovations_[0] = latest;
  Innovation sum = latest;
  for (std::size_t count = 1; count < recent_innovations_.size(); ++count) {
    // A single outlier is not trusted: another fix must confirm it.
    const Vec2 &later = recent_innovations_[count - 1].offset_m,
               &earlier = recent_innovations_[count].offset_m;
    const double larger = std::max(later.squaredNorm(), earlier.squaredNorm());
    const bool do_disagree = later.dot(earlier) < kMinAgreement * larger;
    if (do_disagree) return false;
    sum.offset_m += earlier;
    sum.variance_m2 += recent_innovations_[count].variance_m2;
    if (!(sum.offset_m.squaredNorm() <= kJumpDeviations * kJumpDeviations * sum.variance_m2)) {
      recent_innovations_.fill({});
      return true;
    }
  }
  return false;
}

}  // namespace sidestep
