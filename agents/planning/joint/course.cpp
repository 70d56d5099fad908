// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/course.hpp"

#include <algorithm>

#include "agents/planning/joint/leg.hpp"
#include "common/motion/clearance.hpp"

namespace sidestep {

State Course::state_at(Time t) const {
  const auto after = std::ranges::upper_bound(legs_, t, {}, &Trajectory::start);
  return (after == legs_.begin() ? legs_.front() : *(after - 1)).state_at(t);
}

bool is_clear(const Course& course, const Trajectory& motion, Time until, double min_separation_m) {
  const std::span<const Trajectory> legs = course.legs();
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const bool is_last = i + 1 == legs.size();
    const Time begin = i == 0 ? motion.start() : std::max(motion.start(), legs[i].start());
    const Time end = is_last ? until : std::min(until, legs[i + 1].start());
    if (end < begin) continue;
    if (!is_clear(clipped(motion, begin, end), clipped(legs[i], begin, end), min_separation_m)) return false;
  }
  return true;
}

}  // namespace sidestep
