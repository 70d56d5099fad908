// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sidestep {

/// What moves the robots: a driver of sidestep-robot, or Sidestep's simulator.
struct FloorOptions {
  std::string driver;  ///< of sidestep-robot; empty: the simulator runs, with robots of its own
  /// Extra options for these programs, separated by spaces.
  std::string simulator, vision, robots;
  std::uint64_t seed = 1;     ///< of the simulator's noise
  std::string memory_folder;  ///< of the robots that sidestep-robot drives
};

/// A program and its own arguments.
struct FloorProcess {
  std::string name;     ///< e.g. "robots"
  std::string program;  ///< e.g. "sidestep-robot"
  std::vector<std::string> arguments;
};

/// The process that moves the robots.
FloorProcess robots_process(const FloorOptions& options);
/// Vision; it takes the league's packets if the robots are driven by the league's protocol.
FloorProcess vision_process(const FloorOptions& options);

/// The drivers of sidestep-robot.
std::vector<std::string> driver_names();

}  // namespace sidestep
