// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/log/log_level.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/messaging/rules_exchange.hpp"
#include "deploy/audit/auditor.hpp"
#include "deploy/audit/metrics/progress.hpp"
#include "deploy/audit/metrics/run_metrics.hpp"
#include "deploy/inspect/record/recording.hpp"
#include "deploy/run/launch/hosts/namespaces.hpp"
#include "deploy/run/launch/hosts/placement.hpp"
#include "deploy/run/launch/process_command.hpp"
#include "deploy/run/launch/processes.hpp"
#include "deploy/run/launch/revoked_keys.hpp"
#include "deploy/run/launch/run.hpp"

namespace sidestep {

/// Controls a run: acts on its processes and decides when the run is over.
struct RunDirector {
  /// Returns the latest time at which to call `act`.
  std::function<Time()> next;
  /// Called at least every 20 ms once the coordinator grants. Returns whether the run is over.
  std::function<bool()> act;
};

/// Earlier launchers of a run; see keep_processes().
struct Predecessors {
  std::vector<std::string> deaths;  ///< reasons for their deaths
  Duration age{0};                  ///< time since the first one began
};

/// Starts the processes of one run, monitors them until the run is over, and stops them.
class Launcher {
 public:
  /// All arguments must outlive the launcher. `network` is null unless the hosts' namespaces were created for
  /// this run.
  Launcher(const RunOptions& options, const Scenario& scenario, const Placement& placement,
           const NamespaceNetwork* network, Processes& processes, Predecessors before = {});

  /// From now on the director decides when the run is over, instead of arrivals, deaths and the time limit.
  void set_director(RunDirector director) { director_ = std::move(director); }

  Report run();
  /// Adds the report to the recording and closes it. If that fails, adds the reason to the report.
  void finish_recording(Report& report);

  // The following functions are for directors. Processes have the same names as in the report.
  DdsBus& bus() { return bus_; }
  const RunMetrics& metrics() const { return metrics_; }
  /// Sends a signal to a process. False if it is not running.
  [[nodiscard]] bool send_signal(const std::string& process, int signal) {
    return children_.send_signal(process, signal);
  }
  /// Kills a process if it is running, and starts it again with a scenario file.
  void restart(const std::string& process, const std::string& scenario_file);
  /// Starts a second agent for a robot, as the process `name`.
  void start_twin(RobotId robot, const std::string& name);

 private:
  /// Prints a line, and writes it to the log if its level is high enough.
  void print(const std::string& line, LogLevel level = LogLevel::kInfo);
  void print_new_epochs();
  void start(const std::string& name, const std::string& program, bool is_restarted,
             const std::vector<std::string>& arguments = {}, Duration rest_time = Duration::zero());
  void start(const ProcessSpec& process, const HostSpec& host);
  ChildSpec child(const ProcessSpec& process, const HostSpec& host) const;
  void start_core();
  void start_due_agents();
  /// Sends the list of revoked keys to processes on other hosts if it has changed.
  void send_revoked_keys();
  Time next_poll();
  void handle(const ChildEvent& event);
  /// Starts the process that shows the run in the browser. Returns when its page can be opened, or the user
  /// has interrupted. Throws std::runtime_error if the process ends instead.
  void start_monitor();
  /// Tells that process that the run is over, or ends it if the run has not been ready.
  void end_monitored_run();
  /// Runs until the run is over.
  void work();
  /// Brings all robots to rest, ends the processes that move them, and judges meanwhile. Ends all processes
  /// at once if the user gives up.
  void bring_to_rest();
  /// Why the run is over.
  std::string end_cause() const;
  /// Asks all processes that run a program to end, and returns the names of those that were running.
  std::set<std::string> ask_to_end(const std::string& program);
  /// The processes that run a program and have not died.
  std::set<std::string> running(const std::string& program) const;
  void print_last_lines(const std::string& process);
  /// Whether the run is over; sets abort_reason_ if the run must be aborted.
  bool check_end();
  bool check_end_of_startup();
  bool check_end_of_drive();
  std::string startup_failure() const;
  /// Time of the first grant; if other launchers preceded this one, the time when the first of them began.
  Time drive_started_at() const;
  /// Whether the run ends without the user once its robots have finished, because no further order is
  /// awaited.
  bool may_end_by_itself() const;
  /// Ends a run on demand. Sets abort_reason_ if it could not have gone on.
  bool end_on_demand();
  /// Whether dead processes prevent all robots from finishing; see are_fatal().
  bool has_fatal_deaths() const;
  /// Whether in addition all robots have stopped.
  bool is_stuck(Time now) const;
  std::string death_text() const;

  const RunOptions& options_;
  const Scenario& scenario_;
  const Placement& placement_;
  const NamespaceNetwork* network_;
  Processes& children_;
  const Predecessors before_;
  std::map<std::string, ProcessSpec> processes_;  ///< indexed by name
  RevokedKeys revoked_keys_;
  RunDirector director_;
  DdsBus bus_;
  RulesExchange rules_;
  RunMetrics metrics_;
  Auditor auditor_;
  std::uint64_t printed_violations_ = 0;
  std::size_t printed_epochs_ = 0;
  std::optional<RecordingWriter> recording_;
  std::string recording_failure_;
  ProgressDisplay display_;
  std::atomic<bool> is_interrupted_{false};
  std::atomic<bool> gives_up_{false};  ///< the user does not wait until robots rest
  bool is_ready_ = false;
  std::optional<Time> ready_at_;
  Time began_{};
  std::size_t agents_started_ = 0;
  Time last_start_{};
  Time last_death_{};
  std::optional<Time> arrived_since_;
  std::set<std::string> dead_;  ///< processes that died and will not be restarted
  std::string abort_reason_;
  std::optional<EndingRecord> ending_;
};

}  // namespace sidestep
