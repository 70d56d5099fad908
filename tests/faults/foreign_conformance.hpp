// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sidestep {

/// What `sidestep conformance` said about a robot that another process simulates.
struct ConformanceOutcome {
  std::string ended;                 ///< how the command ended, for example "exit code 0"; empty: it did not
  std::string output;                ///< of all processes
  std::string latency_row;           ///< the row without its verdict; empty: there is none
  std::optional<double> latency_ms;  ///< the latency that is printed as a figure
  bool is_latency_judged = false;
};

/// Runs `sidestep league place` and `sidestep conformance --driver league` with a scenario's text, on the
/// league's simulator of Sidestep with these options, in a DDS domain and ports of its own. `driver_options`
/// are those of sidestep-robot, `conformance_options` more of the latter command.
[[nodiscard]] ConformanceOutcome examine_foreign_robot(
    const std::string& scenario, const std::vector<std::string>& simulator_options,
    const std::string& driver_options, const std::vector<std::string>& conformance_options = {});

}  // namespace sidestep
