// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/clock_watch.hpp"

#include <algorithm>

namespace sidestep {

void ClockWatch::on_feedback(const msg::Feedback& feedback, Incarnation own, Time received) {
  if (feedback.robot() != robot_id_ || feedback.obeyed_incarnation() != own) return;
  if (feedback.heard_stamp_ns() == 0) return;  // it has not heard any
  if (feedback.head().incarnation() != robot_life_) {
    robot_life_ = feedback.head().incarnation();
    robot_.reset();
  }
  const bool is_sound =
      robot_.add({time_from_ns(feedback.heard_stamp_ns()), time_from_ns(feedback.heard_at_ns()),
                  time_from_ns(feedback.at_ns()), received});
  invalid_ += !is_sound;
  if (const auto known = robot_.at(received)) robot_ahead_ = known->nearest_to_zero();
}

void ClockWatch::on_asked(Time sent) { asked_[asked_count_++ % asked_.size()] = sent; }

void ClockWatch::on_epoch(Epoch epoch) {
  if (epoch == epoch_) return;
  epoch_ = epoch;
  coordinator_.reset();
}

void ClockWatch::on_verdict(const msg::Verdict& verdict, Time received) {
  if (verdict.robot() != robot_id_ || verdict.epoch() != epoch_ || verdict.asked_stamp_ns() == 0) return;
  const Time asked = time_from_ns(verdict.asked_stamp_ns());
  if (std::ranges::find(asked_, asked) == asked_.end()) return;  // another agent's, or long ago
  const Time stamped = time_from_ns(verdict.head().stamp_ns());
  invalid_ += !coordinator_.add({asked, stamped, stamped, received});
}

std::optional<OffsetInterval> ClockWatch::robot_to_coordinator(Time now) const {
  const auto robot = robot_.at(now, kFresh), coordinator = coordinator_.at(now, kFresh);
  if (!robot || !coordinator) return std::nullopt;
  return difference(*robot, *coordinator);
}

bool ClockWatch::allows_motion(Time now) const {
  const auto offset = robot_to_coordinator(now);
  return offset && !offset->is_beyond(bound_);
}

bool ClockWatch::is_beyond_bound(Time now) const {
  const auto offset = robot_to_coordinator(now);
  return offset && offset->is_beyond(bound_);
}

bool ClockWatch::is_measurement_due(Time now) const { return !coordinator_.at(now, kFresh / 2); }

Duration ClockWatch::robot_ahead_at_most(Time now) const {
  const auto known = robot_.at(now, kFresh);
  return known ? known->high : robot_ahead_;
}

void ClockWatch::fill(msg::AgentStatus& status, Time now) const {
  const auto offset = robot_to_coordinator(now);
  status.clock_offset_s(offset ? to_seconds(offset->middle()) : 0);
  status.clock_uncertainty_s(offset ? to_seconds(offset->uncertainty()) : -1);
  status.invalid(status.invalid() + invalid_);
  const bool is_on_its_way =
      status.agent_state() == msg::AGENT_DRIVING || status.agent_state() == msg::AGENT_WAITING;
  if (is_on_its_way && is_beyond_bound(now)) status.agent_state(msg::AGENT_OFF_CLOCK);
}

}  // namespace sidestep
