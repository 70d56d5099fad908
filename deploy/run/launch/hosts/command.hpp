// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace sidestep {

/// The path of a program in PATH, /usr/sbin or /sbin. Throws std::runtime_error if it is missing.
[[nodiscard]] std::string find_program(const std::string& name);

/// Runs a program to its end and returns its output. argv[0] is found with find_program(); `input` is its
/// stdin. Throws std::runtime_error with the first line of the output if the exit code is not 0.
std::string run_command(std::vector<std::string> argv, const std::string& input = {});

}  // namespace sidestep
