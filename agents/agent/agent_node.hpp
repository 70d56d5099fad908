// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/agent/agent.hpp"
#include "agents/agent/agent_event_logger.hpp"
#include "agents/agent/clock_monitor.hpp"
#include "agents/agent/laser_scan_decoder.hpp"
#include "agents/agent/obstacle_list_decoder.hpp"
#include "agents/agent/order_publisher.hpp"
#include "agents/agent/world_state_decoder.hpp"
#include "common/log/log_event.hpp"
#include "common/messaging/bus.hpp"
#include "common/messaging/counter_publisher.hpp"
#include "common/time/histogram.hpp"

namespace sidestep {

/// Connects an agent to the bus and runs its control cycle. Decodes and checks every message once, and counts
/// invalid messages. The cycles of all robots are spread evenly over the cycle time, so that their proposals
/// do not coincide. Versions start and end by the robot's clock, so the agent uses the robot's time: the
/// bus's time plus the measured offset.
class AgentNode {
 public:
  AgentNode(Bus& bus, const FloorSpec& floor, RobotId robot, Incarnation incarnation,
            std::shared_ptr<PlanningScratch> scratch);
  AgentNode(const AgentNode&) = delete;
  AgentNode& operator=(const AgentNode&) = delete;

  /// Sets a callback for events of level `min_level` or higher.
  void on_event(LogLevel min_level, OnLogEvent callback) {
    events_.set_listener(min_level, std::move(callback));
  }
  void count_drops(DropCounters& drops) const;
  /// Whether this agent must keep its own clock after the host's clock has been set. It must if it can drive
  /// its robot by its own clock, or if a restart would make it a later agent than the agent that its robot
  /// obeys.
  bool uses_clock() const {
    return agent_.is_superseded() || clocks_.robot_coordinator_offset(bus_.now()).has_value();
  }
  /// Proposes no more versions, so the robot brakes along the version that it has. Returns whether the robot
  /// rests, or has had twice the time that it needs.
  [[nodiscard]] bool come_to_rest();
  /// Whether the robot is known to stay at rest without this agent.
  bool is_at_rest() const { return agent_.is_at_rest(robot_now()); }

 private:
  void subscribe();
  void on_robot_report(const msg::Feedback& message);
  void on_verdict(const msg::Verdict& message);
  void on_world_state(const msg::WorldState& message);
  void on_obstacles(const msg::ObstacleList& message);
  void on_scan(const msg::LaserScan& message);
  void on_page(const msg::LedgerPage& message);
  void on_coordinator_state(const msg::CoordinatorState& message);
  void on_disturbance(const msg::Disturbance& message);
  void on_orders(const msg::OrderMemory& message);
  void on_course(const msg::Course& message);
  void on_course_offer(const msg::CourseOffer& message);
  /// The decoded message, which all agents in this process share; null if it is invalid.
  template <typename Decoded, typename Message>
  std::shared_ptr<const Decoded> decode_shared(const Message& message);
  /// Whether a message could be decoded. Counts messages that could not.
  template <typename Value>
  bool accept(const std::optional<Value>& decoded, DropReason reason) {
    if (!decoded) drops_.count(reason);
    return decoded.has_value();
  }
  void begin_cycle();
  void register_if_due();
  /// Registers again, because the coordinator's answer measures its clock. Does nothing if the last
  /// registration is less than `since_last` ago.
  void measure_coordinator_clock(Duration since_last);
  /// Requests a measurement of the clocks if one is due. Returns whether the clocks allow proposals.
  bool update_clocks();
  void measure_robot_clock(const RobotReport& robot_report);
  /// The speed that the clocks allow, but at most the robot's limit.
  double speed_limit_mps() const;
  void report_changes();
  Time robot_now() const;
  /// Whether `period` has passed since `since`, by this process's clock.
  bool has_elapsed(Duration period, Time since) const;
  /// The start of this robot's first cycle after `now`.
  Time cycle_after(Time now) const;
  void schedule_next_cycle();
  /// Proposes a version with the earliest possible start, unless the next cycle begins before an answer can
  /// arrive.
  void negotiate_if_time();
  /// Proposes a version that starts at `start`.
  void negotiate(Time start);
  void publish_command(const Command& command);
  void publish(const Registration& registration);
  void publish_proposal(const Proposal& proposal);
  void publish_status();
  /// Plans the robot's course and courses for others, and publishes them. Takes milliseconds.
  void plan_courses();
  /// Publishes the robot's course if it has changed or was not published for a while, and new offers.
  void publish_courses();

  Bus& bus_;
  RobotId robot_;
  Duration cycle_;
  double max_speed_mps_;  // speed limit of the scenario's robots
  Duration max_stopping_time_;
  std::optional<Time> stopping_since_;  // by this process's clock
  Agent agent_;
  ClockMonitor clocks_;
  WorldStateDecoder world_;
  ObstacleListDecoder obstacles_;
  std::optional<LaserScanDecoder> scans_;  // nullopt: the robot has no laser
  DropCounters drops_;                     // messages that could not be decoded
  EventReporter events_;
  AgentEventLogger event_logger_;
  Time next_cycle_;               // by the robot's clock, like all times that are passed to the agent
  bool commanded_ = false;        // a command has been published in this cycle
  bool are_courses_due_ = false;  // once the verdict of the proposal has arrived
  Duration planning_{};           // time that planning has taken in this cycle
  int registration_wait_ = 0;     // number of cycles until the next registration
  /// The course that was published last: when it was planned, its start, and when it was published.
  std::optional<Time> published_plan_{Time{}};  // an agent says first that it has none, or which
  Time published_start_{}, course_published_at_{};
  Time measured_at_{};  // time of the latest request for a clock measurement
  DurationHistogram negotiation_durations_, plan_durations_, search_durations_;
  Writer<msg::Command> command_writer_;
  Writer<msg::Registration> registration_writer_;
  Writer<msg::Proposal> proposal_writer_;
  Writer<msg::AgentStatus> status_writer_;
  Writer<msg::Course> course_writer_;
  Writer<msg::CourseOffer> offer_writer_;
  OrderPublisher orders_;
  CounterPublisher counters_;
};

}  // namespace sidestep
