// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "vision/calibrate/calibrate_command.hpp"

namespace sidestep::test {

/// Runs `sidestep-vision calibrate ARGUMENTS`. Returns the exit code.
inline int calibrate(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv{"sidestep-vision", "calibrate"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  CommandLine command_line("test", "sidestep-vision");
  std::function<int()> action;
  add_calibrate_command(command_line.root(), action);
  if (const auto exit_code = command_line.parse(static_cast<int>(argv.size()), argv.data()))
    return *exit_code;
  return run_and_report_errors("sidestep-vision", action);
}

}  // namespace sidestep::test
