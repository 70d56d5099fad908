// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/config/scenario.hpp"

namespace sidestep {

/// Settings of a scene: robots with three goals each, and people who avoid obstacles but not robots.
struct ClutterSettings {
  bool is_building =
      false;  ///< true: rooms and corridors of a random floor plan; false: an open hall with ten obstacles
  int robots = 1, people = 5;
  std::string planner = "lazy-visibility";
};

/// Makes a scene in which all goals can be reached. The same seed gives the same floor, people, starts and
/// goals for all planners.
[[nodiscard]] Scenario clutter_scene(const ClutterSettings& settings, std::uint64_t seed);

struct ClutterResult {
  int robots = 0, arrived = 0;
  double seconds = 0;  ///< time until all robots have arrived, or the time limit
  std::uint64_t contacts = 0, crashes = 0, crashes_in_motion = 0;
  bool audit_passed = false;
};

/// Runs the scenario in virtual time.
[[nodiscard]] ClutterResult run_clutter(const Scenario& scenario, std::uint64_t seed);

}  // namespace sidestep
