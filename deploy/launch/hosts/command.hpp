// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace sidestep {

/// The path of a program in PATH or among the administrator's; throws std::runtime_error when there is none.
std::string find_program(const std::string& name);

/// Runs a program to its end; throws std::runtime_error with what it printed when its exit code is not 0.
/// Returns what it printed. argv[0] is looked up; `input` is its stdin.
std::string run_command(std::vector<std::string> argv, const std::string& input = {});

}  // namespace sidestep
