// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "deploy/audit/message_times.hpp"
#include "deploy/audit/robot_records.hpp"

namespace sidestep {

/// Checks that only one coordinator grants in an epoch, that it grants only after all robots have registered,
/// and that robots and agents never return to an earlier epoch.
class EpochAudit {
 public:
  EpochAudit(const AuditedRun& run, const MessageTimes& times, RobotRecords& robots, AuditFindings& findings)
      : run_(run), times_(times), robots_(robots), findings_(findings) {}

  void on_registration(AuditedRobot& robot, const msg::Registration& registration,
                       const Reception& reception);
  void on_attestation(AuditedRobot& robot) const;
  void on_coordinator(const msg::CoordinatorState& state, const Reception& reception);
  void on_grant(const AuditedRobot& robot, const KnownVersion& known, const msg::Verdict& verdict);
  void on_command(const AuditedRobot& robot, const msg::Command& command, const Reception& reception);
  /// Checks a report of an executed version against the epochs that the robot should obey.
  void check_obeyed(AuditedRobot& robot, const KnownVersion& executing, const msg::Feedback& feedback,
                    const Reception& reception);
  /// Whether the coordinator that grants in the page's epoch sent the page; true if that coordinator is
  /// unknown.
  bool is_from_granter(const msg::LedgerPage& page) const;
  /// Like is_from_granter(), but the page must also come from the sender of the epoch's first page.
  bool is_from_first_sender(const msg::LedgerPage& page);

 private:
  /// The auditor's record of one epoch.
  struct EpochRecord {
    std::uint32_t granter = 0;
    Incarnation granter_incarnation = 0;
    std::int64_t first_grant_ns = kNever;  ///< upper bound
    bool is_reported = false;
    Incarnation page_incarnation = 0;  ///< incarnation of the coordinator whose pages count
  };
  struct AgentStream {
    Incarnation incarnation = 0;
    Epoch epoch = 0;
  };

  EpochRecord& epoch_record(Epoch epoch);
  void check_registration(AuditedRobot& robot, const KnownVersion& executing, const msg::Feedback& feedback);
  /// Whether the robot certainly sent the report after its agent had sent the latest registration.
  bool is_after_registration(const AuditedRobot& robot, const msg::Feedback& feedback,
                             const Reception& reception) const;

  const AuditedRun& run_;
  const MessageTimes& times_;
  RobotRecords& robots_;
  AuditFindings& findings_;
  std::map<Epoch, EpochRecord> epochs_;
  Epoch newest_epoch_ = 0;  ///< the newest epoch that a coordinator has announced
  std::map<RobotId, std::vector<AgentStream>> streams_;
};

}  // namespace sidestep
