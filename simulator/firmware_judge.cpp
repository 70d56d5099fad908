// SPDX-License-Identifier: Apache-2.0
#include "simulator/firmware_judge.hpp"

#include <algorithm>

namespace sidestep {

void FirmwareJudge::command_arrived(const msg::Command& command, Time now) {
  const auto& granted = command.granted();
  const bool is_old_epoch = command.epoch() < acknowledged_epoch_;
  if (!command.has_version() || is_old_epoch || granted.start_ns() <= to_ns(now)) return;
  const Arrival arrival{granted.version_number(), granted.base(), granted.incarnation(),
                        time_from_ns(granted.start_ns())};
  if (arrival.number <= newest_ && came_in_time(arrival)) return;
  newest_ = std::max(newest_, arrival.number);
  arrivals_[static_cast<std::size_t>(arrival_count_++ % arrivals_.size())] = arrival;
}

bool FirmwareJudge::came_in_time(const Arrival& wanted) const {
  // Backwards from the latest, which is nearly always the one.
  for (std::uint64_t back = 1; back <= std::min<std::uint64_t>(arrival_count_, arrivals_.size()); ++back) {
    if (arrivals_[static_cast<std::size_t>((arrival_count_ - back) % arrivals_.size())] == wanted)
      return true;
  }
  return false;
}

void FirmwareJudge::switched(const Version& to) {
  require(to.base == executing_.number);
  require(to.number > executing_.number);
  require(came_in_time({to.number, to.base, to.incarnation, to.trajectory.start()}));
  require(to.incarnation >= executing_.incarnation && to.incarnation >= acknowledged_);
  require(to.trajectory.start() > last_fact_);
  const State& begins = to.trajectory.at_start();
  const State left = executing_.trajectory.state_at(to.trajectory.start());
  require((begins.position_m - left.position_m).norm() <= kPositionJump_m &&
          (begins.velocity_mps - left.velocity_mps).norm() <= kVelocityJump_mps);
  executing_ = to;
}

void FirmwareJudge::reported(const msg::Feedback& fact) {
  require(fact.executing().version_number() == executing_.number);
  require(fact.obeyed_incarnation() >= acknowledged_ && fact.obeyed_epoch() >= acknowledged_epoch_);
  require(executing_.trajectory.start() <= time_from_ns(fact.at_ns()));
  acknowledged_ = std::max(acknowledged_, static_cast<Incarnation>(fact.obeyed_incarnation()));
  acknowledged_epoch_ = std::max(acknowledged_epoch_, static_cast<Epoch>(fact.obeyed_epoch()));
  last_fact_ = std::max(last_fact_, time_from_ns(fact.at_ns()));
}

}  // namespace sidestep
