// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/commanded_motion.hpp"

#include <algorithm>

namespace sidestep {

void CommandedMotion::add(Time at, const BodyVelocity& velocity) {
  sent_[count_++ % kRemembered] = {at, velocity};
}

BodyVelocity CommandedMotion::latest() const { return count_ == 0 ? BodyVelocity{} : back(0).velocity; }

Time CommandedMotion::next_change(Time time, Time latest) const {
  Time next = latest;
  for (std::size_t age = 0; age < std::min(count_, kRemembered); ++age) {
    const Time obeyed = back(age).at + latency_;
    if (obeyed <= time) break;
    next = std::min(next, obeyed);
  }
  return next;
}

BodyVelocity CommandedMotion::mean(Time from, Time to) const {
  const Time begin = from - latency_, end = to - latency_;
  BodyVelocity mean;
  Time until = end;
  for (std::size_t age = 0; age < std::min(count_, kRemembered) && until > begin; ++age) {
    const SentVelocity& sent = back(age);
    if (sent.at >= until) continue;
    const double share = to_seconds(until - std::max(sent.at, begin)) / to_seconds(end - begin);
    mean.linear_mps += share * sent.velocity.linear_mps;
    mean.turn_radps += share * sent.velocity.turn_radps;
    until = sent.at;
  }
  return mean;
}

}  // namespace sidestep
