// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/log/log_level.hpp"
#include "common/messaging/dds/bus.hpp"
#include "deploy/launch/floor_processes.hpp"

namespace sidestep {

/// Report::abort_reason of a run that the user interrupted.
inline constexpr const char* kInterrupted = "interrupted";

struct RunOptions {
  std::string scenario_file;
  std::string hosts_file;      ///< empty: all processes on this machine, on the interface of `dds`
  std::string report_file;     ///< empty: reports/<scenario>-<time>.json; the log has the same stem
  std::string recording_file;  ///< records all messages except images; empty: none
  std::optional<std::string> monitor_port;  ///< of a page that shows the run; nullopt: none
  std::string domain = "0";                 ///< of run(): instead of that of `dds`; "auto": one that is free
  DdsSettings dds;  ///< if it has keys, then those of all identities: each process gets its own
  FloorOptions floor;
  std::optional<double> seconds;         ///< overrides the scenario's time limit
  bool until_idle = false;               ///< see run()
  bool faults = false;                   ///< processes accept `sidestep fault network`
  std::string planner;                   ///< of all robots' paths; empty: the scenario's
  LogLevel log_level = LogLevel::kInfo;  ///< of all processes
  bool is_quiet = false;                 ///< prints nothing; the log contains everything
};

/// Starts all processes of the system, monitors them until all robots have arrived, the time limit has passed
/// or the user interrupts, stops them, and writes the report. If the scenario gives no robot a goal, clients
/// do: the run lasts until the user interrupts, RunOptions::seconds have passed or, with `until_idle`, all
/// robots have finished what they were ordered, and no robot has to arrive. Returns the exit code: 0 only if
/// all robots arrived without contact and the auditor found no violation; kExitNotJudged if that may be so,
/// but the audit covered too little. Throws ConfigError, and std::runtime_error when a process cannot be
/// started or a file cannot be written.
int run(const RunOptions& options);

}  // namespace sidestep
