// SPDX-License-Identifier: Apache-2.0
#include "vision/cameras/camera_calibration.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "common/camera/lens.hpp"

namespace sidestep {
namespace {

constexpr double kMaxRobotTopSd_px = 0.5;  ///< upper limit of CalibrationResult::robot_top_sd_px

// The parameters: focal length, distortion, principal point (2), rotation vector applied after the current
// rotation (3), translation (3).
constexpr int kParameters = 10;
constexpr int kMaxIterations = 200;
constexpr double kRobotTop_m = 0.15;
constexpr double kMinNoise_px = 0.05;  // assumed minimum error of a measured pixel
using Step = Eigen::Matrix<double, kParameters, 1>;
using NormalMatrix = Eigen::Matrix<double, kParameters, kParameters>;
using Jacobian = Eigen::Matrix<double, 2, kParameters>;
using FreeParameters = std::array<bool, kParameters>;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

FreeParameters free_parameters(const CalibrationSettings& s) {
  FreeParameters result;
  result.fill(true);
  result[0] = s.estimates_focal_length;
  result[1] = s.estimates_distortion;
  result[2] = result[3] = s.estimates_principal_point;
  return result;
}

/// Derivative of a visible point's pixel with respect to the camera's parameters.
Jacobian jacobian_of(const CameraModel& camera, const Vec3& point_m) {
  const CameraParameters& c = camera.parameters();
  const Vec3 rotated_point = c.rotation * point_m;
  const Vec3 p = rotated_point + c.translation_m;
  const Vec2 ray = p.head<2>() / p.z();
  const double square = ray.squaredNorm();
  const double s = lens::distortion_factor(c.distortion * square);
  const double slope = 1 + 3 * c.distortion * square * s * s;
  const Eigen::Matrix<double, 2, 3> by_translation =
      *camera.projection_jacobian(point_m) * c.rotation.inverse().toRotationMatrix();
  Eigen::Matrix3d by_rotation;
  by_rotation << 0, rotated_point.z(), -rotated_point.y(), -rotated_point.z(), 0, rotated_point.x(),
      rotated_point.y(), -rotated_point.x(), 0;
  Jacobian result;
  result.col(0) = s * ray;
  result.col(1) = -c.focal_length_px * square * s * s * s / slope * ray;
  result.middleCols<2>(2).setIdentity();
  result.middleCols<3>(4) = by_translation * by_rotation;
  result.rightCols<3>() = by_translation;
  return result;
}

CameraParameters updated(CameraParameters camera, const Step& step) {
  camera.focal_length_px += step[0];
  camera.distortion += step[1];
  camera.principal_point_px += step.segment<2>(2);
  const Vec3 rotation = step.segment<3>(4);
  const double angle_rad = rotation.norm();
  if (angle_rad > 0)
    camera.rotation =
        Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, rotation / angle_rad)) * camera.rotation;
  camera.rotation.normalize();
  camera.translation_m += step.tail<3>();
  return camera;
}

/// Sum of squared pixel errors; infinite if a point is not visible.
double cost_of(const CameraParameters& parameters, std::span<const CalibrationPoint> points) {
  if (!validation_error(parameters).empty()) return kInfinite;
  const CameraModel camera(parameters);
  double sum = 0;
  for (const CalibrationPoint& point : points) {
    const std::optional<Vec2> pixel = camera.pixel_of(point.point_m);
    if (!pixel) return kInfinite;
    sum += (*pixel - point.pixel).squaredNorm();
  }
  return sum;
}

/// Sets up the normal equations; their solution has a step of 0 for fixed parameters.
void set_up_normal_equations(const CameraModel& camera, std::span<const CalibrationPoint> points,
                             const FreeParameters& is_free, NormalMatrix& normal, Step& right) {
  normal.setZero();
  right.setZero();
  for (const CalibrationPoint& point : points) {
    const Jacobian jacobian = jacobian_of(camera, point.point_m);
    normal += jacobian.transpose() * jacobian;
    right += jacobian.transpose() * (point.pixel - *camera.pixel_of(point.point_m));
  }
  for (int i = 0; i < kParameters; ++i) {
    if (is_free[static_cast<std::size_t>(i)]) continue;
    normal.row(i).setZero();
    normal.col(i).setZero();
    normal(i, i) = 1;
    right[i] = 0;
  }
}

/// Minimises the cost, starting at `camera`, whose cost must be finite. Returns the final cost.
double minimise(CameraParameters& camera, std::span<const CalibrationPoint> points,
                const FreeParameters& is_free) {
  double cost = cost_of(camera, points), damping = 1e-3;
  NormalMatrix normal;
  Step right;
  for (int i = 0; i < kMaxIterations && damping < 1e12; ++i) {
    set_up_normal_equations(CameraModel(camera), points, is_free, normal, right);
    NormalMatrix damped = normal;
    damped.diagonal() *= 1 + damping;
    const Step step = damped.ldlt().solve(right);
    const CameraParameters next = updated(camera, step);
    const double next_cost = step.allFinite() ? cost_of(next, points) : kInfinite;
    if (!(next_cost < cost)) {
      damping *= 8;
      continue;
    }
    const bool is_done = cost - next_cost <= 1e-14 * cost;
    camera = next;
    cost = next_cost;
    damping = std::max(damping / 8, 1e-12);
    if (is_done) break;
  }
  return cost;
}

