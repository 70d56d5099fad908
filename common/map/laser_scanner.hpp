// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/map/laser_settings.hpp"
#include "common/map/ray_cast.hpp"

namespace sidestep {

/// A planar laser scanner: the distances along beams at equal angles, counter-clockwise. The first and the
/// last beam are at the borders of the field of view. With a full turn, the last beam is left out, because it
/// would equal the first. A single beam points along the heading.
class LaserScanner {
 public:
  /// Throws std::invalid_argument if a setting is out of range or not finite.
  explicit LaserScanner(const LaserSettings& settings);

  const LaserSettings& settings() const { return settings_; }
  /// The angle of a beam relative to the heading.
  double beam_angle_rad(int beam) const { return first_rad_ + beam * spacing_rad_; }

  /// Writes one range per beam: the distance to the first hit, +infinity if there is none up to the maximum
  /// range, -infinity if it is nearer than the minimum range (as in ROS's REP 117). Does not allocate. Throws
  /// std::invalid_argument if a number is not finite, a radius is negative, or the number of ranges differs
  /// from the number of beams.
  void scan(const RayScene& scene, const Vec2& at_m, double heading_rad, std::span<float> ranges_m) const;

 private:
  /// Position and orientation during a scan.
  struct View;

  Vec2 direction(const View& view, int beam) const;
  void scan_shape(const Shape& shape, const View& view, std::span<float> ranges_m) const;
  template <typename Call>
  void for_beams(double middle_rad, double half_width_rad, const Call& call) const;

  LaserSettings settings_;
  double first_rad_, spacing_rad_;
  std::vector<Vec2> directions_;  // indexed by beam; directions relative to the heading
};

}  // namespace sidestep
