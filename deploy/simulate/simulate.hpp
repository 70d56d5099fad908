// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace sidestep {

struct SimulateOptions {
  std::string scenario_file;   ///< may be empty with faults
  std::string report_file;     ///< empty: reports/<scenario>-<seed>.json
  std::string picture_file;    ///< SVG of the robots' ways; empty: none
  std::string recording_file;  ///< of all messages; empty: none
  std::uint64_t seed = 1;
  std::optional<double> seconds;  ///< instead of the scenario's time limit
};

/// Runs the one trial that a seed stands for in a search for trouble (deploy/simulate/campaign), shows what was drawn
/// and writes the report. Returns and throws as simulate() does.
int simulate_trial(const SimulateOptions& options);

/// Runs the whole system in this process and virtual time, and writes the same report as run(). Returns the
/// exit code, as run() does. Throws ScenarioError, and std::runtime_error when the report cannot be written.
int simulate(const SimulateOptions& options);

}  // namespace sidestep