/// Sets an initial pose for the camera's focal length. False if no pose shows all points.
bool find_pose(std::span<const CalibrationPoint> points, CameraParameters& camera) {
  std::vector<cv::Point3d> positions;
  std::vector<cv::Point2d> rays;
  for (const CalibrationPoint& point : points) {
    const Vec2 distorted = (point.pixel - camera.principal_point_px) / camera.focal_length_px;
    const double factor = lens::undistortion_factor(camera.distortion * distorted.squaredNorm());
    if (std::isnan(factor)) return false;
    positions.emplace_back(point.point_m.x(), point.point_m.y(), point.point_m.z());
    rays.emplace_back(factor * distorted.x(), factor * distorted.y());
  }
  cv::Mat rotation_vector, translation;
  try {
    if (!cv::solvePnP(positions, rays, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotation_vector,
                      translation, false, cv::SOLVEPNP_SQPNP))
      return false;
  } catch (const cv::Exception&) {
    return false;
  }
  cv::Mat matrix;
  cv::Rodrigues(rotation_vector, matrix);
  Eigen::Matrix3d rotation;
  for (int i = 0; i < 9; ++i) rotation(i / 3, i % 3) = matrix.at<double>(i / 3, i % 3);
  camera.rotation = Eigen::Quaterniond(rotation).normalized();
  for (int i = 0; i < 3; ++i) camera.translation_m[i] = translation.at<double>(i);
  return std::isfinite(cost_of(camera, points));
}

double robot_top_sd_px(const CameraModel& camera, std::span<const CalibrationPoint> points,
                       const FreeParameters& is_free, double noise_px) {
  NormalMatrix normal;
  Step right;
  set_up_normal_equations(camera, points, is_free, normal, right);
  // Scaled to a unit diagonal, so that the parameters' units do not matter.
  const Step scale = normal.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<NormalMatrix> solver(scale.asDiagonal() * normal * scale.asDiagonal());
  const Step eigenvalues = solver.eigenvalues().cwiseMax(1e-15);
  double max_variance = 0;
  for (const CalibrationPoint& point : points) {
    const Vec3 top_m = point.point_m + Vec3(0, 0, kRobotTop_m);
    if (!camera.pixel_of(top_m)) continue;
    Jacobian jacobian = jacobian_of(camera, top_m);
    for (int i = 0; i < kParameters; ++i)
      if (!is_free[static_cast<std::size_t>(i)]) jacobian.col(i).setZero();
    const Jacobian projected = jacobian * scale.asDiagonal() * solver.eigenvectors();
    const Eigen::Matrix2d covariance =
        projected * eigenvalues.cwiseInverse().asDiagonal() * projected.transpose();
    max_variance = std::max(max_variance, covariance.trace());
  }
  return noise_px * std::sqrt(max_variance);
}

double rms_m(const CameraModel& camera, std::span<const CalibrationPoint> points) {
  double sum = 0;
  for (const CalibrationPoint& point : points) {
    const std::optional<Vec2> position = camera.point_at(point.pixel, point.point_m.z());
    sum += position ? (*position - point.point_m.head<2>()).squaredNorm() : kInfinite;
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

/// Sets max_px and worst_index. Precondition: all points are visible.
void find_worst_point(const CameraModel& camera, std::span<const CalibrationPoint> points,
                      CalibrationResult& result) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double error_px = (*camera.pixel_of(points[i].point_m) - points[i].pixel).norm();
    if (error_px <= result.max_px) continue;
    result.max_px = error_px;
    result.worst_index = i;
  }
}

}  // namespace

CalibrationResult calibrate_camera(std::span<const CalibrationPoint> points, const CameraParameters& initial,
                                   const CalibrationSettings& settings) {
  CalibrationResult result;
  result.camera = initial;
  if (result.error = validation_error(initial); !result.error.empty()) return result;
  const FreeParameters is_free = free_parameters(settings);
  const auto unknowns = static_cast<std::size_t>(std::count(is_free.begin(), is_free.end(), true));
  if (2 * points.size() <= unknowns) {
    result.error = fmt::format("expected at least {} points, got {}", unknowns / 2 + 1, points.size());
    return result;
  }
  for (const CalibrationPoint& point : points) {
    if (point.point_m.allFinite() && point.pixel.allFinite()) continue;
    result.error = "a point is not finite";
    return result;
  }

  std::vector<double> focal_lengths_px{initial.focal_length_px};
  if (settings.estimates_focal_length) {
    for (const double share : {0.3, 0.45, 0.7, 1.0, 1.5, 2.2, 3.3})
      focal_lengths_px.push_back(share * std::max(initial.width_px, initial.height_px));
  }
  double cost = kInfinite;
  for (const double focal_length_px : focal_lengths_px) {
    CameraParameters camera = initial;
    camera.focal_length_px = focal_length_px;
    if (!find_pose(points, camera)) continue;
    const double final_cost = minimise(camera, points, is_free);
    if (final_cost < cost) {
      cost = final_cost;
      result.camera = camera;
    }
  }
  if (!std::isfinite(cost)) {
    result.error =
        "no camera pose shows all points: they are collinear, or pixels are assigned to wrong points";
    return result;
  }
  const CameraModel camera(result.camera);
  const double count = static_cast<double>(points.size());
  result.rms_px = std::sqrt(cost / count);
  result.rms_m = rms_m(camera, points);
  find_worst_point(camera, points, result);
  const double noise_px = std::sqrt(cost / (2 * count - static_cast<double>(unknowns)));
  result.robot_top_sd_px = robot_top_sd_px(camera, points, is_free, std::max(noise_px, kMinNoise_px));
  if (!(result.robot_top_sd_px <= kMaxRobotTopSd_px)) {
    result.error = fmt::format(
        "the points do not determine the camera: predicted error of {:.2g} px at the height of robots, "
        "expected "
        "at most {:g}; add points farther apart and at several heights, or give the focal length",
        result.robot_top_sd_px, kMaxRobotTopSd_px);
  }
  return result;
}

}  // namespace sidestep
