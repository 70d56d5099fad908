// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

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
  kHeld,
  kForgottenOrder,
};
inline constexpr std::size_t kAuditRules = static_cast<std::size_t>(AuditRule::kForgottenOrder) + 1;

struct AuditRuleInfo {
  const char* name;         ///< for example "clearance"
  const char* reference;    ///< the rule's location in coordinator/PROTOCOL.md or a page beside it
  const char* requirement;  ///< one sentence
};

const AuditRuleInfo& rule_info_of(AuditRule rule);

/// A violation of one rule.
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

/// The violation as one line of text.
std::string to_line(const Violation& violation);
/// The violation as one line of JSON.
std::string to_json_line(const Violation& violation);

}  // namespace sidestep
