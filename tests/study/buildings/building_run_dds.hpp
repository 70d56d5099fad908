// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "tests/study/buildings/building_run.hpp"

namespace sidestep {

/// A building run over DDS, in real time and with one process for each part of the system.
struct BuildingRunOverDds {
  std::string scenario_file;
  std::string planner;
  std::string folder;  ///< for the scenario without goals, the report and the log
  Duration duration{};
  std::uint64_t seed = 1;
};

/// Like run_building() in building_run.hpp, but in a separate domain on the loopback interface. Throws
/// std::runtime_error if the run fails or is aborted.
[[nodiscard]] BuildingResult run_building(const BuildingRunOverDds& run);

}  // namespace sidestep
