// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/proposal_pacing.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// Half a second ahead is as far as it goes.
constexpr int kLongestLead = 30;
constexpr int kMostSpare = 6;
// One version that comes too late is bad luck, two in a row are a bad network.
constexpr int kLateToSpare = 2;
constexpr int kTakenToTrust = 10;

}  // namespace

void ProposalPacing::on_round_trip(Duration duration) {
  round_trips_[count_++ % kRoundTrips] = duration;
  const std::size_t count = std::min(count_, kRoundTrips);
  std::array<Duration, kRoundTrips / 8 + 1> slowest;
  slowest.fill(Duration::min());
  for (std::size_t i = 0; i < count; ++i) {
    Duration falling = round_trips_[i];
    for (Duration& place : slowest) {
      const Duration lower = std::min(place, falling);
      place = std::max(place, falling);
      falling = lower;
    }
  }
  slow_round_trip_ = slowest[count / 8];
  update();
}

void ProposalPacing::on_taken() {
  late_in_a_row_ = 0;
  if (++taken_in_a_row_ < kTakenToTrust) return;
  taken_in_a_row_ = 0;
  spare_ = std::max(0, spare_ - 1);
  update();
}

void ProposalPacing::on_late() {
  taken_in_a_row_ = 0;
  if (++late_in_a_row_ < kLateToSpare) return;
  late_in_a_row_ = 0;
  spare_ = std::min(kMostSpare, spare_ + 1);
  update();
}

void ProposalPacing::reset() { *this = ProposalPacing(cycle_); }

Duration ProposalPacing::patience() const { return std::max(cycle_, slow_round_trip_); }

void ProposalPacing::update() {
  // The command to the robot takes half a round trip more.
  const Duration needed = slow_round_trip_ + slow_round_trip_ / 2;
  const auto cycles =
      static_cast<int>(std::min<std::int64_t>(kLongestLead, (needed + cycle_ - Duration{1}) / cycle_));
  lead_ = std::min(std::max(1, cycles) + spare_, kLongestLead);
}

}  // namespace sidestep
