// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "common/config/scenario_loader.hpp"

namespace sidestep {

/// What parse_scenario() says against a text, or "accepted".
inline std::string refusal(const std::string& text) {
  try {
    parse_scenario(text, "file.yaml");
  } catch (const ScenarioError& error) {
    return error.what();
  }
  return "accepted";
}

inline void check_refused(const std::string& text, int line, const std::string& why) {
  CAPTURE(text);
  const std::string said = refusal(text);
  CHECK_THAT(said, Catch::StartsWith("file.yaml:" + std::to_string(line) + ": "));
  CHECK_THAT(said, Catch::Contains(why));
}

/// A robot that nothing is wrong with.
inline const std::string kRobot = "robots: [{id: 0, start_m: [0, 0], goals_m: [[1, 0]]}]\n";

}  // namespace sidestep
