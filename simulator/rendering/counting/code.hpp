// SPDX-License-Identifier: Apache-2.0
// The kernels, compiled for each instruction set: SIDESTEP_LEVEL is its name, SIDESTEP_KERNELS what they are
// called. Loops over all points of a pixel, without branches, that the compiler turns into vectors.
#include "simulator/rendering/counting/levels.hpp"

namespace sidestep::counting {
namespace {

int in_disc(const Pixel& pixel, float x, float y, float radius) {
  const Points& about = *pixel.about;
  const float square = radius * radius, off_x = pixel.x - x, off_y = pixel.y - y;
  int count = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const float dx = about.x[i] + off_x, dy = about.y[i] + off_y;
    count += dx * dx + dy * dy <= square ? 1 : 0;
  }
  return count;
}

int in_outline(const Pixel& pixel, const TrajectoryBounds& outline) {
  const Points& about = *pixel.about;
  const float square = outline.radius * outline.radius, front = outline.front;
  int count = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const float x = about.x[i] + pixel.x, y = about.y[i] + pixel.y;
    count += static_cast<int>(x * x + y * y <= square) & static_cast<int>(x <= front);
  }
  return count;
}

int on_lines(const Points& plain, const Pixel& pixel, const Lines& lines, const TrajectoryBounds& outline) {
  const float square = outline.radius * outline.radius, front = outline.front;
  const Points& about = *pixel.about;
  const float lean = lines.lean, from_foot_x = pixel.x - lines.foot_x, from_foot_y = pixel.y - lines.foot_y;
  int count = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    // No line is without length or along the front.
    const float dx = lean * (plain.x[i] + from_foot_x) + 1e-9F, dy = lean * (plain.y[i] + from_foot_y);
    const float start_x = about.x[i] + pixel.x, start_y = about.y[i] + pixel.y;
    // The part of the line behind the front, and the point of it that is nearest to the disc's centre.
    const float room = front - start_x, at_front = room / dx;
    const float from = room < 0 ? at_front : 0.0F;
    const float to = room - dx < 0 ? at_front : 1.0F;
    float nearest = -(start_x * dx + start_y * dy) / (dx * dx + dy * dy);
    nearest = nearest < from ? from : nearest;
    nearest = nearest > to ? to : nearest;
    const float x = start_x + nearest * dx, y = start_y + nearest * dy;
    const int is_behind_front = static_cast<int>(room >= 0) | static_cast<int>(room - dx >= 0);
    count += is_behind_front & static_cast<int>(x * x + y * y <= square);
  }
  return count;
}

}  // namespace

const Kernels SIDESTEP_KERNELS{SIDESTEP_LEVEL, in_disc, in_outline, on_lines};

}  // namespace sidestep::counting
