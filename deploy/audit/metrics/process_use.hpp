// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// Resources used by all processes of one name, that is, a process and its restarts.
struct ProcessUse {
  double cpu_s = 0;          ///< total processor time
  double max_memory_mb = 0;  ///< largest resident memory of any of the processes
};

}  // namespace sidestep
