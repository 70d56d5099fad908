// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/time/time.hpp"

namespace sidestep {

struct CampaignOptions {
  std::string scenario_file;  ///< empty: the scene is also random
  std::string report_file;    ///< JSON file; empty: none
  std::string results_file;   ///< an interrupted campaign resumes from this file; empty: none
  std::uint64_t first_seed = 1, last_seed = 1;
  Duration duration = std::chrono::seconds(60);  ///< virtual time per seed
  /// False: a control run without faults, in which no contact is excused.
  bool has_faults = true;
  int jobs = 0;  ///< number of worker processes; 0: number of cores
};

/// Runs one trial per seed. Prints every failure with the command that repeats it, and a summary. Returns the
/// exit code: 0 if no trial failed. Throws what simulate() throws, and std::runtime_error if the results file
/// belongs to another campaign.
int run_campaign(const CampaignOptions& options);

}  // namespace sidestep
