// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/agent/agent.hpp"
#include "common/messaging/bus.hpp"
#include "common/time/histogram.hpp"

namespace sidestep {

/// Connects an agent to the bus and runs its control cycle. Robots' cycles are spread evenly over the cycle
/// time, so that proposals do not all come at once.
class AgentNode {
 public:
  AgentNode(Bus& bus, const Scenario& scenario, RobotId robot, Incarnation incarnation);
  AgentNode(const AgentNode&) = delete;
  AgentNode& operator=(const AgentNode&) = delete;

 private:
  void begin_cycle();
  void on_coordinator_state(const msg::CoordinatorState& state);
  void register_if_due();
  /// Proposes for the next cycle, unless that begins too soon for an answer.
  void negotiate_if_time();
  /// Proposes what to do from a time on.
  void negotiate(Time start);
  /// The begin of the next cycle, or of a later one where the network is slow.
  Time next_start();
  void on_verdict(const msg::Verdict& verdict);
  void publish_status();
  template <typename Message>
  void publish(Writer<Message>& writer, Message& message);

  Bus& bus_;
  RobotId robot_;
  Duration cycle_;
  Agent agent_;
  Time next_cycle_;
  bool commanded_ = false;     // in this cycle
  int registration_wait_ = 0;  // cycles until it registers again
  DurationHistogram negotiation_, plan_, search_;
  Writer<msg::Command> command_writer_;
  Writer<msg::Registration> registration_writer_;
  Writer<msg::Proposal> proposal_writer_;
  Writer<msg::AgentStatus> status_writer_;
};

}  // namespace sidestep
