// SPDX-License-Identifier: Apache-2.0
#include "tests/study/potential/reversal_counter.hpp"

#include <algorithm>

namespace sidestep {

void ReversalCounter::add(const Vec2& position_m) {
  constexpr double kMinMotion_m = 1e-3;
  if (!last_m_) last_m_ = position_m;
  const Vec2 motion = position_m - *last_m_;
  if (motion.norm() < kMinMotion_m) return;
  length_m_ += motion.norm();
  last_m_ = position_m;
  add_heading(std::atan2(motion.y(), motion.x()));
}

void ReversalCounter::add_heading(double heading_rad) {
  if (!heading_rad_) {
    heading_rad_ = min_rad_ = max_rad_ = heading_rad;
    return;
  }
  const double heading = *heading_rad_ + wrapped_rad(heading_rad - *heading_rad_);
  heading_rad_ = heading;
  min_rad_ = std::min(min_rad_, heading);
  max_rad_ = std::max(max_rad_, heading);
  const bool turns_left = turning_ <= 0 && heading > min_rad_ + threshold_rad_,
             turns_right = turning_ >= 0 && heading < max_rad_ - threshold_rad_;
  if (!turns_left && !turns_right) return;
  if (turning_ != 0) ++reversals_;
  turning_ = turns_left ? 1 : -1;
  min_rad_ = max_rad_ = heading;
}

}  // namespace sidestep
