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

/// What the auditor judges by; audit_rule() says what each one demands, and where the protocol says so.
enum class AuditRule : std::uint8_t {
  kClearance,
  kOneMeaning,
  kBase,
  kContinuity,
  kLimits,
  kRest,
  kFloor,
  kObstacle,
  kInflation,
  kNumbers,
  kProposed,
  kAllRegistered,
  kOneCoordinator,
  kLedgerPage,
  kRegistration,
  kAcknowledged,
  kForwarded,
  kEpochBack,
  kSent,
  kSwitch,
  kLate,
  kFenced,
  kOldEpoch,
  kFacts,
  kOffReference,
  kTracking,
  kPlace,
  kContact,
  kCrash,
  kFirmwareMonitor,
};
inline constexpr std::size_t kAuditRules = static_cast<std::size_t>(AuditRule::kFirmwareMonitor) + 1;

struct AuditRuleInfo {
  const char* name;       ///< e.g. "clearance"
  const char* reference;  ///< of the rule in coordinator/PROTOCOL.md
  const char* demand;     ///< in words
};

const AuditRuleInfo& audit_rule(AuditRule rule);

/// One breach of one rule.
struct Violation {
  AuditRule rule = AuditRule::kClearance;
  Time heard{};  ///< when the auditor had the evidence together, by its own clock
  RobotId robot = 0;
  std::optional<RobotId> other;
  VersionNumber version = 0;
  VersionNumber other_version = 0;
  Epoch epoch = 0;
  std::string what;  ///< the numbers, in words
};

/// One line for people.
std::string to_line(const Violation& violation);
/// One line of JSON.
std::string to_json_line(const Violation& violation);

/// What came of an audit so far.
struct AuditTotals {
  static constexpr std::size_t kMostKept = 20;

  std::uint64_t violations = 0;
  std::array<std::uint64_t, kAuditRules> by_rule{};
  std::vector<Violation> first;  ///< the first kMostKept of them
  std::uint64_t heard = 0;       ///< messages
  std::uint64_t missed = 0;      ///< messages, as far as gaps in their numbers show
  std::uint64_t invalid = 0;     ///< messages that made no sense and were dropped
  std::uint64_t pairs = 0;       ///< pairs of versions that were compared
  double farthest_m = 0;         ///< that a robot on its reference really was from it
  std::uint64_t beyond = 0;      ///< how often that was more than the tracking bound, unnoticed by the robot
  std::uint64_t contacts_by_hand = 0;  ///< contacts of robots that somebody had just disturbed,
  std::uint64_t places_by_hand = 0;    ///< and how often those were not where they ought to be
  std::uint64_t unjudged = 0;  ///< pairs too near to each other, for which what would excuse it was not heard
};

}  // namespace sidestep
