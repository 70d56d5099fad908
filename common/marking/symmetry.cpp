// SPDX-License-Identifier: Apache-2.0
#include "common/marking/symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sidestep {
namespace {

/// The permutation of the dots under a rotation; empty if the rotation does not map every dot to a dot.
std::vector<std::size_t> permutation_of(const MarkerLayout& layout, double angle_rad) {
  std::vector<std::size_t> permutation;
  for (const Marker& dot : layout.dots) {
    const Vec2 image_m =
        layout.centre.position_m + rotated(dot.position_m - layout.centre.position_m, angle_rad);
    for (std::size_t j = 0; j < layout.dots.size(); ++j) {
      const Marker& other = layout.dots[j];
      if ((other.position_m - image_m).norm() > kSamePosition_m) continue;
      if (std::abs(other.radius_m - dot.radius_m) > kSamePosition_m) continue;
      permutation.push_back(j);
      break;
    }
  }
  return permutation.size() == layout.dots.size() ? permutation : std::vector<std::size_t>{};
}

}  // namespace

std::vector<RotationalSymmetry> rotational_symmetries(const MarkerLayout& layout) {
  std::vector<RotationalSymmetry> symmetries;
  if (layout.dots.empty()) return symmetries;
  const auto angle = [&](const Marker& dot) {
    const Vec2 p = dot.position_m - layout.centre.position_m;
    return std::atan2(p.y(), p.x());
  };
  for (const Marker& dot : layout.dots) {
    const double angle_rad = &dot == &layout.dots[0] ? 0 : angle(dot) - angle(layout.dots[0]);
    auto permutation = permutation_of(layout, angle_rad);
    if (!permutation.empty())
      symmetries.push_back(
          {angle_rad < 0 ? angle_rad + 2 * std::numbers::pi : angle_rad, std::move(permutation)});
  }
  std::sort(
      symmetries.begin(), symmetries.end(),
      [](const RotationalSymmetry& a, const RotationalSymmetry& b) { return a.angle_rad < b.angle_rad; });
  return symmetries;
}

std::size_t hamming_distance(const std::vector<Colour>& pattern, const std::vector<Colour>& rotated,
                             const RotationalSymmetry& symmetry) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < symmetry.permutation.size(); ++i)
    count += pattern[symmetry.permutation[i]] != rotated[i];
  return count;
}

}  // namespace sidestep
