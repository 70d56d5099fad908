// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "deploy/evaluation/study/table/study_table.hpp"

namespace sidestep {

struct BuildingsOptions {
  StudyOptions study;
  std::vector<std::string> scenario_files;
  std::vector<std::string> planners{"lazy-visibility", "errt", "estar", "nf1"};
  double seconds = 600;   ///< virtual time of each run, or real time
  bool over_dds = false;  ///< with a process for each part of the system
  int trials = 2;         ///< with consecutive seeds
};

/// Robots that drive to random places among people again and again, in the scenarios and by the planners of
/// the options. Prints the results, and writes buildings.csv and .png into the folder, which it creates.
/// Shows progress on stderr. Returns 1 if a goal was neither reached nor reported as blocked, anything was
/// touched by a moving robot, or an audit did not pass. Throws ConfigError for an invalid scenario, and
/// std::runtime_error that says what failed.
int study_buildings(const BuildingsOptions& options);

}  // namespace sidestep
