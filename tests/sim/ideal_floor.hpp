// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>

#include "agents/agent/agent_node.hpp"
#include "coordinator/coordinator_node.hpp"
#include "deploy/monitor/audit/auditor.hpp"
#include "tests/sim/ideal_robots.hpp"
#include "tests/sim/troubled_bus.hpp"

namespace sidestep {

/// Agents and coordinators around ideal robots: what is promised here is promised exactly, to the last
/// micrometre.
class IdealFloor {
 public:
  /// Starts an agent for each robot and as many coordinators as the scenario has. The audit hears everything,
  /// but for what is said on a bus that is mute.
  IdealFloor(const Scenario& scenario, std::uint64_t seed, AuditTrace hearing = {true, {}});

  void start_coordinator(CoordinatorNumber number);
  void kill_coordinator(CoordinatorNumber number) { coordinators_.erase(number); }
  TroubledBus& coordinator_bus(CoordinatorNumber number) { return coordinators_.at(number).bus; }
  const Coordinator& coordinator(CoordinatorNumber number) {
    return coordinators_.at(number).node->coordinator();
  }
  /// The number of the coordinator that grants; -1 when none or more than one does.
  int granting();

  /// Starts one more agent for a robot; earlier ones live on.
  TroubledBus& start_agent(RobotId robot);
  void kill_agents(RobotId robot) { agents_.erase(robot); }
  /// The buses of the robot's agents, in the order of their starts.
  std::vector<TroubledBus*> agent_buses(RobotId robot);

  /// Runs for so many seconds; the smallest clearance of any two robots meanwhile.
  double run(double seconds);
  /// How often a robot executed what the coordinator in charge did not know of. Not counted: what a robot
  /// made itself, off its reference, until the coordinator hears of it.
  int unknown_versions() const { return unknown_; }
  /// Rules that the audit found broken.
  std::uint64_t violations() const;
  int arrived();
  /// Runs until all have arrived, at most for so long; the smallest clearance meanwhile.
  double run_until_arrived(double most_seconds);
  /// Runs until the fastest robot is as fast as this; false when none is within ten seconds.
  bool run_until_fast(double speed_mps);
  double speed_mps(RobotId robot);
  double fastest_mps();

  const Scenario scenario;
  SimNetwork network;
  SimBus robots_bus{network};
  IdealRobots robots;

 private:
  template <typename Node>
  struct Process {
    explicit Process(SimNetwork& network) : bus(network) {}
    TroubledBus bus;
    std::unique_ptr<Node> node;
  };

  void compare_with_ledger();

  const std::shared_ptr<PlanningScratch> bench_ = std::make_shared<PlanningScratch>(scenario);
  SimBus audit_bus_{network};
  Auditor auditor_;
  int unknown_ = 0;
  Rng rng_;
  Incarnation last_incarnation_ = 0;
  std::map<CoordinatorNumber, Process<CoordinatorNode>> coordinators_;
  std::multimap<RobotId, Process<AgentNode>> agents_;
  Incarnation next_incarnation();
};

}  // namespace sidestep
