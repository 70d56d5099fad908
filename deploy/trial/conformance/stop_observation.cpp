// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/stop_observation.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace sidestep {
namespace {

using namespace std::chrono_literals;

// A robot may move for this long after it should rest.
constexpr Duration kTimeToSettle = 400ms;
// Then vision observes it for the first time at least, and for the second at most if it sees the robot
// rarely: slow cameras need longer, and so does a busy computer.
constexpr Duration kTimeAtRest = 300ms, kVisionTimeout = 3s;
constexpr int kRestObservations = 3;
// An overshoot that the robot corrects within this time may be missed.
constexpr Duration kMaxUnseen = 500ms;

}  // namespace

Time StopObservation::rests_from() const { return stop().end() + kTimeToSettle; }

void StopObservation::add(const MotionSample& sample) {
  executed_ = sample.executed;
  overshoot_m_ = std::max(overshoot_m_, sample.seen_m.x() - stop().rest_position_m().x());
  if (sample.robot_at < stop().start()) return;
  longest_gap_ = std::max(longest_gap_, sample.robot_at - seen_at_);
  seen_at_ = sample.robot_at;
  if (sample.robot_at < rests_from()) return;
  rest_sum_m_ += sample.seen_m;
  ++rest_count_;
}

bool StopObservation::is_over(Time robot_now) const {
  if (robot_now < rests_from() + kTimeAtRest) return false;
  return rest_count_ >= kRestObservations || robot_now >= rests_from() + kVisionTimeout;
}

std::optional<std::string> StopObservation::why_not_judged() const {
  if (rest_count_ < kRestObservations)
    return fmt::format("vision saw the robot {} times in {:g} s at rest, fewer than {} times", rest_count_,
                       to_seconds(kVisionTimeout), kRestObservations);
  if (longest_gap_ > kMaxUnseen)
    return fmt::format("vision did not see the robot for {:.0f} ms while it stopped",
                       to_seconds(longest_gap_) * 1e3);
  // A higher number would be that of the robot's own stop, which is judged.
  if (executed_ < last_.number)
    return "the robot did not execute the last version, which arrived too late or not at all";
  return std::nullopt;
}

double StopObservation::rest_error_m() const {
  return (rest_sum_m_ / rest_count_ - stop().rest_position_m()).norm();
}

}  // namespace sidestep
