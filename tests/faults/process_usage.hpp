// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <sys/types.h>
#include <vector>

#include "tests/faults/launched_run.hpp"

namespace sidestep {

/// The resources that a process uses, as counted by the kernel.
struct ProcessUsage {
  double memory_mb = 0;  ///< resident memory
  double cpu_s = 0;      ///< processor time since the process's start
};

/// Throws std::runtime_error if no process has this id.
ProcessUsage usage_of(pid_t pid);

/// The resources used by every process of the run, including the launcher, by name.
std::map<std::string, ProcessUsage> usage_of(const LaunchedRun& run);

struct MemorySample {
  double time_s = 0, memory_mb = 0;
};

/// Slope of the least-squares line through the samples, in MB per hour. Precondition: two samples at
/// different times.
double memory_slope_mb_per_h(const std::vector<MemorySample>& samples);

}  // namespace sidestep
