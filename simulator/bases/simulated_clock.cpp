// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/simulated_clock.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr std::size_t kMaxSegments = 17;

Duration scaled(Duration duration, double factor) {
  return Duration{static_cast<Duration::rep>(static_cast<double>(duration.count()) * factor)};
}

}  // namespace

SimulatedClock::SimulatedClock(Time begin, const PaceSettings& pace, std::uint64_t seed)
    : pace_(pace),
      rng_(seed),
      segments_{{begin, begin, pace.speeds.front()}},
      next_speed_at_(pace.speeds.size() > 1 ? begin + pace.speed_duration : Time::max()),
      step_(begin) {
  schedule_step();
}

Time SimulatedClock::Segment::simulated_at(Time now) const { return simulated + scaled(now - clock, speed); }

void SimulatedClock::begin_segment(const Segment& segment) {
  if (segments_.size() == kMaxSegments) segments_.erase(segments_.begin());
  segments_.push_back(segment);
}

void SimulatedClock::begin_due_speeds(Time now) {
  while (next_speed_at_ <= now) {
    const double speed = pace_.speeds[next_speed_++ % pace_.speeds.size()];
    begin_segment({next_speed_at_, segments_.back().simulated_at(next_speed_at_), speed});
    next_speed_at_ += pace_.speed_duration;
  }
}

void SimulatedClock::set_speed(double speed, Time now) {
  begin_due_speeds(now);
  next_speed_at_ = Time::max();
  begin_segment({now, segments_.back().simulated_at(now), speed});
}

void SimulatedClock::resume(Time simulated, Time now) {
  const double speed = segments_.back().speed;
  while (segments_.size() > 1 && segments_.back().simulated > simulated) segments_.pop_back();
  begin_segment({now, simulated, speed});
  step_ = simulated;
  schedule_step();
}

void SimulatedClock::schedule_step() {
  next_step_at_ = step_ + pace_.step + scaled(pace_.max_step_delay, rng_.uniform());
}

Time SimulatedClock::simulated(Time now) {
  begin_due_speeds(now);
  const Time continuous = segments_.back().simulated_at(now);
  if (pace_.step == Duration::zero()) return continuous;
  while (next_step_at_ <= continuous) {
    step_ += pace_.step;
    schedule_step();
  }
  return step_;
}

Time SimulatedClock::clock(Time simulated) const {
  const auto after = std::ranges::upper_bound(segments_, simulated, {}, &Segment::simulated);
  const Segment& segment = after == segments_.begin() ? segments_.front() : *(after - 1);
  return segment.clock + scaled(simulated - segment.simulated, 1 / segment.speed);
}

}  // namespace sidestep
