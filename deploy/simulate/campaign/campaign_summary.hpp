// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "deploy/simulate/campaign/trial.hpp"

namespace sidestep {

/// One line of JSON, and back.
std::string to_line(const TrialResult& result);
TrialResult result_from(const std::string& line);

/// Adds up what trials say; the order in which they come does not matter.
class SearchSummary {
 public:
  void add(const TrialResult& result) { results_[result.seed] = result; }

  std::size_t seeds() const { return results_.size(); }
  std::uint64_t failed() const;
  std::uint64_t contacts() const { return sum(&TrialResult::contacts); }
  double robot_hours() const;

  /// Some lines for people.
  std::string text() const;
  std::string json() const;

 private:
  std::uint64_t sum(std::uint64_t TrialResult::*count) const;
  /// Seeds with the largest or smallest values, "seed 5 (0.3), seed 9 (0.2)".
  template <typename Value>
  std::string extremes(Value value, bool are_largest) const;

  std::map<std::uint64_t, TrialResult> results_;
};

/// The rate above which so few events would be seen with a probability of less than 5 % (Poisson); 3/time for
/// none.
double upper_bound_95(std::uint64_t events, double time);

}  // namespace sidestep
