// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>

namespace sidestep {

/// What this thread has computed so far: a machine that does something else now and then does not count.
inline double cpu_us() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e6 + static_cast<double>(time.tv_nsec) * 1e-3;
}

}  // namespace sidestep
