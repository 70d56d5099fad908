// SPDX-License-Identifier: Apache-2.0
#include "tests/study/safety/interpenetration.hpp"

#include <algorithm>

namespace sidestep {

void Interpenetration::add(std::span<const Vec2> positions_m, double seconds) {
  const std::size_t count = positions_m.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      const double clearance = (positions_m[i] - positions_m[j]).norm() - 2 * radius_m_;
      const bool touches = clearance < 0;
      min_clearance_m_ = std::min(min_clearance_m_, clearance);
      if (touches) depth_time_m_s_ -= clearance * seconds;
      if (touches && !is_touching_[i * count + j]) ++contacts_;
      is_touching_[i * count + j] = touches;
    }
  }
}

}  // namespace sidestep
