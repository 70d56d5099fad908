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

// Focal length, distortion, principal point (2), rotation (3, a turn after the present one), translation (3).
constexpr int kAll = 10;
constexpr int kMaxSteps = 200;
constexpr double kRobotTop_m = 0.15;
constexpr double kLeastNoise_px = 0.05;  // no measured pixel is better
using Step = Eigen::Matrix<double, kAll, 1>;
using Normal = Eigen::Matrix<double, kAll, kAll>;
using ByParameters = Eigen::Matrix<double, 2, kAll>;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::array<bool, kAll> sought(const CalibrationSettings& s) {
  std::array<bool, kAll> result;
  result.fill(true);
  result[0] = s.finds_focal_length;
  result[1] = s.finds_distortion;
  result[2] = result[3] = s.finds_principal_point;
  return result;
}

/// How the pixel of a point that the camera sees moves with its parameters.
ByParameters derivative(const CameraModel& camera, const Vec3& point_m) {
  const CameraParameters& c = camera.parameters();
  const Vec3 turned = c.rotation * point_m;
  const Vec3 p = turned + c.translation_m;
  const Vec2 sight = p.head<2>() / p.z();
  const double square = sight.squaredNorm();
  const double s = lens::distorting_factor(c.distortion * square);
  const double slope = 1 + 3 * c.distortion * square * s * s;
  const Eigen::Matrix<double, 2, 3> by_place =
      *camera.pixels_per_metre(point_m) * c.rotation.inverse().toRotationMatrix();
  Eigen::Matrix3d by_turn;
  by_turn << 0, turned.z(), -turned.y(), -turned.z(), 0, turned.x(), turned.y(), -turned.x(), 0;
  ByParameters result;
  result.col(0) = s * sight;
  result.col(1) = -c.focal_length_px * square * s * s * s / slope * sight;
  result.middleCols<2>(2).setIdentity();
  result.middleCols<3>(4) = by_place * by_turn;
  result.rightCols<3>() = by_place;
  return result;
}

CameraParameters moved(CameraParameters camera, const Step& step) {
  camera.focal_length_px += step[0];
  camera.distortion += step[1];
  camera.principal_point_px += step.segment<2>(2);
  const Vec3 turn = step.segment<3>(4);
  const double angle_rad = turn.norm();
  if (angle_rad > 0)
    camera.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, turn / angle_rad)) * camera.rotation;
  camera.rotation.normalize();
  camera.translation_m += step.tail<3>();
  return camera;
}

/// Sum of squared pixel errors; infinite when a point cannot be seen.
double cost_of(const CameraParameters& parameters, std::span<const CalibrationPoint> points) {
  if (!fault_of(parameters).empty()) return kInfinite;
  const CameraModel camera(parameters);
  double sum = 0;
  for (const CalibrationPoint& point : points) {
    const std::optional<Vec2> pixel = camera.pixel_of(point.point_m);
    if (!pixel) return kInfinite;
    sum += (*pixel - point.pixel).squaredNorm();
  }
  return sum;
}

/// The normal equations; parameters that are not sought stay where they are.
void set_up(const CameraModel& camera, std::span<const CalibrationPoint> points,
            const std::array<bool, kAll>& is_sought, Normal& normal, Step& right) {
  normal.setZero();
  right.setZero();
  for (const CalibrationPoint& point : points) {
    const ByParameters by = derivative(camera, point.point_m);
    normal += by.transpose() * by;
    right += by.transpose() * (point.pixel - *camera.pixel_of(point.point_m));
  }
  for (int i = 0; i < kAll; ++i) {
    if (is_sought[static_cast<std::size_t>(i)]) continue;
    normal.row(i).setZero();
    normal.col(i).setZero();
    normal(i, i) = 1;
    right[i] = 0;
  }
}

