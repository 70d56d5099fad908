// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/time/time.hpp"

namespace sidestep {

struct SearchOptions {
  std::string scenario_file;  ///< empty: the floor is drawn, too
  std::string report_file;    ///< JSON; empty: none
  std::string results_file;   ///< where a search that was stopped goes on; empty: it does not
  std::uint64_t first_seed = 1, last_seed = 1;
  Duration duration = std::chrono::seconds(60);  ///< of virtual time, for each seed
  int jobs = 0;                                  ///< processes at work; 0: as many as there are cores
};

/// Runs one trial for each seed and prints what fails and how to run it again, and a summary. The exit code:
/// 0 when nothing has failed. Throws as simulate() does,
/// and std::runtime_error when the results' file is another search's.
int search_seeds(const SearchOptions& options);

}  // namespace sidestep
