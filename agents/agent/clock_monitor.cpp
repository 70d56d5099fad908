// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/clock_monitor.hpp"

#include <algorithm>

namespace sidestep {

void ClockMonitor::on_feedback(const msg::Feedback& feedback, Incarnation own, Time received) {
  if (feedback.robot() != robot_id_ || feedback.obeyed_incarnation() != own) return;
  if (feedback.command_stamp_ns() == 0) return;  // no command received yet
  if (feedback.header().incarnation() != robot_incarnation_) {
    robot_incarnation_ = feedback.header().incarnation();
    robot_.reset();
  }
  const bool is_consistent =
      robot_.add({time_from_ns(feedback.command_stamp_ns()), time_from_ns(feedback.command_received_at_ns()),
                  time_from_ns(feedback.valid_at_ns()), received});
  invalid_ += !is_consistent;
  if (const auto known = robot_.at(received)) robot_offset_ = known->nearest_to_zero();
}

void ClockMonitor::on_request_sent(Time sent) { requests_[request_count_++ % requests_.size()] = sent; }

void ClockMonitor::on_epoch(Epoch epoch) {
  if (epoch == epoch_) return;
  epoch_ = epoch;
  coordinator_.reset();
}

void ClockMonitor::on_verdict(const msg::Verdict& verdict, Time received) {
  if (verdict.robot() != robot_id_ || verdict.epoch() != epoch_ || verdict.request_stamp_ns() == 0) return;
  const Time sent = time_from_ns(verdict.request_stamp_ns());
  if (std::ranges::find(requests_, sent) == requests_.end()) return;  // another agent's request, or too old
  const Time stamped = time_from_ns(verdict.header().stamp_ns());
  invalid_ += !coordinator_.add({sent, stamped, stamped, received});
}

std::optional<OffsetInterval> ClockMonitor::robot_coordinator_offset(Time now) const {
  const auto robot = robot_.at(now, kMaxMeasurementAge),
             coordinator = coordinator_.at(now, kMaxMeasurementAge);
  if (!robot || !coordinator) return std::nullopt;
  return difference(*robot, *coordinator);
}

bool ClockMonitor::allows_motion(Time now) const {
  const auto offset = robot_coordinator_offset(now);
  return offset && !offset->is_beyond(bound_);
}

bool ClockMonitor::is_beyond_bound(Time now) const {
  const auto offset = robot_coordinator_offset(now);
  return offset && offset->is_beyond(bound_);
}

bool ClockMonitor::is_measurement_due(Time now) const {
  return !coordinator_.at(now, kMaxMeasurementAge / 2);
}

Duration ClockMonitor::max_robot_offset(Time now) const {
  const auto known = robot_.at(now, kMaxMeasurementAge);
  return known ? known->high : robot_offset_;
}

void ClockMonitor::fill(msg::AgentStatus& status, Time now) const {
  const auto offset = robot_coordinator_offset(now);
  status.clock_offset_s(offset ? to_seconds(offset->middle()) : 0);
  status.clock_uncertainty_s(offset ? to_seconds(offset->uncertainty()) : -1);
  status.invalid(status.invalid() + invalid_);
  const bool is_active =
      status.agent_state() == msg::AGENT_DRIVING || status.agent_state() == msg::AGENT_WAITING;
  if (is_active && is_beyond_bound(now)) status.agent_state(msg::AGENT_CLOCK_OUT_OF_BOUND);
}

}  // namespace sidestep
