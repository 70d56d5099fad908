// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/fault_schedule.hpp"

#include <algorithm>

namespace sidestep {

FaultSchedule::FaultSchedule(const std::vector<PlannedFault>& faults, Time zero)
    : faults_(faults), zero_(zero) {
  for (std::size_t i = 0; i < faults.size(); ++i) {
    events_.push_back({zero + from_seconds(faults[i].at_s), i, false});
    if (faults[i].seconds) events_.push_back({zero + from_seconds(faults[i].end_s()), i, true});
  }
  // Faults of the same time begin in the file's order.
  std::ranges::stable_sort(events_, {}, &Event::at);
}

}  // namespace sidestep
