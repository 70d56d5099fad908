// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "common/messaging/bus.hpp"
#include "coordinator/coordinator.hpp"

namespace sidestep {

/// Connects a coordinator to the bus: answers proposals at once, publishes the ledger every cycle and its
/// sign of life.
class CoordinatorNode {
 public:
  CoordinatorNode(Bus& bus, const Scenario& scenario, Incarnation incarnation);
  CoordinatorNode(const CoordinatorNode&) = delete;
  CoordinatorNode& operator=(const CoordinatorNode&) = delete;

  const Coordinator& coordinator() const { return coordinator_; }
  /// Calls back once another coordinator is found to have superseded this one.
  void on_superseded(std::function<void()> callback) { on_superseded_ = std::move(callback); }

 private:
  template <typename Message>
  void publish(Writer<Message>& writer, Message& message);
  void publish_state();
  void publish_ledger();
  void publish_state_if_changed();

  Bus& bus_;
  Incarnation incarnation_;
  Duration cycle_;
  Coordinator coordinator_;
  Writer<msg::CoordinatorState> state_writer_;
  Writer<msg::LedgerPage> ledger_writer_;
  std::map<RobotId, Writer<msg::Verdict>> verdict_writers_;
  bool was_granting_ = false;
  std::function<void()> on_superseded_;
};

}  // namespace sidestep
