// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace sidestep::arguments {

/// How a program ended, and what it printed.
struct ProgramRun {
  int exit_code = 0;   ///< -N: ended by signal N
  std::string errors;  ///< output on stderr
  double processor_s = 0;
  double wall_s = 0;
  double max_mb = 0;  ///< peak resident memory
};

/// Runs a program from the same build, in `folder`, without input, and waits for its end. After `patience`
/// the program gets `signal`, and after the same time again SIGKILL.
[[nodiscard]] ProgramRun run_program(const std::vector<std::string>& command, const std::string& folder,
                                     std::chrono::milliseconds patience, int signal);

}  // namespace sidestep::arguments
