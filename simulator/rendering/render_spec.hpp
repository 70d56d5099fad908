// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "common/image/image.hpp"

namespace sidestep {

/// The body of a robot: a cylinder with a flat front, black on top and dark on its sides.
struct RobotCylinder {
  double radius_m = 0.09;
  double front_m = 0.055;  ///< of the flat front, from the centre
  double height_m = 0.15;
};

enum class LightFall {
  kLinear,  ///< from full light at the field's low x to its high x
  kRadial,  ///< from full light at the centre to the corners
};

/// What becomes of light between floor and frame; the defaults are those of a good camera in a hall with
/// windows.
struct RenderSpec {
  PixelFormat format = PixelFormat::kYuv422;
  LightFall light_fall = LightFall::kLinear;
  double far_light = 0.85;               ///< share of the full light that is left at the far end
  Eigen::Vector3d colour_gain{1, 1, 1};  ///< of red, green and blue; what a white balance is off by
  double blur_px = 0.7;          ///< standard deviation of the lens's Gaussian blur; below 0.2 there is none
  double noise = 2.5;            ///< standard deviation of each of red, green and blue, of 255
  double carpet_texture = 0.02;  ///< relative standard deviation of the carpet's brightness
  double exposure_s = 0;         ///< the shutter is open for so long about the time of capture
  RobotCylinder robot;
};

}  // namespace sidestep
