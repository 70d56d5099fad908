// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace sidestep {

/// The kinds of random buildings: rooms with corridors, doors and some shelves; or halls full of shelves.
inline const std::vector<std::string> kBuildingKinds{"offices", "warehouse"};

struct BuildingOptions {
  std::string folder;
  std::string kind = kBuildingKinds.front();
  std::uint64_t seed = 1;
  int cells = 2000;            ///< number of cells along each side
  double resolution_m = 0.05;  ///< side of a cell
  int robots = 6;
  int goals = 3;  ///< number of goals per robot
};

/// Writes a random building into a folder, which it creates: its map as `map.yaml` and `map.pgm`, and
/// `scenario.yaml` with robots and goals at random reachable places. The same options give the same files.
/// Throws std::invalid_argument if the building has no room for this number of robots, and std::runtime_error
/// if a file cannot be written. A large building takes many seconds; each step is announced before it begins.
void write_building(const BuildingOptions& options,
                    const std::function<void(const std::string& step)>& on_step = {});

}  // namespace sidestep
