// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace sidestep {

/// Measures the interpenetration of discs of one size: depth integrated over time (Bruce 2006, chapter 5).
class Interpenetration {
 public:
  Interpenetration(std::size_t robots, double radius_m)
      : radius_m_(radius_m), is_touching_(robots * robots) {}

  /// Adds the robots' positions, assumed constant for `seconds`.
  void add(std::span<const Vec2> positions_m, double seconds);

  double depth_time_m_s() const { return depth_time_m_s_; }
  std::uint64_t contacts() const { return contacts_; }  ///< Number of times that a pair began to touch.
  double min_clearance_m() const { return min_clearance_m_; }

 private:
  double radius_m_;
  std::vector<bool> is_touching_;  // indexed by pair
  double depth_time_m_s_ = 0;
  std::uint64_t contacts_ = 0;
  double min_clearance_m_ = 1;
};

}  // namespace sidestep
