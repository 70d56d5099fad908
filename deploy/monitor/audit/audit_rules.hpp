// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/motion/version.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// The rules that the auditor checks. audit_rule() gives each rule's name, requirement and reference.
enum class AuditRule : std::uint8_t {
  kClearance,
  kUniqueVersion,
  kBase,
  kContinuity,
  kLimits,
  kRest,
  kField,
  kObstacle,
  kInflation,
  kVersionOrder,
  kProposed,
  kAllRegistered,
  kSingleCoordinator,
  kLedgerPage,
  kRegistration,
  kAcknowledged,
  kForwarded,
  kEpochRegression,
  kSent,
  kSwitch,
  kLateSwitch,
  kStaleIncarnation,
  kStaleEpoch,
  kFacts,
  kOffReference,
  kTracking,
  kPosition,
  kContact,
  kCrash,
  kFirmwareMonitor,
};
inline constexpr std::size_t kAuditRules = static_cast<std::size_t>(AuditRule::kFirmwareMonitor) + 1;

struct AuditRuleInfo {
  const char* name;         ///< e.g. "clearance"
  const char* reference;    ///< the rule's place in coordinator/PROTOCOL.md
  const char* requirement;  ///< one sentence
};

const AuditRuleInfo& audit_rule(AuditRule rule);

/// One breach of one rule.
struct Violation {
  AuditRule rule = AuditRule::kClearance;
  Time detected{};  ///< when the evidence was complete, by the auditor's clock
  RobotId robot = 0;
  std::optional<RobotId> other;
  VersionNumber version = 0;
  VersionNumber other_version = 0;
  Epoch epoch = 0;
  std::string detail;  ///< the measured and the required values
};

/// One line of text.
std::string to_line(const Violation& violation);
/// One line of JSON.
std::string to_json_line(const Violation& violation);

/// The findings of an audit so far.
struct AuditTotals {
  static constexpr std::size_t kMaxKept = 20;

  std::uint64_t violations = 0;
  std::array<std::uint64_t, kAuditRules> by_rule{};
  std::vector<Violation> first;      ///< the first kMaxKept violations
  std::uint64_t received = 0;        ///< messages
  std::uint64_t missed = 0;          ///< messages, estimated from gaps in their numbers
  std::uint64_t invalid = 0;         ///< malformed messages, dropped
  std::uint64_t compared_pairs = 0;  ///< pairs of versions whose clearance was checked
  double max_position_error_m = 0;   ///< largest true distance of an on-reference robot from its reference
  std::uint64_t beyond_tracking_bound = 0;  ///< times that this distance exceeded the tracking bound
  std::uint64_t excused_contacts = 0;       ///< contacts of robots that were disturbed from outside
  std::uint64_t excused_displacements = 0;  ///< position errors of robots that were disturbed from outside
  std::uint64_t undecided_pairs = 0;  ///< pairs closer than required whose possible excuse was not received
};

}  // namespace sidestep
