// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/blockage_monitor.hpp"

namespace sidestep {

void BlockageMonitor::clear() {
  blockage_.reset();
  since_.reset();
}

void BlockageMonitor::on_blocked(const Blockage& blockage, Time now) {
  blockage_ = blockage;
  if (!since_) since_ = now;
}

std::optional<Blockage> BlockageMonitor::lasting(Time now) const {
  const bool has_lasted = since_ && now - *since_ >= reported_after_;
  return has_lasted ? blockage_ : std::nullopt;
}

}  // namespace sidestep
