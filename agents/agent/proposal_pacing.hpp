// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/time/time.hpp"

namespace sidestep {

/// How many cycles ahead an agent proposes, and holds an acceleration: as many as the network's round trips
/// take, and a few to spare, for asking again, where messages keep getting lost.
class ProposalPacing {
 public:
  explicit ProposalPacing(Duration cycle) : cycle_(cycle) {}

  /// From a proposal to its verdict, late ones too.
  void on_round_trip(Duration duration);
  void on_taken();
  void on_late();
  /// Forgets the network: another coordinator answers now.
  void reset();

  int lead() const { return lead_; }
  /// An answer that has not come after so long is not to be expected any more.
  Duration patience() const;

 private:
  static constexpr std::size_t kRoundTrips = 16;
  void update();

  Duration cycle_;
  std::array<Duration, kRoundTrips> round_trips_{};
  std::size_t count_ = 0;
  Duration slow_round_trip_{0};  // all but the slowest few are faster; zero until something is known
  int taken_in_a_row_ = 0, late_in_a_row_ = 0;
  int spare_ = 0;
  int lead_ = 1;
};

}  // namespace sidestep
