// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/measured_motion.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// If reports are farther apart than this, the base's motion in between is unknown.
constexpr Duration kMaxInterval = std::chrono::milliseconds(500);

}  // namespace

void MeasuredMotion::add(const OdometryReport& report) {
  if (last_ && report.measured_at <= last_->measured_at) return;
  if (last_ && report.measured_at - last_->measured_at <= kMaxInterval) {
    const double elapsed_s = to_seconds(report.measured_at - last_->measured_at);
    const double turned_rad = wrapped_rad(report.heading_rad - last_->heading_rad);
    const double middle_rad = last_->heading_rad + 0.5 * turned_rad;
    const Vec2 moved_m = report.position_m - last_->position_m;
    intervals_[count_++ % kRemembered] = {
        last_->measured_at,
        report.measured_at,
        {rotated(Vec2(moved_m / elapsed_s), -middle_rad), turned_rad / elapsed_s}};
  }
  last_ = report;
}

std::optional<BodyVelocity> MeasuredMotion::mean(Time from, Time to) const {
  BodyVelocity mean;
  Time until = to;
  for (std::size_t age = 0; age < std::min(count_, kRemembered); ++age) {
    const Interval& interval = intervals_[(count_ - 1 - age) % kRemembered];
    if (interval.to < until) return std::nullopt;
    if (interval.from >= until) continue;
    const Time begin = std::max(interval.from, from);
    const double share = to_seconds(until - begin) / to_seconds(to - from);
    mean.linear_mps += share * interval.velocity.linear_mps;
    mean.turn_radps += share * interval.velocity.turn_radps;
    until = begin;
    if (until == from) return mean;
  }
  return std::nullopt;
}

}  // namespace sidestep
