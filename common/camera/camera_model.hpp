// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "common/geometry/vec2.hpp"
#include "common/geometry/vec3.hpp"

namespace sidestep {

/// Camera parameters as in the league's SSL_GeometryCameraCalibration, but in metres, and the image size.
/// Pixel coordinates in this project: x to the right, y down, integers at pixel centres. The image extends
/// from -0.5 to width - 0.5.
struct CameraParameters {
  int width_px = 780;
  int height_px = 580;
  double focal_length_px = 600;
  Vec2 principal_point_px{389.5, 289.5};
  double distortion = 0;  ///< coefficient k in common/camera/lens.hpp
  /// A world point p has the camera coordinates rotation · p + translation_m: x to the right, y down, z along
  /// the optical axis. The league's q0 to q3 are the quaternion's x, y, z, w.
  Eigen::Quaterniond rotation{0, 1, 0, 0};
  Vec3 translation_m{0, 0, 4};
};

/// The reason why the parameters are invalid; empty if they are valid.
[[nodiscard]] std::string validation_error(const CameraParameters& parameters);

/// Projects points: the league's pinhole model with radial distortion. The world's z points up and is 0 on
/// the floor.
class CameraModel {
 public:
  /// Normalises the rotation. Throws std::invalid_argument with validation_error() if the parameters are
  /// invalid.
  explicit CameraModel(const CameraParameters& parameters);

  /// The projection of a point, possibly outside the image. nullopt for a point that is not in front of the
  /// camera or lies outside the lens's domain.
  std::optional<Vec2> pixel_of(const Vec3& point_m) const;

  /// The point at a height (0 is the floor) on a pixel's viewing ray. nullopt outside the lens's domain, and
  /// if the ray does not descend to that height from the camera.
  std::optional<Vec2> point_at(const Vec2& pixel, double height_m) const;

  /// The Jacobian of pixel_of(), in pixels per metre along x, y and z; its first two columns describe motion
  /// on the floor. nullopt where pixel_of() has no value.
  std::optional<Eigen::Matrix<double, 2, 3>> projection_jacobian(const Vec3& point_m) const;

  /// Whether the pixel lies in the image.
  bool is_in_image(const Vec2& pixel) const {
    return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < parameters_.width_px - 0.5 &&
           pixel.y() < parameters_.height_px - 0.5;
  }

  /// The position of the camera in the world.
  const Vec3& position_m() const { return position_m_; }
  const CameraParameters& parameters() const { return parameters_; }

 private:
  CameraParameters parameters_;
  Eigen::Matrix3d to_camera_;
  Eigen::Matrix3d to_world_;
  Vec3 position_m_;
};

}  // namespace sidestep
