// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "deploy/trial/simulate/campaign/trial_result.hpp"

namespace sidestep {

/// The summary of a campaign. It does not depend on the order in which results are added.
class CampaignSummary {
 public:
  void add(const TrialResult& result) { results_[result.seed] = result; }

  std::size_t seeds() const { return results_.size(); }
  std::uint64_t failed() const;
  std::uint64_t contacts() const { return sum(&TrialResult::contacts); }
  double robot_hours() const;
  /// Number of excused contacts by cause.
  std::map<std::string, std::uint64_t> excused_by_cause() const;
  /// Number of trials with each kind of fault.
  std::map<std::string, std::uint64_t> trials_by_fault() const;
  struct Audited {
    std::uint64_t violations = 0;          ///< number of violations in trials that the audit judges
    std::uint64_t skipped_trials = 0;      ///< number of trials that the audit does not judge
    std::uint64_t skipped_violations = 0;  ///< number of violations in the skipped trials
  };
  Audited audited() const;
  /// Fraction of the time of all pairs of robots in which a contact would have been excused.
  double excused_time_share() const;

  /// The summary in a few lines of text.
  std::string text() const;
  std::string json() const;

 private:
  std::uint64_t sum(std::uint64_t TrialResult::*count) const;
  /// The seeds with the largest or smallest values, such as "seed 5 (0.3), seed 9 (0.2)".
  template <typename Value>
  std::string extremes(Value value, bool are_largest) const;

  std::map<std::uint64_t, TrialResult> results_;
};

/// Upper 95 % confidence bound of the rate of a Poisson process with this many events in this time; about
/// 3/time for no events.
[[nodiscard]] double upper_bound_95(std::uint64_t events, double time);

}  // namespace sidestep
