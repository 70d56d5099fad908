// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "common/messaging/bus.hpp"
#include "coordinator/coordinator.hpp"
#include "coordinator/failover.hpp"

namespace sidestep {

/// Connects a coordinator to the bus: answers proposals and registrations immediately, publishes the ledger
/// every cycle and heartbeats, and takes over from other coordinators.
class CoordinatorNode {
 public:
  CoordinatorNode(Bus& bus, const Scenario& scenario, const CoordinatorIdentity& self, bool is_standby);
  CoordinatorNode(const CoordinatorNode&) = delete;
  CoordinatorNode& operator=(const CoordinatorNode&) = delete;

  const Coordinator& coordinator() const { return coordinator_; }

 private:
  template <typename Message>
  void publish(Writer<Message>& writer, Message& message);
  /// Records the epoch that the sender obeys.
  template <typename Message>
  void observe_epoch(const Message& message, Epoch epoch);
  void on_registration(const msg::Registration& registration);
  void on_feedback(const msg::Feedback& feedback);
  void on_proposal(const msg::Proposal& proposal);
  /// Adopts the epoch of failover_, or stands by if failover_ does, and publishes the new state.
  void apply_epoch();
  void update_failover();
  void publish_state();
  void publish_state_periodically();
  void publish_ledger();

  Bus& bus_;
  const CoordinatorIdentity self_;
  Duration cycle_;
  Failover failover_;
  Coordinator coordinator_;
  Writer<msg::CoordinatorState> state_writer_;
  Writer<msg::LedgerPage> ledger_writer_;
  std::map<RobotId, Writer<msg::Verdict>> verdict_writers_;
  int standby_periods_ = 0;  // heartbeat periods while standing by
};

}  // namespace sidestep
