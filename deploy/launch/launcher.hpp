// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/messaging/rules_exchange.hpp"
#include "deploy/launch/hosts/namespaces.hpp"
#include "deploy/launch/hosts/placement.hpp"
#include "deploy/launch/process_group.hpp"
#include "deploy/launch/run.hpp"
#include "deploy/monitor/audit/auditor.hpp"
#include "deploy/monitor/metrics/progress.hpp"
#include "deploy/monitor/metrics/run_metrics.hpp"
#include "deploy/monitor/record/recording.hpp"

namespace sidestep {

/// Starts the processes of one run, monitors them until the run is over, and stops them.
class Launcher {
 public:
  /// All arguments must outlive the launcher. `network` is null unless this process created the hosts'
  /// namespaces.
  Launcher(const RunOptions& options, const Scenario& scenario, const Placement& placement,
           const NamespaceNetwork* network, const std::string& log_path);

  Report run();

 private:
  /// Prints a line and writes it to the log.
  void print(const std::string& line);
  void start(const std::string& name, const std::string& program, bool restart,
             const std::vector<std::string>& arguments = {});
  void start_core();
  void start_due_agents();
  void handle(const ChildEvent& event);
  /// Whether the run is over; then abort_reason_ says why if it was aborted.
  bool is_over();
  bool is_startup_over();
  bool is_drive_over();
  std::string startup_failure() const;
  /// Whether nothing moves any more and dead processes keep the remaining robots from arriving.
  bool is_stuck(Time now) const;
  bool are_all_coordinators_dead() const;

  const RunOptions& options_;
  const Scenario& scenario_;
  const Placement& placement_;
  const NamespaceNetwork* network_;
  ProcessGroup group_;
  DdsBus bus_;
  RulesExchange rules_;
  RunMetrics metrics_;
  Auditor auditor_;
  std::uint64_t printed_violations_ = 0;
  std::optional<RecordingWriter> recording_;
  ProgressDisplay display_;
  std::atomic<bool> is_interrupted_{false};
  bool is_ready_ = false;
  std::optional<Time> ready_at_;
  std::size_t agents_started_ = 0;
  Time last_start_{};
  Time last_death_{};
  std::optional<Time> arrived_since_;
  std::set<std::string> dead_;  ///< processes that died and will not be restarted
  std::string abort_reason_;
};

}  // namespace sidestep
