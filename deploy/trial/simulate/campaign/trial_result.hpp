// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

namespace sidestep {

/// The outcome of a trial; it passed if `failures` is empty.
struct TrialResult {
  std::uint64_t seed = 0;
  std::vector<std::string> failures;
  std::set<std::string> fault_kinds;  ///< kinds of faults that were sampled
  std::uint64_t contacts = 0;         ///< number of contacts, excluding excused ones
  /// Number of contacts that a disturbance of a robot excuses.
  std::uint64_t excused_contacts = 0;
  std::map<std::string, std::uint64_t> excused_by_cause;  ///< the excused contacts, by cause
  double pair_s = 0;          ///< observed time, summed over all pairs of robots on the floor
  double excused_pair_s = 0;  ///< the part of pair_s in which a contact would have been excused
  /// Whether the audit judges the trial. It does not if a process accepted a second simulator because it had
  /// not heard the first one for a while: that process then breaks rules, which the audit reports
  /// (PROTOCOL.md, "Processes that must be alone").
  bool is_audited = true;
  std::uint64_t audit_violations = 0, firmware_violations = 0;
  std::uint64_t proposals = 0, grants = 0, denials = 0;
  double robot_s = 0;     ///< number of robots times simulated time
  double distance_m = 0;  ///< distance driven by all robots together
  double distance_after_recovery_m =
      0;  ///< the part of distance_m after the end of all faults and a recovery time
  int robots = 0;
  int stationary = 0;  ///< number of robots that did not move after the recovery time
  double min_clearance_m = 1e9;
  double wall_s = 0;
};

nlohmann::ordered_json to_json(const TrialResult& result);

/// The result as one line of JSON.
std::string to_line(const TrialResult& result);
/// The inverse of to_line(). Throws nlohmann::json::exception for any other text.
[[nodiscard]] TrialResult parse_trial_result(const std::string& line);

}  // namespace sidestep
