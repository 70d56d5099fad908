// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <vector>

#include "deploy/audit/auditor.hpp"
#include "tests/unit/deploy/audit/tampering.hpp"

namespace sidestep {

/// Robots 0 and 1 at rest on an empty floor of 6 m by 4 m, 2 m apart.
Scenario stage_scenario();

/// A run that a test composes message by message, with its audit. Each call sends one message, which the
/// auditor receives immediately. By default everything follows the protocol.
class Stage {
 public:
  static constexpr std::uint32_t kCoordinator = 10'000;    ///< sender id
  static constexpr Incarnation kProcessIncarnation = 500;  ///< of every process except the agents
  static constexpr Incarnation kAgent = 700;

  explicit Stage(Scenario staged = stage_scenario(), const AuditInput& input = kComplete);
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Every robot reports its rest, and its agent registers it.
  void begin();
  /// A robot's initial rest, version 0.
  msg::Version rest(RobotId robot) const;
  /// A version with this number that rests where `base` is and starts after `in`.
  msg::Version next(const msg::Version& base, VersionNumber number,
                    Duration in = std::chrono::milliseconds(50)) const;

  void advance(Duration duration);
  void report(RobotId robot);
  void report(const msg::Feedback& robot_report);
  void register_versions(RobotId robot, const std::vector<msg::Version>& versions);
  void propose(const std::vector<msg::Version>& candidates);
  void decide(RobotId robot, std::uint64_t proposal, VersionNumber granted,
              msg::Reason reason = msg::Reason::REASON_CONFLICT);
  /// Proposes the version alone and grants it.
  void grant(const msg::Version& version);
  void command(const msg::Version& version);
  /// Proposes, grants and commands the version, and executes it from its start on.
  void drive(const msg::Version& version);
  void show_page(const std::vector<msg::Version>& versions);

  /// The next message of a sender on a topic, sent now.
  msg::Header header(std::string_view topic, std::uint32_t sender,
                     Incarnation incarnation = kProcessIncarnation);
  std::uint64_t count(AuditRule rule) const;
  /// The violations, one per line.
  std::string lines() const;

  Scenario scenario;
  Time now{std::chrono::seconds(1000)};
  Epoch epoch = 5;  ///< of all messages except robot reports
  std::uint32_t coordinator = kCoordinator;
  Incarnation coordinator_incarnation = kProcessIncarnation;
  std::array<msg::Feedback, 2> robot_reports;  ///< what each robot reports next
  std::vector<Violation> violations;
  Auditor auditor;

 private:
  std::map<std::tuple<std::string_view, std::uint32_t, Incarnation>, std::uint64_t> sent_;
};

/// Checks that only this rule was broken, `expected` times.
void check_only(const Stage& stage, AuditRule rule, std::uint64_t expected);

/// Changes the version so that it reaches this speed along x within one second and brakes for another second.
msg::Version moving(msg::Version version, double speed_mps);

}  // namespace sidestep
