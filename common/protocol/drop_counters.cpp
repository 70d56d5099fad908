// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/drop_counters.hpp"

#include <algorithm>

namespace sidestep {

DropCounters::DropCounters() {
  for (std::size_t i = 0; i < kDropReasonCount; ++i) counts_[i].reason = static_cast<DropReason>(i);
}

void DropCounters::count(DropReason reason, std::optional<RobotId> robot, std::uint64_t times) {
  if (times == 0) return;
  DropCount* place = &counts_[static_cast<std::size_t>(reason)];
  if (robot) {
    const auto end = counts_.begin() + static_cast<std::ptrdiff_t>(size_);
    const auto found = std::find_if(counts_.begin() + kDropReasonCount, end, [&](const DropCount& known) {
      return known.reason == reason && known.robot == robot;
    });
    if (found != end) {
      place = &*found;
    } else if (size_ < kCapacity) {
      place = &counts_[size_++];
      *place = {reason, robot, 0};
    }
  }
  place->count += times;
}

void DropCounters::add(const DropCounters& others) {
  for (const DropCount& one : others.counts()) count(one.reason, one.robot, one.count);
}

std::uint64_t DropCounters::total(DropReason reason) const {
  std::uint64_t sum = 0;
  for (const DropCount& one : counts()) sum += one.reason == reason ? one.count : 0;
  return sum;
}

std::uint64_t DropCounters::total() const {
  std::uint64_t sum = 0;
  for (const DropCount& one : counts()) sum += one.count;
  return sum;
}

}  // namespace sidestep
