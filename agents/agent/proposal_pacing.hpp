// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/time/time.hpp"

namespace sidestep {

/// Decides how many cycles ahead an agent proposes. This is also the upper bound of the number of cycles for
/// which it holds an acceleration. The lead covers the network's round trip and the robot's own lead, plus
/// spare cycles for retries if messages are often lost.
class ProposalPacing {
 public:
  explicit ProposalPacing(Duration cycle) : cycle_(cycle) {}

  /// Records the time from a proposal to its verdict, including late verdicts.
  void on_round_trip(Duration duration);
  void on_version_taken();
  void on_version_late();
  /// Sets the minimum time from a version's arrival at the robot to the version's start.
  void set_robot_lead(Duration lead);
  /// Forgets all measured round trips, because another coordinator now answers.
  void reset();

  /// The lead in cycles.
  int lead() const { return lead_; }
  /// How long to wait for an answer before proposing again.
  Duration answer_timeout() const;

 private:
  static constexpr std::size_t kHistorySize = 16;
  void update();

  Duration cycle_;
  Duration robot_lead_{0};
  std::array<Duration, kHistorySize> round_trips_{};
  std::size_t count_ = 0;
  Duration slow_round_trip_{0};  // exceeded by at most one in eight round trips; 0: no round trip yet
  int taken_in_a_row_ = 0, late_in_a_row_ = 0;
  int spare_cycles_ = 0;
  int lead_ = 1;
};

}  // namespace sidestep
