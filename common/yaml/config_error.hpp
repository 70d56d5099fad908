// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace sidestep {

/// An error in a configuration file; what() is "FILE:LINE: what is wrong and what was expected", or without
/// LINE if the file cannot be read.
class ConfigError : public std::runtime_error {
 public:
  ConfigError(const std::string& file, int line, const std::string& what)
      : std::runtime_error(file + ":" + std::to_string(line) + ": " + what) {}
  ConfigError(const std::string& file, const std::string& what) : std::runtime_error(file + ": " + what) {}
};

}  // namespace sidestep