/// Goes down from `camera`, whose cost is finite, and returns the cost that it has reached.
double descend(CameraParameters& camera, std::span<const CalibrationPoint> points,
               const std::array<bool, kAll>& is_sought) {
  double cost = cost_of(camera, points), damping = 1e-3;
  Normal normal;
  Step right;
  for (int i = 0; i < kMaxSteps && damping < 1e12; ++i) {
    set_up(CameraModel(camera), points, is_sought, normal, right);
    Normal damped = normal;
    damped.diagonal() *= 1 + damping;
    const Step step = damped.ldlt().solve(right);
    const CameraParameters next = moved(camera, step);
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

/// A pose for the camera's focal length; whether there is one from which all points are seen.
bool find_pose(std::span<const CalibrationPoint> points, CameraParameters& camera) {
  std::vector<cv::Point3d> places;
  std::vector<cv::Point2d> sights;
  for (const CalibrationPoint& point : points) {
    const Vec2 distorted = (point.pixel - camera.principal_point_px) / camera.focal_length_px;
    const double factor = lens::undistorting_factor(camera.distortion * distorted.squaredNorm());
    if (std::isnan(factor)) return false;
    places.emplace_back(point.point_m.x(), point.point_m.y(), point.point_m.z());
    sights.emplace_back(factor * distorted.x(), factor * distorted.y());
  }
  cv::Mat turn, place;
  try {
    if (!cv::solvePnP(places, sights, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), turn, place, false,
                      cv::SOLVEPNP_SQPNP))
      return false;
  } catch (const cv::Exception&) {
    return false;
  }
  cv::Mat matrix;
  cv::Rodrigues(turn, matrix);
  Eigen::Matrix3d rotation;
  for (int i = 0; i < 9; ++i) rotation(i / 3, i % 3) = matrix.at<double>(i / 3, i % 3);
  camera.rotation = Eigen::Quaterniond(rotation).normalized();
  for (int i = 0; i < 3; ++i) camera.translation_m[i] = place.at<double>(i);
  return std::isfinite(cost_of(camera, points));
}

double top_sd_px(const CameraModel& camera, std::span<const CalibrationPoint> points,
                 const std::array<bool, kAll>& is_sought, double noise_px) {
  Normal normal;
  Step right;
  set_up(camera, points, is_sought, normal, right);
  // Scaled to a diagonal of ones, so that units do not matter.
  const Step scale = normal.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Normal> solver(scale.asDiagonal() * normal * scale.asDiagonal());
  const Step values = solver.eigenvalues().cwiseMax(1e-15);
  double largest = 0;
  for (const CalibrationPoint& point : points) {
    const Vec3 top_m = point.point_m + Vec3(0, 0, kRobotTop_m);
    if (!camera.pixel_of(top_m)) continue;
    ByParameters by = derivative(camera, top_m);
    for (int i = 0; i < kAll; ++i)
      if (!is_sought[static_cast<std::size_t>(i)]) by.col(i).setZero();
    const ByParameters along = by * scale.asDiagonal() * solver.eigenvectors();
    const Eigen::Matrix2d covariance = along * values.cwiseInverse().asDiagonal() * along.transpose();
    largest = std::max(largest, covariance.trace());
  }
  return noise_px * std::sqrt(largest);
}

double rms_m(const CameraModel& camera, std::span<const CalibrationPoint> points) {
  double sum = 0;
  for (const CalibrationPoint& point : points) {
    const std::optional<Vec2> place = camera.point_at(point.pixel, point.point_m.z());
    sum += place ? (*place - point.point_m.head<2>()).squaredNorm() : kInfinite;
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

}  // namespace

CalibrationResult calibrate_camera(std::span<const CalibrationPoint> points, const CameraParameters& start,
                                   const CalibrationSettings& settings) {
  CalibrationResult result;
  result.camera = start;
  if (result.fault = fault_of(start); !result.fault.empty()) return result;
  const std::array<bool, kAll> is_sought = sought(settings);
  const auto unknowns = static_cast<std::size_t>(std::count(is_sought.begin(), is_sought.end(), true));
  if (2 * points.size() <= unknowns) {
    result.fault =
        fmt::format("{} points are too few, expected at least {}", points.size(), unknowns / 2 + 1);
    return result;
  }
  for (const CalibrationPoint& point : points) {
    if (point.point_m.allFinite() && point.pixel.allFinite()) continue;
    result.fault = "a point is not finite";
    return result;
  }

  std::vector<double> focal_lengths_px{start.focal_length_px};
  if (settings.finds_focal_length) {
    for (const double share : {0.3, 0.45, 0.7, 1.0, 1.5, 2.2, 3.3})
      focal_lengths_px.push_back(share * std::max(start.width_px, start.height_px));
  }
  double cost = kInfinite;
  for (const double focal_length_px : focal_lengths_px) {
    CameraParameters camera = start;
    camera.focal_length_px = focal_length_px;
    if (!find_pose(points, camera)) continue;
    const double reached = descend(camera, points, is_sought);
    if (reached < cost) {
      cost = reached;
      result.camera = camera;
    }
  }
  if (!std::isfinite(cost)) {
    result.fault = "no camera sees all points: they lie on a line, or pixels belong to other points";
    return result;
  }
  const CameraModel camera(result.camera);
  const double count = static_cast<double>(points.size());
  result.rms_px = std::sqrt(cost / count);
  result.rms_m = rms_m(camera, points);
  const double noise_px = std::sqrt(cost / (2 * count - static_cast<double>(unknowns)));
  result.top_sd_px = top_sd_px(camera, points, is_sought, std::max(noise_px, kLeastNoise_px));
  if (!(result.top_sd_px <= settings.largest_top_sd_px)) {
    result.fault = fmt::format(
        "the points leave the camera open: tops of robots would be off by {:.2g} px; more points, farther "
        "apart "
        "and at several heights, or a known focal length would settle it",
        result.top_sd_px);
  }
  return result;
}

}  // namespace sidestep
