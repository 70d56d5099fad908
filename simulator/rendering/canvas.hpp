// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "common/image/colour_space.hpp"

namespace sidestep {

/// The ideal image before blur and noise: RGB, 8 bits per channel.
using Canvas = cv::Mat3b;

/// An illuminated colour on a scale from 0 to 255, which strong light may exceed.
using Light = Eigen::Vector3f;

/// A colour under light with a gain per channel.
inline Light lit(const Rgb& colour, const Eigen::Vector3d& gain) {
  return Eigen::Vector3d(colour.r * gain.x(), colour.g * gain.y(), colour.b * gain.z()).cast<float>();
}

inline cv::Vec3b bytes_of(const Light& light) {
  return {cv::saturate_cast<unsigned char>(light.x()), cv::saturate_cast<unsigned char>(light.y()),
          cv::saturate_cast<unsigned char>(light.z())};
}

inline Light light_of(const cv::Vec3b& bytes) { return {float(bytes[0]), float(bytes[1]), float(bytes[2])}; }

}  // namespace sidestep
