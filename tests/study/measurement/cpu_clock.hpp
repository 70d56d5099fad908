// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>

#include "common/time/time.hpp"

namespace sidestep {

/// Processor time of the calling thread, in microseconds. It excludes other processes on the machine.
inline double cpu_us() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e6 + static_cast<double>(time.tv_nsec) * 1e-3;
}

/// The same clock as a Time, for a planner's budget.
inline Time cpu_time() { return time_from_ns(static_cast<std::int64_t>(1e3 * cpu_us())); }

}  // namespace sidestep
