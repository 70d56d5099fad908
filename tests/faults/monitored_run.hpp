// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/faults/launched_run.hpp"

namespace sidestep {

/// A monitor process that watches a run.
class MonitorProcess {
 public:
  explicit MonitorProcess(LaunchedRun& run, const std::vector<std::string>& extra_arguments = {},
                          std::uint16_t wanted_port = 0, const std::string& name = "monitor");

  std::uint16_t port() const { return port_; }
  const std::string& token() const { return token_; }
  pid_t pid() const { return pid_; }
  std::string url() const;
  /// The answer to GET /api/state.
  nlohmann::json state() const;

 private:
  std::uint16_t port_ = 0;
  std::string token_;
  pid_t pid_ = 0;
};

/// Returns a function that processes messages of the run while the test waits for a browser.
std::function<void()> polling(LaunchedRun& run);

/// Receives messages of the run for this long.
void wait(LaunchedRun& run, Duration duration);

/// Robots that wait for orders, with two coordinators.
inline const std::string kWaitingRobots =
    "coordinators: 2\nrobots:\n  - {id: 0, start_m: [-2, 0]}\n  - {id: 1, start_m: [2, 0.5]}\n  - {id: 2, "
    "start_m: [0, 2]}\n";

}  // namespace sidestep
