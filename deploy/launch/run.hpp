// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/messaging/dds/dds_bus.hpp"

namespace sidestep {

struct RunOptions {
  std::string scenario_file;
  std::string hosts_file;      ///< empty: everything on this machine, on the interface of `dds`
  std::string report_file;     ///< empty: reports/<scenario>-<time>.json; the log lies beside it
  std::string recording_file;  ///< of all messages; empty: none
  DdsSettings dds;
  std::uint64_t seed = 1;         ///< of the simulator's noise
  std::optional<double> seconds;  ///< instead of the scenario's time limit
  bool faults = false;            ///< processes take orders of `sidestep fault network`
  std::string simulator, vision;  ///< more options for these programs, as in a shell, without quotes
};

/// Starts every process of the system, watches until all robots have arrived, the time is up or somebody
/// interrupts, stops them and writes the report. Returns the exit code: 0 only if all arrived, nobody touched
/// and the auditor found no rule broken. Throws ScenarioError, and std::runtime_error when something cannot
/// be started or written.
int run(const RunOptions& options);

}  // namespace sidestep
