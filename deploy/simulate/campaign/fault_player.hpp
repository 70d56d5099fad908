// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "deploy/simulate/campaign/fault_plan.hpp"
#include "deploy/simulate/system/sim_system.hpp"

namespace sidestep {

/// Runs a system and applies the faults of a plan.
class FaultPlayer {
 public:
  /// Both arguments must outlive the player. Links start with the quality of healthy hosts.
  FaultPlayer(SimSystem& system, const FaultPlan& plan);

  /// Runs until this time after the start, and applies all faults until then.
  void run_until(Duration after_begin);

  void operator()(const LinkChange& change);
  void operator()(const Partition& partition);
  void operator()(const Pause& pause);
  void operator()(const Kill& kill) { system_.kill(kill.process); }
  void operator()(const Start& start) { system_.restart(start.process); }
  void operator()(const RobotDisturbance& disturbance);

 private:
  struct Link {
    std::string from, to;
    LinkQuality quality;
    bool is_within_host = false;
    int cuts = 0;  // partitions may overlap
  };
  struct End {
    Duration at;
    Partition partition;
  };
  template <typename Do>
  void for_each_link(const ProcessNames& from, const ProcessNames& to, Do change);
  void set(const Link& link);
  void heal();
  void end_partitions(Duration until);

  SimSystem& system_;
  const FaultPlan& plan_;
  std::size_t next_ = 0;
  bool is_healed_ = false;
  std::map<std::string, std::map<std::string, Link>> links_;  // by sender, then receiver
  std::vector<End> ends_;
};

}  // namespace sidestep
