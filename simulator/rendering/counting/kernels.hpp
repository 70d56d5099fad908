// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simulator/rendering/counting/samples.hpp"

namespace sidestep::counting {

/// A body's outline: a disc about the origin, cut off at x = front.
struct TrajectoryBounds {
  float radius = 0;
  float front = 0;
};

/// The lines that start at points p lead along lean · (p - foot).
struct Lines {
  float lean = 0;
  float foot_x = 0, foot_y = 0;
};

/// The points of a pixel about its centre.
struct Pixel {
  float x = 0, y = 0;
  const Points* about = nullptr;
};

/// How many of a pixel's points lie where. All instruction sets count the same.
struct Kernels {
  const char* name;
  /// Within the radius of a place.
  int (*in_disc)(const Pixel& pixel, float x, float y, float radius);
  int (*in_outline)(const Pixel& pixel, const TrajectoryBounds& outline);
  /// On lines that meet the outline: they start at the pixel's points, and lead where lines from `plain`,
  /// points about the same centre, do.
  int (*on_lines)(const Points& plain, const Pixel& pixel, const Lines& lines, const TrajectoryBounds& outline);
};

/// Those that this machine can run, the fastest last.
const std::vector<Kernels>& available_kernels();
const Kernels& best_kernels();

}  // namespace sidestep::counting
