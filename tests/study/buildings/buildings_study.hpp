// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tests/study/table/study_table.hpp"

namespace sidestep {

struct BuildingsOptions {
  StudyOptions study;
  std::vector<std::string> scenario_files;
  std::vector<std::string> planners{"lazy-visibility", "errt", "estar", "nf1"};
  double seconds = 600;   ///< virtual or real time of each run
  bool over_dds = false;  ///< over DDS, with one process for each part of the system
  int trials = 2;         ///< number of trials with consecutive seeds
};

/// Studies robots that repeatedly drive to random places among people, in the given scenarios and with the
/// given planners. Prints the results, and writes buildings.csv and .png into the folder, which it creates.
/// Shows progress on stderr. Returns 1 if a goal was neither reached nor reported as blocked, anything was
/// touched by a moving robot, or an audit did not pass. Throws ConfigError for an invalid scenario, and
/// std::runtime_error if a run fails.
int study_buildings(const BuildingsOptions& options);

}  // namespace sidestep
