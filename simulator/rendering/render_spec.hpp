// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "common/image/image.hpp"

namespace sidestep {

/// A robot's body: a cylinder with a flat front, a black top and dark sides.
struct RobotCylinder {
  double radius_m = 0.09;
  double front_m = 0.055;  ///< distance of the flat front from the centre
  double height_m = 0.15;
};

enum class LightFalloff {
  kLinear,  ///< along x, from full light at the field's low end
  kRadial,  ///< from full light at the centre, falling off towards the corners
};

/// Properties of light, lens and sensor. The defaults are those of a good camera in a hall with windows.
struct RenderSpec {
  PixelFormat format = PixelFormat::kYuv422;
  LightFalloff light_falloff = LightFalloff::kLinear;
  double far_light = 0.85;               ///< fraction of full light at the far end
  Eigen::Vector3d colour_gain{1, 1, 1};  ///< gain of red, green and blue: the error of the white balance
  double blur_px = 0.7;           ///< standard deviation of the lens's Gaussian blur; no blur below 0.2
  double noise = 2.5;             ///< standard deviation in each colour channel, in levels of 255
  double surface_texture = 0.02;  ///< relative standard deviation of the field surface's brightness
  double exposure_s = 0;          ///< duration of the exposure, centred on the capture time
  RobotCylinder robot;
};

}  // namespace sidestep
