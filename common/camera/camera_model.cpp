// SPDX-License-Identifier: Apache-2.0
#include "common/camera/camera_model.hpp"

#include <cmath>
#include <stdexcept>

#include "common/camera/lens.hpp"

namespace sidestep {
namespace {

constexpr double kMinDepth_m = 1e-3;
constexpr int kMaxSize_px = 16384;

}  // namespace

std::string validation_error(const CameraParameters& p) {
  const auto is_size = [](int pixels) { return pixels > 0 && pixels <= kMaxSize_px; };
  if (!is_size(p.width_px) || !is_size(p.height_px)) return "the image size is not 1 to 16384 pixels";
  if (!std::isfinite(p.focal_length_px) || p.focal_length_px <= 0) return "the focal length is not positive";
  if (!p.principal_point_px.allFinite()) return "the principal point is not finite";
  if (!std::isfinite(p.distortion)) return "the distortion is not finite";
  if (!p.translation_m.allFinite()) return "the translation is not finite";
  const double norm = p.rotation.norm();
  if (!std::isfinite(norm) || std::abs(norm - 1) > 1e-3) return "the rotation is not a unit quaternion";
  return "";
}

CameraModel::CameraModel(const CameraParameters& parameters) : parameters_(parameters) {
  if (const std::string error = validation_error(parameters); !error.empty())
    throw std::invalid_argument(error);
  parameters_.rotation.normalize();
  to_camera_ = parameters_.rotation.toRotationMatrix();
  to_world_ = to_camera_.transpose();
  position_m_ = -(to_world_ * parameters_.translation_m);
}

std::optional<Vec2> CameraModel::pixel_of(const Vec3& point_m) const {
  const Vec3 p = to_camera_ * point_m + parameters_.translation_m;
  if (!(p.z() >= kMinDepth_m)) return std::nullopt;
  const Vec2 undistorted = p.head<2>() / p.z();
  const double factor = lens::distortion_factor(parameters_.distortion * undistorted.squaredNorm());
  if (std::isnan(factor)) return std::nullopt;
  return parameters_.principal_point_px + parameters_.focal_length_px * factor * undistorted;
}

std::optional<Vec2> CameraModel::point_at(const Vec2& pixel, double height_m) const {
  const Vec2 distorted = (pixel - parameters_.principal_point_px) / parameters_.focal_length_px;
  const double factor = lens::undistortion_factor(parameters_.distortion * distorted.squaredNorm());
  const Vec3 ray = to_world_ * Vec3(factor * distorted.x(), factor * distorted.y(), 1);
  const double depth_m = (height_m - position_m_.z()) / ray.z();
  if (!(depth_m >= kMinDepth_m) || !std::isfinite(depth_m)) return std::nullopt;
  return position_m_.head<2>() + depth_m * ray.head<2>();
}

std::optional<Eigen::Matrix<double, 2, 3>> CameraModel::projection_jacobian(const Vec3& point_m) const {
  const Vec3 p = to_camera_ * point_m + parameters_.translation_m;
  if (!(p.z() >= kMinDepth_m)) return std::nullopt;
  const Vec2 u = p.head<2>() / p.z();
  const double kr2 = parameters_.distortion * u.squaredNorm();
  const double factor = lens::distortion_factor(kr2);
  if (std::isnan(factor)) return std::nullopt;
  // Differentiates s (1 + k |u|² s²) = 1 with respect to u, the undistorted image point.
  const double slope = 1 + 3 * kr2 * factor * factor;
  const double along = -2 * parameters_.distortion * factor * factor * factor / slope;
  const Eigen::Matrix2d distorted_by_u = factor * Eigen::Matrix2d::Identity() + along * u * u.transpose();
  Eigen::Matrix<double, 2, 3> u_by_camera;
  u_by_camera << 1, 0, -u.x(), 0, 1, -u.y();
  return parameters_.focal_length_px / p.z() * distorted_by_u * u_by_camera * to_camera_;
}

}  // namespace sidestep
