// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/segment.hpp"
#include "tests/unit/agents/perception/scene.hpp"

namespace sidestep::test {

/// Slow reference: checks every beam to decide which discs a laser does not see.
class HiddenPeople {
 public:
  /// The ranges of the scan must have no error; they are NaN for dropouts.
  HiddenPeople(const LaserScan& scan, const LaserSettings& laser) : at_m_(scan.at_m) {
    const LaserScanner scanner(laser);
    for (int beam = 0; beam < laser.beams; ++beam) {
      const double range_m = static_cast<double>(scan.ranges_m[static_cast<std::size_t>(beam)]);
      if (!(range_m >= 0)) continue;
      const double angle_rad = scan.heading_rad + scanner.beam_angle_rad(beam);
      ends_m_.push_back(scan.at_m + std::min(range_m, laser.max_range_m) *
                                        Vec2(std::cos(angle_rad), std::sin(angle_rad)));
    }
  }

  bool is_hidden(const Circle& person) const {
    for (const Vec2& end : ends_m_)
      if (squared_distance(person.centre_m, Segment{at_m_, end}) < person.radius_m * person.radius_m)
        return false;
    return true;
  }

  /// Moves a hidden person towards a point until it is barely hidden. `is_possible(person)`: whether the
  /// person can be there.
  template <typename IsPossible>
  Circle approached(Circle person, const Vec2& to, const IsPossible& is_possible) const {
    Vec2 hidden = person.centre_m, seen = to;
    for (int i = 0; i < 25; ++i) {
      person.centre_m = (hidden + seen) / 2;
      (is_hidden(person) && is_possible(person) ? hidden : seen) = person.centre_m;
    }
    person.centre_m = hidden;
    return person;
  }

 private:
  Vec2 at_m_;
  std::vector<Vec2> ends_m_;
};

/// A random laser, often with few beams or a narrow field of view.
inline LaserSettings random_laser(Rng& rng) {
  LaserSettings laser;
  laser.beams = rng.chance(0.5) ? 540 : 5 + static_cast<int>(rng.below(300));
  if (rng.chance(0.3)) laser.field_of_view_rad = rng.uniform(0.5, 6.2);
  laser.max_range_m = rng.uniform(2, 8);
  return laser;
}

/// Adds random errors to true ranges.
inline std::vector<float> with_errors(std::span<const float> ranges_m, double largest_m, Rng& rng) {
  std::vector<float> result(ranges_m.begin(), ranges_m.end());
  for (float& range_m : result)
    if (std::isfinite(range_m)) range_m += static_cast<float>(rng.uniform(-largest_m, largest_m));
  return result;
}

}  // namespace sidestep::test
