// SPDX-License-Identifier: Apache-2.0
// The kernels, compiled once per instruction set: SIDESTEP_INSTRUCTION_SET is its name and SIDESTEP_KERNELS
// the name of the kernels. Branch-free loops over all samples of a pixel, which the compiler vectorises.
#include "simulator/rendering/coverage/kernel_tables.hpp"

namespace sidestep::coverage {
namespace {

int count_in_disc(const PixelSamples& samples, float x, float y, float radius) {
  const Points& offsets = *samples.offsets;
  const float square = radius * radius, centre_x = samples.x - x, centre_y = samples.y - y;
  int count = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const float dx = offsets.x[i] + centre_x, dy = offsets.y[i] + centre_y;
    count += dx * dx + dy * dy <= square ? 1 : 0;
  }
  return count;
}

int count_in_cross_section(const PixelSamples& samples, const CrossSection& section) {
  const Points& offsets = *samples.offsets;
  const float square = section.radius * section.radius, front = section.front;
  int count = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const float x = offsets.x[i] + samples.x, y = offsets.y[i] + samples.y;
    count += static_cast<int>(x * x + y * y <= square) & static_cast<int>(x <= front);
  }
  return count;
}

int count_rays_hitting(const Points& still_offsets, const PixelSamples& samples, const ViewingRays& rays,
                       const CrossSection& section) {
  const float square = section.radius * section.radius, front = section.front;
  const Points& offsets = *samples.offsets;
  const float parallax = rays.parallax;
  const float from_nadir_x = samples.x - rays.nadir_x, from_nadir_y = samples.y - rays.nadir_y;
  int count = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    // The small constant ensures that no ray has zero length or is parallel to the front.
    const float dx = parallax * (still_offsets.x[i] + from_nadir_x) + 1e-9F;
    const float dy = parallax * (still_offsets.y[i] + from_nadir_y);
    const float start_x = offsets.x[i] + samples.x, start_y = offsets.y[i] + samples.y;
    // Clips the ray to the part behind the front and finds the point on it nearest to the disc's centre.
    const float to_front = front - start_x, at_front = to_front / dx;
    const float from = to_front < 0 ? at_front : 0.0F;
    const float to = to_front - dx < 0 ? at_front : 1.0F;
    float nearest = -(start_x * dx + start_y * dy) / (dx * dx + dy * dy);
    nearest = nearest < from ? from : nearest;
    nearest = nearest > to ? to : nearest;
    const float x = start_x + nearest * dx, y = start_y + nearest * dy;
    const int is_behind_front = static_cast<int>(to_front >= 0) | static_cast<int>(to_front - dx >= 0);
    count += is_behind_front & static_cast<int>(x * x + y * y <= square);
  }
  return count;
}

}  // namespace

const Kernels SIDESTEP_KERNELS{SIDESTEP_INSTRUCTION_SET, count_in_disc, count_in_cross_section,
                               count_rays_hitting};

}  // namespace sidestep::coverage
