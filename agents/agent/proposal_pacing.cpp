// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/proposal_pacing.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// Half a second at 60 cycles per second.
constexpr int kMaxLead = 30;
constexpr int kMaxSpare = 6;
// A spare cycle is added only after this many late versions in a row.
constexpr int kLateBeforeSpare = 2;
constexpr int kInTimeBeforeRelease = 10;

}  // namespace

void ProposalPacing::on_round_trip(Duration duration) {
  round_trips_[count_++ % kHistorySize] = duration;
  const std::size_t count = std::min(count_, kHistorySize);
  std::array<Duration, kHistorySize / 8 + 1> slowest{};
  slowest.fill(Duration::min());
  for (std::size_t i = 0; i < count; ++i) {
    // Insertion into the sorted list of the slowest round trips.
    Duration value = round_trips_[i];
    for (Duration& slot : slowest) {
      const Duration lower = std::min(slot, value);
      slot = std::max(slot, value);
      value = lower;
    }
  }
  slow_round_trip_ = slowest[count / 8];
  update();
}

void ProposalPacing::on_version_taken() {
  late_in_a_row_ = 0;
  if (++taken_in_a_row_ < kInTimeBeforeRelease) return;
  taken_in_a_row_ = 0;
  spare_cycles_ = std::max(0, spare_cycles_ - 1);
  update();
}

void ProposalPacing::on_version_late() {
  taken_in_a_row_ = 0;
  if (++late_in_a_row_ < kLateBeforeSpare) return;
  late_in_a_row_ = 0;
  spare_cycles_ = std::min(kMaxSpare, spare_cycles_ + 1);
  update();
}

void ProposalPacing::set_robot_lead(Duration lead) {
  if (lead == robot_lead_) return;
  robot_lead_ = lead;
  update();
}

void ProposalPacing::reset() {
  const Duration robot_lead = robot_lead_;
  *this = ProposalPacing(cycle_);
  set_robot_lead(robot_lead);
}

Duration ProposalPacing::answer_timeout() const { return std::max(cycle_, slow_round_trip_); }

void ProposalPacing::update() {
  // The command to the robot takes another half round trip.
  const Duration needed = slow_round_trip_ + slow_round_trip_ / 2 + robot_lead_;
  const auto cycles =
      static_cast<int>(std::min<std::int64_t>(kMaxLead, (needed + cycle_ - Duration{1}) / cycle_));
  lead_ = std::min(std::max(1, cycles) + spare_cycles_, kMaxLead);
}

}  // namespace sidestep
