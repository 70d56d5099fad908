// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "common/config/scenario.hpp"

namespace sidestep {

/// A scenario file that is refused; what() is "FILE:LINE: what is wrong and what was expected".
class ScenarioError : public std::runtime_error {
 public:
  ScenarioError(const std::string& file, int line, const std::string& what)
      : std::runtime_error(file + ":" + std::to_string(line) + ": " + what) {}
};

/// Reads and checks a scenario file (deploy/scenarios/README.md); throws ScenarioError for anything that is
/// wrong.
Scenario load_scenario(const std::string& path);

/// The same from text; `file_name` stands in messages, and its stem is the scenario's default name.
Scenario parse_scenario(const std::string& text, const std::string& file_name);

}  // namespace sidestep
