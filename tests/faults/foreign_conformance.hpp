// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sidestep {

/// What `sidestep conformance` said about a robot that another process simulates.
struct ConformanceOutcome {
  /// How the command ended, for example "exit code 0"; empty: it did not, or was stopped.
  std::string ended;
  std::string output;                ///< of all processes
  std::string latency_row;           ///< the row without its verdict; empty: there is none
  std::optional<double> latency_ms;  ///< the latency that is printed as a figure
  bool is_latency_judged = false;
};

/// When an examination is stopped.
enum class ExaminedUntil { kEnd, kLatency };

/// Runs `sidestep league place` and `sidestep conformance --driver league` with a scenario's text, on the
/// league's simulator of Sidestep with these options, in a DDS domain and ports of its own. `driver_options`
/// are those of sidestep-robot, `conformance_options` more of the latter command. `until` kLatency: that
/// command is stopped when it has printed the row "latency".
[[nodiscard]] ConformanceOutcome examine_foreign_robot(
    const std::string& scenario, const std::vector<std::string>& simulator_options,
    const std::string& driver_options, const std::vector<std::string>& conformance_options = {},
    ExaminedUntil until = ExaminedUntil::kEnd);

}  // namespace sidestep
