// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "deploy/audit/audit_rules.hpp"
#include "deploy/audit/coverage.hpp"

namespace sidestep {

/// kNotJudged means that nothing wrong was found, but the audit covered too little to declare the run passed,
/// or that its findings do not count.
enum class AuditVerdict : std::uint8_t { kPassed, kFailed, kNotJudged };

/// The exit code of a run that was not judged.
inline constexpr int kExitNotJudged = 3;
/// The exit code of a verdict; 0 if passed.
[[nodiscard]] int exit_code(AuditVerdict verdict);
/// "passed", "failed" or "not judged".
[[nodiscard]] const char* name_of(AuditVerdict verdict);

/// The source from which the auditor learns where robots are and which ones touch.
enum class AuditReference : std::uint8_t { kNone, kVision, kGroundTruth, kVisionThenGroundTruth };
/// For example "ground truth".
[[nodiscard]] const char* name_of(AuditReference reference);

/// The excused contacts of one pair (two robots, or a robot and an obstacle) that have one cause.
struct ExcusedContacts {
  std::string cause;
  RobotId first = 0;
  std::optional<RobotId> second;  ///< nullopt: an obstacle
  std::uint64_t contacts = 0;
};

/// The findings of an audit so far.
struct AuditTotals {
  static constexpr std::size_t kMaxKept = 20;

  std::uint64_t violations = 0;
  std::array<std::uint64_t, kAuditRules> by_rule{};
  std::vector<Violation> first;  ///< the first kMaxKept violations
  std::uint64_t received = 0;    ///< number of received messages
  std::uint64_t missed = 0;      ///< number of missed messages, inferred from gaps in message numbers
  std::uint64_t invalid = 0;     ///< number of malformed messages, which were dropped
  /// Number of messages from processes with different rules, see refuse_other_rules().
  std::uint64_t refused = 0;
  std::uint64_t compared_pairs = 0;  ///< number of pairs of versions whose clearance was checked
  /// Number of pairs that are too close but may be excused by a missed message.
  std::uint64_t undecided_pairs = 0;
  Coverage coverage;
  /// If the audit is too short for its coverage of versions to count: the number of executed versions that
  /// may have been granted before it joined; otherwise 0.
  std::uint64_t untraced_first_versions = 0;
  bool lacks_ledger = false;  ///< robots could move, but no page of the ledger was received
  /// Why violations do not count, e.g. because a process accepted a second simulator; empty: they count.
  std::string exemption;
  bool is_cut_off = false;  ///< the messages come from a recording that lacks an unknown part of the run
  /// Duration of the part of the run in which a silent robot lowers the coverage, see
  /// RunCoverage::begin_run().
  double run_s = 0;
  AuditReference reference = AuditReference::kNone;
  /// Largest distance of a robot from its reference while the robot was not off reference.
  double max_position_error_m = 0;
  std::uint64_t excused_crashes = 0;     ///< number of crashes of moving robots that a disturbance excuses
  std::uint64_t excused_contacts = 0;    ///< number of contacts that a disturbance of a robot excuses
  std::vector<ExcusedContacts> excused;  ///< the excused contacts, by cause and pair
  /// Number of contacts for which the reference did not name the robots.
  std::uint64_t unidentified_contacts = 0;
  std::uint64_t undecided_contacts = 0;  ///< number of contacts that a missed message may excuse
  /// Number of crashes of moving robots that a missed message may excuse.
  std::uint64_t undecided_crashes = 0;
  std::uint64_t excused_displacements = 0;  ///< number of position errors that a disturbance excuses
  double pair_s = 0;                        ///< observed time, summed over all pairs of robots on the floor
  double excused_pair_s = 0;                ///< the part of pair_s in which a contact would have been excused

  bool has_failed() const { return violations > 0 && exemption.empty(); }
  double excused_time_share() const { return pair_s > 0 ? excused_pair_s / pair_s : 0; }
  AuditVerdict verdict() const;
};

/// Why the audit does not judge the run unless it has failed, in one line: the exemption, or what the audit
/// did not cover. Empty if it judges the run.
[[nodiscard]] std::string shortfall(const AuditTotals& totals);
/// The verdict and its reason: "passed (coverage 99.7 %)" or "not judged: 34.5 % of the messages were
/// missed".
[[nodiscard]] std::string verdict_line(const AuditTotals& totals);

}  // namespace sidestep
