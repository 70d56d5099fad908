// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/config/scenario.hpp"

namespace sidestep {

inline constexpr std::array kCornerKinds{"corner", "door", "shelves", "pillars", "rooms"};

/// A scene with one robot that drives around corners and has a laser, and one to three people who step out of
/// places that it cannot see, into its path, and back. Walls, sizes, speeds and the laser are random. The
/// same seed gives the same scene. `kind` is an index of kCornerKinds.
[[nodiscard]] Scenario corner_scene(std::size_t kind, std::uint64_t seed);

/// The outcome for the robot.
struct CornerResult {
  bool has_arrived = false, was_blocked = false;
  double seconds = 0;  ///< time until the robot arrived
  std::uint64_t contacts = 0, crashes = 0, crashes_in_motion = 0;
  bool audit_passed = false;
};

/// Runs a scene in virtual time. Without the laser, cameras above the floor see people everywhere.
[[nodiscard]] CornerResult run_corner(Scenario scenario, std::uint64_t seed, bool has_laser);

}  // namespace sidestep
