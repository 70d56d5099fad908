// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "deploy/trial/simulate/campaign/fault_plan.hpp"
#include "deploy/trial/simulate/campaign/floor_operator.hpp"
#include "deploy/trial/simulate/campaign/forger.hpp"
#include "deploy/trial/simulate/campaign/order_clients.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {

/// Runs a system and applies the faults of a plan.
class FaultPlayer {
 public:
  /// All arguments must outlive the player. Links start with the quality of links between healthy hosts.
  FaultPlayer(SimSystem& system, const Scenario& scenario, const FaultPlan& plan);

  /// Runs until this time after the start, and applies all faults up to then.
  void run_until(Duration after_begin);

  void operator()(const LinkChange& change);
  void operator()(const Partition& partition);
  void operator()(const LastingCut& cut);
  void operator()(const ClockJump& jump) { system_.set_clock(jump.process, jump.offset); }
  void operator()(const Pause& pause);
  void operator()(const Kill& kill) { system_.kill(kill.process); }
  void operator()(const Start& start) { system_.restart(start.process); }
  void operator()(const RobotDisturbance& disturbance);
  void operator()(const Carry& carry) { operator_.carry(carry, system_.begin() + plan_.healed_at); }
  void operator()(const Place& place) { operator_.place(place); }
  void operator()(const TakeAway& take) { operator_.take_away(take.robot); }
  void operator()(const StartWithOtherRule& start);
  void operator()(const StartWithOwnRules& start) { start_with(scenario_, start.process); }
  void operator()(const SendForgery& send);
  void operator()(const GiveOrder& give) { clients_->give(give.order); }

  /// What was wrong with clients' orders, in words.
  std::vector<std::string> order_failures() const;

 private:
  struct Link {
    std::string from, to;
    LinkQuality quality;
    bool is_within_host = false;
    int cuts = 0;  // partitions may overlap
    bool is_cut_for_good = false;
  };
  struct End {
    Duration at;
    Partition partition;
  };
  template <typename Do>
  void for_each_link(const ProcessNames& from, const ProcessNames& to, Do change);
  void set(const Link& link);
  void start_with(const Scenario& scenario, const std::string& process);
  void heal();
  /// Runs the system, ends partitions and lets the operator act.
  void advance(Duration until);

  SimSystem& system_;
  const Scenario& scenario_;
  const FaultPlan& plan_;
  FloorOperator operator_;
  std::vector<std::unique_ptr<Forger>> forgers_;  // one per victim
  std::optional<OrderClients> clients_;           // set if the plan has orders
  std::size_t next_ = 0;
  bool is_healed_ = false;
  std::map<std::string, std::map<std::string, Link>> links_;  // indexed by sender, then receiver
  std::vector<End> ends_;
};

}  // namespace sidestep
