// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/log/log_level.hpp"
#include "common/messaging/dds/bus.hpp"
#include "deploy/run/launch/floor_processes.hpp"

namespace sidestep {

/// The Report::abort_reason of a run that was interrupted by the user.
inline constexpr const char* kInterrupted = "interrupted";

struct RunOptions {
  std::string scenario_file;
  std::string hosts_file;      ///< empty: all processes run on this machine, on the interface of `dds`
  std::string report_file;     ///< empty: reports/<scenario>-<time>.json; the log has the same stem
  std::string recording_file;  ///< records all messages except images; empty: none
  std::string picture_file;    ///< SVG picture of the robots' paths; empty: none
  std::optional<std::string> monitor_port;  ///< port of a page that shows the run; nullopt: no page
  bool has_control = false;                 ///< the page may give orders and cause faults
  bool closes_page = false;   ///< the page ends with the run; otherwise it stays until the user interrupts
  std::string monitor_token;  ///< set by run() if the page may command; see AccessSettings::token
  std::string domain = "0";   ///< for run(): replaces dds.domain; "auto": a free domain
  /// dds.keys, if set, is a folder with the keys of all identities; each process gets its own keys.
  DdsSettings dds;
  FloorOptions floor;
  std::optional<double> seconds;         ///< overrides the scenario's time limit
  bool until_idle = false;               ///< see run()
  bool faults = false;                   ///< processes accept `sidestep fault network`
  std::string planner;                   ///< planner of all robots' paths; empty: the scenario's
  LogLevel log_level = LogLevel::kInfo;  ///< log level of all processes
  bool is_quiet = false;                 ///< prints nothing to the terminal; the log contains everything
};

/// Starts all processes of the system, monitors them until all robots have arrived, the time limit has passed
/// or the user interrupts, stops them, and writes the report. If the scenario gives no robot a goal, clients
/// give the orders. The run then lasts until the user interrupts, RunOptions::seconds have passed or, with
/// `until_idle`, all robots have finished their orders. If a page shows the run, this returns only when the
/// user interrupts, unless RunOptions::closes_page. Returns the exit code: 0 only if no robot had an
/// unexcused contact, the auditor found no violation, and all robots arrived, that is, finished their orders
/// if clients give them; without `until_idle` such robots need not arrive. Returns kExitNotJudged if nothing
/// went wrong but the audit covered too little. Throws ConfigError, and std::runtime_error if a process
/// cannot be started or a file cannot be written.
int run(const RunOptions& options);

}  // namespace sidestep
