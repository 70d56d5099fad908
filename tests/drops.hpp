// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/protocol/drop_counters.hpp"

namespace sidestep {

/// The counts of messages that a class or node has dropped.
template <typename Counting>
DropCounters drops_of(const Counting& counting) {
  DropCounters drops;
  counting.count_drops(drops);
  return drops;
}

}  // namespace sidestep
