// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/log/log_event.hpp"
#include "common/messaging/bus.hpp"
#include "common/messaging/counter_publisher.hpp"
#include "coordinator/coordinator.hpp"
#include "coordinator/coordinator_event_logger.hpp"
#include "coordinator/course_relay.hpp"
#include "coordinator/failover.hpp"
#include "coordinator/order_service.hpp"

namespace sidestep {

/// Connects a coordinator to the bus: decodes messages and counts invalid messages, answers proposals and
/// registrations immediately, publishes the ledger every cycle and heartbeats, relays courses, and takes over
/// from other coordinators.
class CoordinatorNode {
 public:
  CoordinatorNode(Bus& bus, const FloorSpec& floor, const CoordinatorIdentity& self, bool is_standby);
  CoordinatorNode(const CoordinatorNode&) = delete;
  CoordinatorNode& operator=(const CoordinatorNode&) = delete;

  /// Sets a callback for events of level `min_level` or higher. It is called immediately with the reason for
  /// this coordinator's role.
  void on_event(LogLevel min_level, OnLogEvent callback);

  const Coordinator& coordinator() const { return coordinator_; }
  const OrderKeeper& orders() const { return order_service_.orders(); }
  void count_drops(DropCounters& drops) const;

 private:
  /// Handles a decoded message; counts it if decoding failed.
  template <typename Decoded>
  void handle_or_count(const std::optional<Decoded>& decoded, DropReason reason,
                       std::optional<RobotId> robot = {});
  void handle(const CoordinatorHeartbeat& heartbeat);
  void handle(const Registration& registration);
  void handle(const RobotReport& robot_report);
  void handle(const Proposal& proposal);
  void on_world_state(const msg::WorldState& message);
  void on_attestation(const msg::AbsenceAttestation& message);
  void handle(const OrderPage& page);
  void handle(const OrderReport& report);
  /// Reports the epoch in which this coordinator is active, or that it is a standby, and why.
  void report_role();
  void report_registration(const Registration& registration, const Verdict& verdict) const;
  /// Records the epoch that a robot or its agent obeys.
  void observe_epoch(RobotId robot, Epoch epoch, EpochHolder holder);
  void answer(const Verdict& verdict);
  /// Adopts the epoch of failover_, which may be 0 (standby), and publishes the new state.
  void apply_epoch();
  void update_failover();
  /// Call when this process's clock was set back: discards all recorded times.
  void forget_times();
  void publish_state();
  void publish_state_periodically();
  void publish_ledger();

  Bus& bus_;
  const CoordinatorIdentity self_;
  Duration cycle_;
  Duration max_clock_difference_;
  Failover failover_;
  Coordinator coordinator_;
  Writer<msg::CoordinatorState> state_writer_;
  Writer<msg::LedgerPage> ledger_writer_;
  std::map<RobotId, Writer<msg::Verdict>> verdict_writers_;
  EventReporter events_;
  OrderService order_service_;
  CourseRelay course_relay_;
  CoordinatorEventLogger event_logger_{events_};
  std::map<RobotId, Time> heard_at_;            // arrival time of each robot's last fact
  Time updated_at_{};                           // when update_failover() last ran
  std::vector<RobotObservation> observations_;  // observations of the last world state
  int standby_periods_ = 0;                     // number of heartbeat periods spent as a standby
  DropCounters drops_;                          // messages that this node has not used
  CounterPublisher counters_;
};

}  // namespace sidestep
