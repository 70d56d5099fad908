// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"

namespace sidestep {

/// The error message of parse_scenario() for a text, or "accepted".
inline std::string error_of(const std::string& text) {
  try {
    (void)parse_scenario(text, "file.yaml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

inline void check_rejected(const std::string& text, int line, const std::string& why) {
  CAPTURE(text);
  const std::string error = error_of(text);
  CHECK_THAT(error, StartsWith("file.yaml:" + std::to_string(line) + ": "));
  CHECK_THAT(error, ContainsSubstring(why));
}

/// A valid scenario with one robot.
inline const std::string kRobot = "robots: [{id: 0, start_m: [0, 0], goals_m: [[1, 0]]}]\n";

}  // namespace sidestep
