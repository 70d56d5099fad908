// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

/// What the processes of one name, i.e. a process and its restarts, have used.
struct ProcessUse {
  double cpu_s = 0;          ///< sum
  double max_memory_mb = 0;  ///< largest resident memory of one of them
};

}  // namespace sidestep
