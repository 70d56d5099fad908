// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/time/time.hpp"

namespace sidestep {

struct CampaignOptions {
  std::string scenario_file;  ///< empty: the scene is random, too
  std::string report_file;    ///< JSON; empty: none
  std::string results_file;   ///< an interrupted campaign resumes from this file; empty: none
  std::uint64_t first_seed = 1, last_seed = 1;
  Duration duration = std::chrono::seconds(60);  ///< virtual time per seed
  bool has_faults = true;                        ///< false: a control run, in which contacts have no excuse
  int jobs = 0;                                  ///< number of worker processes; 0: number of cores
};

/// Runs one trial per seed. Prints every failure with the command that repeats it, and a summary. Returns the
/// exit code: 0 if no trial failed. Throws as simulate() does, and std::runtime_error when the results file
/// belongs to another campaign.
int run_campaign(const CampaignOptions& options);

}  // namespace sidestep
