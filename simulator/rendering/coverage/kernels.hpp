// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simulator/rendering/coverage/sample_pattern.hpp"

namespace sidestep::coverage {

/// The cross-section of a vertical body: the part of a disc about the origin where x <= front.
struct CrossSection {
  float radius = 0;
  float front = 0;
};

/// Viewing rays between the planes of a body's top and of the floor, projected onto the floor. A ray that
/// meets the plane of the top at p meets the floor at p + parallax (p - nadir); the nadir is the point below
/// the camera.
struct ViewingRays {
  float parallax = 0;
  float nadir_x = 0, nadir_y = 0;
};

/// The sample points of a pixel, as offsets from its centre.
struct PixelSamples {
  float x = 0, y = 0;
  const Points* offsets = nullptr;
};

/// Functions that count a pixel's samples in a region. All instruction sets give identical counts.
struct Kernels {
  const char* name;
  /// Counts the samples in a disc about (x, y).
  int (*count_in_disc)(const PixelSamples& samples, float x, float y, float radius);
  int (*count_in_cross_section)(const PixelSamples& samples, const CrossSection& section);
  /// Counts the samples whose rays meet the cross-section. The rays start at the samples. Their directions
  /// are those of the rays through the samples before the body's motion shifts them, which are at
  /// `still_offsets` from the pixel's centre.
  int (*count_rays_hitting)(const Points& still_offsets, const PixelSamples& samples, const ViewingRays& rays,
                            const CrossSection& section);
};

/// The kernels that this machine can run, the fastest last.
const std::vector<Kernels>& available_kernels();
const Kernels& best_kernels();

}  // namespace sidestep::coverage
