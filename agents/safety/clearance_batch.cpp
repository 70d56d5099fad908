// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/clearance_batch.hpp"

#include <algorithm>
#include <bit>

#include "common/motion/clearance.hpp"

namespace sidestep {

void ClearanceBatch::restart(Time base) {
  lanes_.restart(base);
  others_.clear();
}

void ClearanceBatch::add(const TrajectoryBounds& outline, const Trajectory& trajectory, double min_separation_m) {
  lanes_.add(outline, min_separation_m);
  others_.push_back({&trajectory, min_separation_m});
}

bool ClearanceBatch::exact(const Trajectory& one, const Other& other) {
  ++left_to_exact_;
  return is_clear(one, *other.trajectory, other.min_separation_m);
}

std::span<const std::uint8_t> ClearanceBatch::compare(const Trajectory& one) {
  clear_.resize(others_.size());
  const TrajectoryBounds outline = trajectory_bounds(one);
  if (!outline.is_plain || outline.seconds > batch::kLongest_s) {
    for (std::size_t i = 0; i < others_.size(); ++i) clear_[i] = exact(one, others_[i]);
    return clear_;
  }
  lanes_.sample(one.start(), outline.seconds);
  lanes_.compare(batch::track_of(outline, one.start(), lanes_.step_s()), outline.acceleration_mps2, 0);
  for (std::size_t i = 0; i < others_.size(); i += batch::kLanes) {
    const std::size_t count = std::min(batch::kLanes, others_.size() - i);
    const unsigned clear = lanes_.clear_bits(i / batch::kLanes);
    for (std::size_t lane = 0; lane < count; ++lane) clear_[i + lane] = clear >> lane & 1;
    unsigned open = lanes_.open_bits(i / batch::kLanes) & (0xffu >> (batch::kLanes - count));
    for (; open != 0; open &= open - 1) {
      const std::size_t lane = i + static_cast<std::size_t>(std::countr_zero(open));
      clear_[lane] = exact(one, others_[lane]);
    }
  }
  return clear_;
}

}  // namespace sidestep
