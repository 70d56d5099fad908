// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/log/log_level.hpp"

namespace sidestep {

struct SimulateOptions {
  std::string scenario_file;                 ///< may be empty in simulate_trial()
  std::string report_file;                   ///< empty: reports/<scenario>-<seed>.json
  std::string picture_file;                  ///< SVG of the robots' paths; empty: no picture
  std::optional<std::uint32_t> laser_robot;  ///< robot whose laser scan the picture shows; nullopt: none
  std::string recording_file;                ///< records all messages except images; empty: none
  std::uint64_t seed = 1;
  LogLevel log_level = LogLevel::kWarning;  ///< log level of the simulated processes, which log to stderr
  std::optional<double> seconds;            ///< overrides the scenario's time limit
  std::string planner;                      ///< planner of all robots' paths; empty: the scenario's
};

/// Runs the whole system in this process and virtual time, and writes the same report as run(). Returns the
/// same exit codes as run(). Throws ConfigError, and std::runtime_error if a file cannot be written.
int simulate(const SimulateOptions& options);

/// Runs the trial of one seed of a campaign (deploy/trial/simulate/campaign) with or without its faults,
/// prints its scene and faults, and writes the report. Without a scenario file, the scene is also random.
/// Returns and throws what simulate() does.
int simulate_trial(const SimulateOptions& options, bool has_faults);

}  // namespace sidestep
