// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "common/geometry/vec2.hpp"
#include "common/geometry/vec3.hpp"

namespace sidestep {

/// The fields of the league's SSL_GeometryCameraCalibration, in metres, and the image's size. Pixels: x to
/// the right, y down, and whole numbers are the centres of pixels, everywhere in this project: the image
/// reaches from -0.5 to width - 0.5.
struct CameraParameters {
  int width_px = 780;
  int height_px = 580;
  double focal_length_px = 600;
  Vec2 principal_point_px{389.5, 289.5};
  double distortion = 0;  ///< k of common/camera/lens.hpp
  /// A point p of the world stands at rotation · p + translation_m before the camera: x to the right, y down,
  /// z along the optical axis. The league's q0 to q3 are its x, y, z, w.
  Eigen::Quaterniond rotation{0, 1, 0, 0};
  Vec3 translation_m{0, 0, 4};
};

/// Empty when the numbers make a camera, else what is wrong with them.
std::string fault_of(const CameraParameters& parameters);

/// What a camera does to points: the league's pinhole with radial distortion. The world's z is up, and 0 on
/// the floor.
class CameraModel {
 public:
  /// The rotation is normalised. Throws std::invalid_argument with fault_of() when there is one.
  explicit CameraModel(const CameraParameters& parameters);

  /// Where a point is seen, maybe outside the image. Nothing for a point that is not before the camera, or
  /// beyond the lens's domain.
  std::optional<Vec2> pixel_of(const Vec3& point_m) const;

  /// The point at a height, 0 for the floor, that a pixel shows. Nothing beyond the lens's domain, or when
  /// the ray goes up, or when the camera hangs lower.
  std::optional<Vec2> point_at(const Vec2& pixel, double height_m) const;

  /// How the pixel moves with the point, in pixels per metre along x, y and z; the two columns at the left
  /// belong to motion on the floor. Nothing where pixel_of() has nothing.
  std::optional<Eigen::Matrix<double, 2, 3>> pixels_per_metre(const Vec3& point_m) const;

  /// Whether the pixel lies in the image.
  bool shows(const Vec2& pixel) const {
    return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < parameters_.width_px - 0.5 &&
           pixel.y() < parameters_.height_px - 0.5;
  }

  /// Where the camera hangs.
  const Vec3& position_m() const { return position_m_; }
  const CameraParameters& parameters() const { return parameters_; }

 private:
  CameraParameters parameters_;
  Eigen::Matrix3d to_camera_;
  Eigen::Matrix3d to_world_;
  Vec3 position_m_;
};

}  // namespace sidestep
