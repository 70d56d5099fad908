// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "coordinator/coordinator.hpp"
#include "coordinator/failover.hpp"

namespace sidestep {

/// Connects a coordinator to the bus: decodes messages and counts invalid ones, answers proposals and
/// registrations immediately, publishes the ledger every cycle and heartbeats, and takes over from other
/// coordinators.
class CoordinatorNode {
 public:
  CoordinatorNode(Bus& bus, const Scenario& scenario, const CoordinatorIdentity& self, bool is_standby);
  CoordinatorNode(const CoordinatorNode&) = delete;
  CoordinatorNode& operator=(const CoordinatorNode&) = delete;

  /// Sets a callback for events that an operator should know of, in plain words.
  void on_event(std::function<void(const std::string&)> callback) { on_event_ = std::move(callback); }

  const Coordinator& coordinator() const { return coordinator_; }

 private:
  template <typename Message>
  void publish(Writer<Message>& writer, Message& message);
  /// Handles a decoded message; counts it as invalid if decoding failed.
  template <typename Decoded>
  void take(const std::optional<Decoded>& decoded);
  void handle(const CoordinatorHeartbeat& heartbeat);
  void handle(const Registration& registration);
  void handle(const Feedback& feedback);
  void handle(const Proposal& proposal);
  void on_world(const msg::WorldState& message);
  void on_attestation(const msg::AbsenceAttestation& message);
  void report(const std::string& event) {
    if (on_event_) on_event_(event);
  }
  /// Records the epoch that an agent or a robot obeys.
  void observe_epoch(RobotId robot, Epoch epoch);
  void answer(const Verdict& verdict);
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
  std::function<void(const std::string&)> on_event_;
  std::map<RobotId, Time> heard_at_;            // when each robot's last fact arrived
  std::vector<RobotObservation> observations_;  // of the last world state
  int standby_periods_ = 0;                     // heartbeat periods while standing by
  std::uint64_t invalid_ = 0;                   // messages that decoding refused
};

}  // namespace sidestep
