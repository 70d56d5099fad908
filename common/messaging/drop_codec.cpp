// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/drop_codec.hpp"

namespace sidestep {

static_assert(DropCounters::kCapacity <= msg::MAX_COUNTERS);

void encode(const DropCounters& drops, msg::Counters& message) {
  message.counts().clear();
  for (const DropCount& one : drops.counts()) {
    if (one.count == 0) continue;
    msg::Counter& counter = message.counts().emplace_back();
    counter.reason(static_cast<std::uint16_t>(one.reason));
    counter.robot(one.robot.value_or(msg::NO_ROBOT));
    counter.times(one.count);
  }
}

std::optional<std::vector<DropCount>> decode(const msg::Counters& message) {
  if (message.header().sender() != message.process() || message.counts().size() > msg::MAX_COUNTERS)
    return std::nullopt;
  std::vector<DropCount> counts;
  for (const msg::Counter& counter : message.counts()) {
    const bool has_robot = counter.robot() != msg::NO_ROBOT;
    if (counter.reason() >= kDropReasonCount || (has_robot && counter.robot() >= kMaxRobots))
      return std::nullopt;
    counts.push_back({static_cast<DropReason>(counter.reason()),
                      has_robot ? std::optional<RobotId>(counter.robot()) : std::nullopt, counter.times()});
  }
  return counts;
}

}  // namespace sidestep
