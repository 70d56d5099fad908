// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/agent/agent.hpp"
#include "agents/agent/clock_watch.hpp"
#include "common/messaging/bus.hpp"
#include "common/time/histogram.hpp"

namespace sidestep {

/// Connects an agent to the bus and runs its control cycle. Robots' cycles are spread evenly over the cycle
/// time, so that proposals do not all come at once. Versions begin and end by the robot's clock, so the agent
/// lives by that, as far as it is known to differ from the bus's.
class AgentNode {
 public:
  AgentNode(Bus& bus, const Scenario& scenario, RobotId robot, Incarnation incarnation,
            std::shared_ptr<PlanningScratch> bench);
  AgentNode(const AgentNode&) = delete;
  AgentNode& operator=(const AgentNode&) = delete;

  /// Calls back once when a later agent of the robot is found to drive it: from then on this one is quiet.
  void on_superseded(std::function<void()> callback) { on_superseded_ = std::move(callback); }

 private:
  void begin_cycle();
  void on_coordinator_state(const msg::CoordinatorState& state);
  void register_if_due();
  void publish_registration();
  /// Whether the clocks allow to propose; sees to it that they are measured.
  bool clocks_agree();
  void measure_robot_clock(const msg::Feedback& feedback);
  Time robot_now() const;
  /// The first begin of a cycle of this robot's after a time.
  Time cycle_after(Time now) const;
  void begin_next_cycle_later();
  /// Proposes for the next cycle, unless that begins too soon for an answer.
  void negotiate_if_time();
  /// Proposes what to do from a time on.
  void negotiate(Time start);
  void ask(msg::Proposal& proposal);
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
  ClockWatch clocks_;
  std::function<void()> on_superseded_;
  Time next_cycle_;            // by the robot's clock, as all times that the agent gets
  bool commanded_ = false;     // in this cycle
  int registration_wait_ = 0;  // cycles until it registers again
  int measurement_wait_ = 0;   // cycles until it asks for another measurement
  DurationHistogram negotiation_, plan_, search_;
  Writer<msg::Command> command_writer_;
  Writer<msg::Registration> registration_writer_;
  Writer<msg::Proposal> proposal_writer_;
  Writer<msg::AgentStatus> status_writer_;
};

}  // namespace sidestep
