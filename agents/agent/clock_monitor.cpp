// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/clock_monitor.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// A smaller setback of this process's clock is not detected; measurements that it spoils soon expire anyway.
constexpr Duration kMinSetback{10'000'000};

}  // namespace

bool ClockMonitor::was_clock_set_back(Time now) const { return now < latest_ - kMinSetback; }

void ClockMonitor::arrived(Time received) {
  if (was_clock_set_back(received)) {
    robot_.reset();
    for (CoordinatorClock& coordinator : coordinators_) coordinator.offset.reset();
    requests_ = {};
  }
  latest_ = received;
}

void ClockMonitor::on_robot_report(const RobotReport& robot_report, Incarnation own, Time received) {
  arrived(received);
  const auto& command = robot_report.command;
  if (robot_report.obeyed_incarnation != own || !command) return;
  if (robot_report.robot_incarnation != robot_incarnation_) {
    robot_incarnation_ = robot_report.robot_incarnation;
    robot_.reset();
  }
  invalid_ += !robot_.add({command->sent_at, command->received_at, robot_report.valid_at, received});
  const auto known = robot_.at(received);
  if (known) robot_offset_ = known->nearest_to_zero();
}

void ClockMonitor::on_request_sent(Time sent) { requests_[request_count_++ % requests_.size()] = sent; }

void ClockMonitor::on_epoch(Epoch epoch) {
  if (epoch == epoch_) return;
  epoch_ = epoch;
  coordinator_.reset();
}

void ClockMonitor::on_verdict(const Verdict& verdict, Time received) {
  arrived(received);
  const Time asked = verdict.request_sent_at;
  if (verdict.epoch != epoch_ || asked == Time{}) return;
  if (std::ranges::find(requests_, asked) == requests_.end()) return;  // not this agent's request, or too old
  // Coordinators have consecutive sender numbers, so each has an element of its own.
  coordinator_ = verdict.sender % coordinators_.size();
  CoordinatorClock& clock = coordinators_[*coordinator_];
  if (clock.sender != verdict.sender || clock.incarnation != verdict.incarnation)
    clock = {verdict.sender, verdict.incarnation, {}};
  invalid_ += !clock.offset.add({asked, verdict.sent_at, verdict.sent_at, received});
}

std::optional<OffsetInterval> ClockMonitor::coordinator_offset(Time now, Duration freshness) const {
  return coordinator_ ? coordinators_[*coordinator_].offset.at(now, freshness) : std::nullopt;
}

std::optional<OffsetInterval> ClockMonitor::robot_coordinator_offset(Time now) const {
  if (was_clock_set_back(now)) return std::nullopt;
  const auto robot = robot_.at(now, kMaxMeasurementAge),
             coordinator = coordinator_offset(now, kMaxMeasurementAge);
  if (!robot || !coordinator) return std::nullopt;
  return difference(*robot, *coordinator);
}

bool ClockMonitor::allows_motion(Time now) const {
  const auto offset = robot_coordinator_offset(now);
  return offset && !offset->is_beyond(bound());
}

double ClockMonitor::max_speed_mps(Time now) const {
  const auto offset = robot_coordinator_offset(now);
  if (!offset) return 0;
  const Duration largest = std::max(offset->high, -offset->low);
  return budget_.max_speed_mps(margin_m_, std::max(0.0, to_seconds(largest)));
}

Duration ClockMonitor::max_lag(Time now) const {
  const auto offset = robot_coordinator_offset(now);
  return offset ? std::max(Duration{0}, -offset->low - bound()) : kMaxMeasurementAge;
}

bool ClockMonitor::is_beyond_bound(Time now) const {
  const auto offset = robot_coordinator_offset(now);
  return offset && offset->is_beyond(bound());
}

bool ClockMonitor::is_measurement_due(Time now) const {
  return was_clock_set_back(now) || !coordinator_offset(now, kMaxMeasurementAge / 2);
}

Duration ClockMonitor::max_robot_offset(Time now) const {
  const auto known = robot_.at(now, kMaxMeasurementAge);
  return known ? known->high : robot_offset_;
}

void ClockMonitor::fill(msg::AgentStatus& status, Time now) const {
  const auto offset = robot_coordinator_offset(now);
  status.clock_offset_s(offset ? to_seconds(offset->middle()) : 0);
  status.clock_uncertainty_s(offset ? to_seconds(offset->uncertainty()) : -1);
  const bool is_active = status.agent_state() == msg::AgentState::AGENT_DRIVING ||
                         status.agent_state() == msg::AgentState::AGENT_WAITING;
  if (is_active && is_beyond_bound(now)) status.agent_state(msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND);
}

}  // namespace sidestep
