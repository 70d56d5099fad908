// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>

#include "agents/agent/agent_node.hpp"
#include "coordinator/coordinator_node.hpp"
#include "deploy/audit/auditor.hpp"
#include "tests/sim/faulty_bus.hpp"
#include "tests/sim/ideal_robots.hpp"

namespace sidestep {

/// Agents and coordinators with ideal robots, so the safety guarantee must hold to the micrometre.
class IdealFloor {
 public:
  /// Starts an agent for each robot and the scenario's number of coordinators. The audit receives all
  /// messages except those that a FaultyBus blocks.
  IdealFloor(const Scenario& scenario, std::uint64_t seed, AuditInput audit_input = {true, {}});

  void start_coordinator(CoordinatorNumber number);
  void kill_coordinator(CoordinatorNumber number) { coordinators_.erase(number); }
  FaultyBus& coordinator_bus(CoordinatorNumber number) { return coordinators_.at(number).bus; }
  const Coordinator& coordinator(CoordinatorNumber number) {
    return coordinators_.at(number).node->coordinator();
  }
  /// The number of the coordinator that grants; -1 if no coordinator or more than one grants.
  int granting_coordinator();

  /// Starts another agent of a robot; earlier ones keep running.
  FaultyBus& start_agent(RobotId robot);
  void kill_agents(RobotId robot) { agents_.erase(robot); }
  /// The robot's first agent that is running. Precondition: there is one.
  AgentNode& agent(RobotId robot) { return *agents_.find(robot)->second.node; }
  /// The buses of the robot's agents, in order of their start.
  std::vector<FaultyBus*> agent_buses(RobotId robot);

  /// Runs for this long. Returns the minimum clearance between any two robots in that time.
  double run(double seconds);
  /// Number of times that a robot executed a version missing from the ledger of the granting coordinator. An
  /// own stop is not compared until the coordinator has received a report of it.
  int unknown_versions() const { return unknown_versions_; }
  /// Rule violations found by the audit.
  std::uint64_t violations() const;
  int arrived();
  /// Runs until all robots have arrived, or for max_seconds. Returns the minimum clearance in that time.
  double run_until_arrived(double max_seconds);
  /// Runs until a robot reaches this speed; false if none does within ten seconds.
  bool run_until_speed(double speed_mps);
  double speed_mps(RobotId robot);
  double max_speed_mps();

  const Scenario scenario;
  SimNetwork network;
  SimBus robots_bus{network};
  IdealRobots robots;

 private:
  template <typename Node>
  struct Process {
    explicit Process(SimNetwork& network) : bus(network) {}
    FaultyBus bus;
    std::unique_ptr<Node> node;
  };

  void compare_with_ledger();

  const std::shared_ptr<PlanningScratch> scratch_ = std::make_shared<PlanningScratch>(scenario);
  SimBus audit_bus_{network};
  Auditor auditor_;
  int unknown_versions_ = 0;
  Rng rng_;
  Incarnation last_incarnation_ = 0;
  std::map<CoordinatorNumber, Process<CoordinatorNode>> coordinators_;
  std::multimap<RobotId, Process<AgentNode>> agents_;
  Incarnation next_incarnation();
};

}  // namespace sidestep
