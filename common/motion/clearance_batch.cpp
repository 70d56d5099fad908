// SPDX-License-Identifier: Apache-2.0
#include "common/motion/clearance_batch.hpp"

#include <algorithm>

#include "common/motion/clearance.hpp"

namespace sidestep {

bool ClearanceBatch::exact(const Trajectory& one, const Other& other) {
  ++left_to_exact_;
  return is_clear(one, *other.trajectory, other.keep_m);
}

std::span<const std::uint8_t> ClearanceBatch::compare(const Trajectory& one) {
  const Outline outline = outline_of(one);
  const bool is_plain = outline.is_plain && outline.seconds <= batch::kLongest_s;
  clear_.resize(others_.size());
  plain_.clear();
  lanes_.clear();
  for (std::size_t i = 0; i < others_.size(); ++i) {
    const Other& other = others_[i];
    const double rest_s = to_seconds(other.outline->start - one.start()) + other.outline->seconds;
    if (is_plain && other.outline->is_plain && rest_s <= batch::kLongest_s) {
      plain_.push_back(i);
      lanes_.add(*other.outline, other.keep_m, one.start());
    } else {
      clear_[i] = exact(one, other);
    }
  }
  if (plain_.empty()) return clear_;
  self_.clear();
  self_.add(outline, 0, one.start());
  const double step_s = std::max(lanes_.seconds(), outline.seconds) / batch::kSteps;
  self_.sample(*kernels_, step_s);
  lanes_.sample(*kernels_, step_s);
  lanes_.compare(*kernels_, self_.track(0), outline.acceleration_mps2, 0);
  for (std::size_t lane = 0; lane < plain_.size(); ++lane) {
    const Other& other = others_[plain_[lane]];
    clear_[plain_[lane]] = lanes_.is_clear(lane) || (!lanes_.is_blocked(lane) && exact(one, other));
  }
  return clear_;
}

}  // namespace sidestep
