// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/sim/sim_bus.hpp"
#include "deploy/monitor/audit/auditor.hpp"
#include "deploy/monitor/metrics/run_metrics.hpp"

namespace sidestep {

struct PlanningScratch;

/// The name of the second agent of a robot.
std::string twin_process(RobotId robot);

/// The whole system on SimBus, in one thread and virtual time: one simulated process for the simulator,
/// vision, each coordinator and each agent, and a judge that listens. The same scenario and seed give the
/// same run, bit for bit.
class SimSystem {
 public:
  /// Starts every process at virtual time 1000 s. A process that is named in `clocks` has a clock that goes
  /// ahead of virtual time by so much, in all its lives.
  SimSystem(const Scenario& scenario, std::uint64_t seed, std::map<std::string, Duration> clocks = {});
  ~SimSystem();
  SimSystem(const SimSystem&) = delete;
  SimSystem& operator=(const SimSystem&) = delete;

  void run_until(Time limit) { network_.run_until(limit); }
  void run_for(Duration duration) { network_.run_until(network_.now() + duration); }
  /// Runs until all have arrived and stayed for half a second, but at most until the limit; whether they
  /// have.
  bool run_until_arrived(Time limit);

  /// kill -9 of a process: "simulator", "vision", "coordinator", "coordinator 1" or "agent 3". Its robots,
  /// messages under way and the others go on. Does nothing when it is dead.
  void kill(const std::string& process);
  /// Starts a process that is dead, as a new incarnation that knows nothing of the old one.
  void restart(const std::string& process);
  bool is_alive(const std::string& process) const { return processes_.count(process) > 0; }
  /// Starts another agent for a robot that has one, as twin_process(robot).
  void start_twin(RobotId robot) { restart(twin_process(robot)); }
  /// SIGSTOP for a while; see SimBus::pause. Does nothing when the process is dead.
  void pause(const std::string& process, Duration duration, std::size_t most_waiting);
  /// Somebody's hand on a robot.
  void disturb(msg::Disturbance& disturbance) { hand_.publish(disturbance, now()); }
  /// What the link between two processes does from now on, whatever their lives.
  void set_link(const std::string& from, const std::string& to, const LinkQuality& quality);
  /// The processes that a system starts with.
  static std::vector<std::string> process_names(const Scenario& scenario);

  Time now() const { return network_.now(); }
  Time begin() const { return begin_; }
  SimNetwork& network() { return network_; }
  RunMetrics& judge() { return judge_; }
  /// Shows every ground truth that the judge sees.
  void on_truth(std::function<void(const msg::GroundTruth&)> watcher) { truth_watcher_ = std::move(watcher); }
  const RunMetrics& judge() const { return judge_; }
  /// Hears every message, whatever becomes of it; the judge's report says what it found.
  Auditor& auditor() { return auditor_; }

 private:
  struct Process;
  SimPlace place_of(const std::string& process);
  void start(const std::string& process);

  const Scenario scenario_;
  std::uint64_t seed_;
  Rng rng_;
  std::map<std::string, Duration> clocks_;
  Time begin_;
  std::shared_ptr<PlanningScratch> bench_;  // of all agents
  SimNetwork network_;
  RunMetrics judge_;
  Auditor auditor_;
  SimBus judge_bus_;
  Writer<msg::Disturbance> hand_;
  std::map<std::string, RobotId> robot_of_;  // by the names of its agents
  std::map<std::string, ProcessId> ids_;
  std::map<std::string, Incarnation> incarnations_;  // of the latest lives
  std::map<std::string, std::unique_ptr<Process>> processes_;
  std::optional<Time> arrived_since_;
  std::function<void(const msg::GroundTruth&)> truth_watcher_;
};

}  // namespace sidestep
