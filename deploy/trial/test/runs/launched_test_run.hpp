// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/log/log_level.hpp"
#include "common/messaging/dds/bus.hpp"
#include "deploy/trial/test/judgement/test_result.hpp"

namespace sidestep {

struct LaunchOptions {
  std::string hosts_file;  ///< empty: this machine, or namespaces if the test has partitions
  DdsSettings dds;
  std::uint64_t seed = 1;  ///< seed of the simulator's noise
  LogLevel log_level = LogLevel::kInfo;
};

/// Runs a test over DDS, with one process for each part of the system. No process outlives the call. Writes
/// the report and the log to reports/. Throws ConfigError for the hosts file, and std::runtime_error if the
/// run is not possible.
[[nodiscard]] RunOutcome run_over_dds(const FaultTest& test, const LaunchOptions& options);

}  // namespace sidestep
