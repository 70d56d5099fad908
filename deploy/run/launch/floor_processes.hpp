// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "deploy/run/place/place_floor.hpp"

namespace sidestep {

/// Selects what moves the robots: a driver of sidestep-robot, or Sidestep's simulator.
struct FloorOptions {
  std::string driver;  ///< driver of sidestep-robot; empty: the simulator runs with its own robots
  /// Extra options for sidestep-simulator, sidestep-vision and sidestep-robot, separated by spaces.
  std::string simulator, vision, robots;
  std::uint64_t seed = 1;     ///< seed of the simulator's noise
  std::string memory_folder;  ///< memory of the robots that sidestep-robot drives
  /// Control port of the league's simulator that places the robots first; nullopt: they stay where they are.
  std::optional<std::string> placing_control;
};

/// A program and its own arguments.
struct FloorProcess {
  std::string name;     ///< for example "robots"
  std::string program;  ///< for example "sidestep-robot"
  std::vector<std::string> arguments;
};

/// The process that moves the robots.
FloorProcess robots_process(const FloorOptions& options);
/// The vision process. It receives the league's packets if the robots are driven by the league's protocol,
/// unless the extra options name another source.
FloorProcess vision_process(const FloorOptions& options);

/// How robots are placed: with the vision packets that the vision process receives. Precondition:
/// `placing_control` is set.
PlaceOptions place_options_of(const FloorOptions& options);

/// The names of sidestep-robot's drivers.
std::vector<std::string> driver_names();

}  // namespace sidestep
