// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deploy/trial/simulate/campaign/fault_plan.hpp"
#include "deploy/trial/simulate/campaign/floor_operator.hpp"
#include "deploy/trial/simulate/campaign/forger.hpp"
#include "deploy/trial/simulate/campaign/order_clients.hpp"
#include "deploy/trial/simulate/system/sim_link_faults.hpp"
#include "simulator/world/disturbance_codec.hpp"

namespace sidestep {

/// Runs a system and applies the faults of a plan.
class FaultPlayer {
 public:
  /// All arguments must outlive the player. Links start with the quality of links between healthy hosts.
  FaultPlayer(SimSystem& system, const Scenario& scenario, const FaultPlan& plan);

  /// Runs until this time after the start, and applies all faults up to then.
  void run_until(Duration after_begin);

  /// Failures of clients' orders, in words.
  std::vector<std::string> order_failures() const;

  /// Called by the schedule when a fault begins or ends.
  void begin(std::size_t fault);
  void end(std::size_t fault);

 private:
  void apply(const LinkChange& change, const TimedFault&) {
    set_qualities(change.from, change.to, change.quality);
  }
  void apply(const Partition& partition, const TimedFault& timed);
  void apply(const Pause& pause, const TimedFault& timed);
  void apply(const ClockJump& jump, const TimedFault&) { system_.set_clock(jump.process, jump.offset); }
  void apply(const Kill& kill, const TimedFault&) { system_.kill(kill.process); }
  void apply(const Start& start, const TimedFault&) { system_.restart(start.process); }
  void apply(const RobotDisturbance& disturbance, const TimedFault&) { system_.disturb(encode(disturbance)); }
  void apply(const Carry& carry, const TimedFault&) {
    operator_.carry(carry, system_.begin() + plan_.healed_at);
  }
  void apply(const Place& place, const TimedFault&) { operator_.place(place); }
  void apply(const TakeAway& take, const TimedFault&) { operator_.take_away(take.robot); }
  void apply(const StartWithMutatedRule& start, const TimedFault&);
  void apply(const StartWithOwnRules& start, const TimedFault&) { start_with(scenario_, start.process); }
  void apply(const SendForgery& send, const TimedFault&);
  void apply(const GiveOrder& give, const TimedFault&) { clients_->give(give.order); }
  /// Sets the quality of links between hosts; links within a host keep their quality.
  void set_qualities(const ProcessNames& from, const ProcessNames& to, const LinkQuality& between);
  void start_with(const Scenario& scenario, const std::string& process);
  void heal();
  /// Runs the system and lets the operator act.
  void advance(Time until);
  /// Like advance(), and also begins and ends faults.
  void play(Time until);

  SimSystem& system_;
  const Scenario& scenario_;
  const FaultPlan& plan_;
  FloorOperator operator_;
  std::vector<std::unique_ptr<Forger>> forgers_;  // one per victim
  std::optional<OrderClients> clients_;           // set if the plan has orders
  bool is_healed_ = false;
  ProcessNames processes_;
  std::map<std::string, const ProcessNames*> host_of_;
  SimLinkFaults links_;
  FaultSchedule<TimedFault> schedule_;
};

}  // namespace sidestep
