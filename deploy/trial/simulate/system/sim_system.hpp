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
#include "common/log/log_event.hpp"
#include "common/messaging/rules_exchange.hpp"
#include "common/messaging/sim/bus.hpp"
#include "common/protocol/order.hpp"
#include "common/protocol/process_names.hpp"
#include "deploy/audit/auditor.hpp"
#include "deploy/audit/metrics/run_metrics.hpp"
#include "deploy/trial/simulate/system/driven_bases.hpp"
#include "deploy/trial/simulate/system/system_processes.hpp"

namespace sidestep {

struct PlanningScratch;

/// The whole system on SimBus, in one thread and virtual time: one simulated process each for the simulator,
/// vision, every coordinator and every agent, and an observer with metrics and auditor. The same scenario and
/// seed give the same run, bit for bit.
class SimSystem {
 public:
  static constexpr Time kBegin = time_from_ns(1'000'000'000'000);
  /// Starts all processes at this virtual time. `clocks` contains the errors of processes' clocks, which
  /// apply to all their incarnations. If `bases` is set, robots are such driven bases and use the simulator's
  /// clock (DrivenBases); otherwise they have firmware.
  SimSystem(const Scenario& scenario, std::uint64_t seed, std::map<std::string, ClockError> clocks = {},
            Time begin = kBegin, const std::optional<DrivenBaseSettings>& bases = std::nullopt);
  ~SimSystem();
  SimSystem(const SimSystem&) = delete;
  SimSystem& operator=(const SimSystem&) = delete;

  void run_until(Time limit) { network_.run_until(limit); }
  void run_for(Duration duration) { network_.run_until(network_.now() + duration); }
  /// Runs until all robots have arrived and stayed for half a second, or until the limit; returns whether all
  /// have arrived and stayed.
  bool run_until_arrived(Time limit);

  /// Kills a process as if by SIGKILL: "simulator", "vision", "coordinator", "coordinator 1" or "agent 3".
  /// Robots, messages in flight and other processes are not affected. No effect if it is dead.
  void kill(const std::string& process);
  /// From its next start on, the process uses a scenario other than the system's.
  void use_scenario(const std::string& process, const Scenario& scenario) { scenarios_[process] = scenario; }
  /// Starts a dead process as a new incarnation without any state of the old one. Also starts
  /// twin_process(robot) as a second agent, or second_process(name), which ends when it hears the first one.
  void restart(const std::string& process);
  /// From now on, processes that should run alone continue when they hear an earlier process of their kind,
  /// as a third-party program might.
  void keep_duplicates_running() { keeps_duplicates_running_ = true; }
  bool is_alive(const std::string& process) const { return processes_.count(process) > 0; }
  /// When the process was last started.
  Time started_at(const std::string& process) const { return started_at_.at(process); }
  /// Whether some process, or the observer, has accepted messages of a second simulator or one of its robots,
  /// because it had not heard the first simulator for SingleWriterGuard::kGoneAfter or had never heard it.
  bool was_second_simulator_accepted() const { return was_second_simulator_accepted_; }
  /// Pauses a process as if by SIGSTOP and SIGCONT; see SimBus::pause. No effect if it is dead.
  void pause(const std::string& process, Duration duration, std::size_t max_queued);
  /// Disturbs a robot on an operator's behalf.
  void disturb(msg::Disturbance disturbance) {
    disturbance.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
    disturbance_writer_.publish(disturbance, now());
  }
  /// Puts a driven base elsewhere, at rest, as a simulator's operator does. Precondition: robots are driven
  /// bases, and the simulator is alive.
  void place(RobotId robot, const Vec2& position_m, double heading_rad);
  /// Publishes a client's order.
  void send(const Order& order);
  /// Sets how far the clock of a process and all its later incarnations is ahead of true time.
  void set_clock(const std::string& process, Duration offset);
  /// Sets the quality of the link between two processes, for all their incarnations.
  void set_link(const std::string& from, const std::string& to, const LinkQuality& quality);
  /// Sets the quality of the link by which a process receives the orders of send().
  void set_client_link(const std::string& to, const LinkQuality& quality);

  Time now() const { return network_.now(); }
  Time begin() const { return begin_; }
  SimNetwork& network() { return network_; }
  RunMetrics& metrics() { return metrics_; }
  /// Receives every message of the system's processes, even lost ones, without delay.
  Bus& observer_bus() { return observer_bus_; }
  const RunMetrics& metrics() const { return metrics_; }
  using OnProcessEvent = std::function<void(const std::string& process, const LogEvent&)>;
  /// Calls back with the events of all processes that have at least this level.
  void on_event(LogLevel min_level, OnProcessEvent callback);
  /// The auditor. It receives every message, even lost ones; the metrics' report includes its findings.
  Auditor& auditor() { return auditor_; }

 private:
  struct Process;
  SimProcessSpec spec_of(const std::string& process);
  void start(const std::string& process);
  void observe(const std::string& process);
  /// Records whether the process of this bus accepts messages of a second simulator.
  void watch_second_simulators(SimBus& bus);
  void on_other(const std::string& process, std::uint32_t id, Incarnation own, Incarnation other);

  const Scenario scenario_;
  std::uint64_t seed_;
  Rng rng_;
  std::map<std::string, ClockError> clocks_;
  std::map<std::string, Scenario> scenarios_;  // scenarios of processes that use a different one
  Time begin_;
  std::optional<DrivenBaseSettings> bases_;
  std::shared_ptr<PlanningScratch> scratch_;  // shared by all agents
  SimNetwork network_;
  RunMetrics metrics_;
  Auditor auditor_;
  const ProcessId observer_;
  SimBus observer_bus_;
  RulesExchange rules_;
  Writer<msg::Disturbance> disturbance_writer_;
  Writer<msg::Order> order_writer_;
  std::map<std::string, RobotId> robot_of_;  // indexed by agent process
  std::map<std::string, ProcessId> ids_;
  std::map<std::string, Incarnation> incarnations_;  // the latest incarnations
  std::map<std::string, Time> started_at_;
  std::map<std::string, std::unique_ptr<Process>> processes_;
  std::optional<Time> arrived_since_;
  LogLevel min_level_ = LogLevel::kOff;
  OnProcessEvent on_event_;
  bool keeps_duplicates_running_ = false;
  std::vector<Incarnation> second_simulators_;
  bool was_second_simulator_accepted_ = false;
};

}  // namespace sidestep
