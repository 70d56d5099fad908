// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "deploy/evaluation/study/buildings/building_run.hpp"

namespace sidestep {

/// The same run with a process for each part of the system, over DDS and in real time.
struct BuildingRunOverDds {
  std::string scenario_file;
  std::string planner;
  std::string folder;  ///< receives the scenario without goals, the report and the log
  Duration duration{};
  std::uint64_t seed = 1;
};

/// As run_building(), on a domain of its own on the loopback interface. Throws std::runtime_error that says
/// what failed, also if the run was aborted.
[[nodiscard]] BuildingResult run_building(const BuildingRunOverDds& run);

}  // namespace sidestep
