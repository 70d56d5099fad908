// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/motion/version.hpp"
#include "deploy/audit/audit_path.hpp"
#include "deploy/inspect/senders/message_trace.hpp"
#include "idl/negotiation.hpp"
#include "idl/robot.hpp"

namespace sidestep {

inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
inline constexpr std::int64_t kAlways = std::numeric_limits<std::int64_t>::min();
/// Versions that start this long after a robot's first report were certainly granted after that report, and
/// after an auditor that joined late had discovered all senders.
inline constexpr std::int64_t kMaxLead_ns = 2'000'000'000;

/// Why a robot's report proves that the robot no longer executes a version.
enum class Exclusion : std::uint8_t { kNone, kOlder, kLate, kFenced, kLifted };

/// The highest epochs in which a robot or a version was registered, at most 16.
class EpochMemory {
 public:
  void add(Epoch epoch);
  bool holds(Epoch epoch) const;
  bool is_empty() const { return epochs_.front() == 0; }
  /// Whether the epoch is held or may have been evicted.
  bool may_have_held(Epoch epoch) const { return holds(epoch) || (epoch != 0 && epoch <= max_evicted_); }

 private:
  std::array<Epoch, 16> epochs_{};  ///< descending; 0: unused
  Epoch max_evicted_ = 0;
};

/// The auditor's record of one version. Sending times are by the auditor's clock. Times of grants are by the
/// coordinator's clock if the auditor may miss messages.
struct KnownVersion {
  // The members that are read for most versions come first, so that they are adjacent in memory.
  VersionNumber number = 0;
  bool has_content = false;
  bool is_own_stop = false;  ///< made by the firmware when the robot was off its reference
  bool was_executed = false;
  Exclusion exclusion = Exclusion::kNone;
  Epoch granted_in = 0;                      ///< for an own stop: the epoch whose ledger page contained it
  std::int64_t granted_by_ns = kNever;       ///< upper bound of the sending time of the verdict or page
  std::int64_t executed_until_ns = kAlways;  ///< lower bound, by the robot's clock
  /// The ledger contained it at least until this time, by the clock that MessageTimes::granter_time_ns()
  /// uses.
  std::int64_t in_ledger_until_ns = kAlways;
  std::int64_t excluded_ns = kNever;
  // Information from ledger pages, with times by the coordinator's clock. Unused if the auditor receives
  // every message.
  Epoch listed_in = 0;                      ///< the latest epoch whose ledger pages listed it
  std::int64_t listed_from_ns = kNever;     ///< time of the first page that listed it
  std::int64_t entered_after_ns = kAlways;  ///< time of the last page before it was listed
  AuditPath path;
  EpochMemory registered_in;
  std::int64_t sent_ns = kNever;    ///< earliest sending time of the first command that contains it
  Epoch sent_epoch = 0;             ///< the highest epoch of the commands that contain it
  bool is_granted_by_page = false;  ///< inferred from a ledger page, because the verdict was missed
  bool is_proposed = false;         ///< its proposal was received, or may have been received and evicted
  bool is_reported_unsent = false;  ///< ensures that a violation is reported only once
  bool is_content_checked = false;  ///< its content was checked, also against its base
  bool is_pair_checked = false;     ///< checked against the other robots' versions in the ledger
  /// An earlier record of this number may have been evicted, and with it grants and registrations.
  bool may_be_incomplete = false;
  msg::Version version;

  /// Whether the version was granted or registered in the epoch.
  bool is_in(Epoch epoch) const;
  /// Whether a ledger is known to have contained the version.
  bool was_in_ledger() const { return number == 0 || granted_in != 0 || !registered_in.is_empty(); }
  /// Whether all messages about the version were received and checked: its proposal, its grant and a command.
  bool is_traced() const {
    return is_proposed && granted_in != 0 && sent_ns != kNever && is_content_checked && is_pair_checked;
  }
  /// Whether the version was, or may have been, granted or registered in the epoch. An old coordinator may
  /// resume after so many epochs that its own epoch is no longer remembered.
  bool may_be_in(Epoch epoch) const;
};

/// A received proposal and its verdict, if that is known.
struct ProposalRecord {
  std::uint64_t number = 0;
  std::int64_t stamp_ns = 0;  ///< by the agent's clock; the verdict repeats it
  Epoch epoch = 0;
  std::size_t count = 0;
  std::array<msg::Version, msg::MAX_CANDIDATES> candidates;
  bool is_decided = false;  ///< a final verdict was received
  VersionNumber granted = 0;

  const msg::Version* find(VersionNumber version) const;
};

/// A final verdict that arrived before its proposal.
struct EarlyVerdict {
  std::uint64_t proposal = 0;
  std::int64_t request_stamp_ns = 0;
  Epoch epoch = 0;
  VersionNumber granted = 0;
};

/// The auditor's record of one robot on the roster. Bounded in size.
class AuditedRobot {
 public:
  static constexpr std::size_t kMaxVersions = 64;
  static constexpr std::size_t kMaxProposals = 16;

  RobotId id = 0;
  std::deque<KnownVersion> versions;  ///< sorted by number; mostly appended at the back, removed at the front
  std::array<ProposalRecord, kMaxProposals> proposals;
  std::uint64_t proposal_count = 0;
  std::array<EarlyVerdict, 8> early_verdicts;
  std::size_t early_verdict_count = 0;
  std::uint64_t max_evicted_proposal = 0;  ///< proposals up to this number may have been evicted
  /// Up to this epoch, ledgers may contain versions that reset() forgot.
  Epoch forgotten_until_epoch = 0;
  VersionNumber max_evicted_version = 0;  ///< versions up to this number may have been evicted
  /// Versions that start later than this were granted during the audit.
  std::int64_t traceable_from_ns = kNever;
  std::size_t first_recent = 0;  ///< versions before this index were excluded long ago

  /// The latest report of the robot.
  struct ReceivedReport {
    std::uint64_t robot_incarnation = 0;  ///< incarnation of the robot
    std::int64_t at_ns = 0;
    bool is_clock_sound = false;  ///< the robot's clock was within its bound
    VersionNumber executing = 0;
    Incarnation obeyed_incarnation = 0;
    Epoch obeyed_epoch = 0;
    std::int64_t epoch_since_ns = kNever;  ///< upper bound of the time of the first report with this epoch
    /// If the robot is off the floor: the last version that it executed on the floor.
    VersionNumber last_executed = 0;
    bool is_off_reference = false;
    bool is_lifted = false;
  };
  std::optional<ReceivedReport> last_report;
  Time heard_at{};  ///< when the latest report arrived
  /// Times since which all reports have stated a tracking error beyond the drift bound and beyond the
  /// tracking bound.
  std::int64_t drifted_since_ns = kNever, beyond_bound_since_ns = kNever;
  /// The largest distance from the reference in the time that a robot may take to return since then.
  double max_drift_m = 0;

  /// The latest registration.
  struct Registered {
    Epoch epoch = 0;
    Incarnation incarnation = 0;
    std::int64_t earliest_ns = 0, latest_ns = 0;  ///< bounds of its sending time
    std::int64_t stamp_ns = 0;                    ///< its sending time by the agent's clock
    std::vector<VersionNumber> versions;
    bool is_absent = false;
    bool is_reported = false;  ///< ensures that a violation is reported only once
  };
  std::optional<Registered> registered;

  /// The robot's latest position from ground truth or vision that has not yet been compared with a report.
  struct Observation {
    std::int64_t at_ns = kNever;
    double x = 0, y = 0, reference_error_m = 0;  ///< reference_error_m comes from ground truth
  };
  Observation observation;
  EpochMemory registered_in;
  /// The latest ledger page that listed versions of the robot, with its time by the coordinator's clock.
  struct Listing {
    Epoch epoch = 0;
    std::int64_t at_ns = kAlways;
  };
  Listing listed;
  /// Offset of the robot's clock according to its last report; exact only if every message is received
  /// immediately.
  std::int64_t clock_ahead_ns = 0;
  /// Epochs up to this one may have begun without the robot's registration, because an operator attested its
  /// absence.
  Epoch attested_until = 0;
  Epoch attested_in = 0;  ///< the newest epoch at the time of the latest attestation

  /// Number of executed versions, and number of traced ones among them. Counts only versions that an agent
  /// made.
  struct ExecutedVersions {
    std::uint64_t all = 0, traced = 0;
    /// Counts the version if it starts later than `after_ns` and not later than `until_ns`.
    void add(const KnownVersion& version, std::int64_t after_ns, std::int64_t until_ns);
    ExecutedVersions& operator+=(const ExecutedVersions& others) {
      all += others.all;
      traced += others.traced;
      return *this;
    }
  };
  Epoch newest_granted_in = 0;
  VersionNumber newest_granted = 0;

  KnownVersion* find(VersionNumber number);
  const KnownVersion* find(VersionNumber number) const;
  /// Like find(), for a version that was recently at this index.
  const KnownVersion* find_near(std::size_t index, VersionNumber number) const;
  /// Whether a record of the version may have been evicted, so that nothing proves that the version was never
  /// granted or registered. A repeated registration or command may have inserted a new record since then.
  bool was_evicted(VersionNumber number) const;
  /// Whether all versions that the robot executed between two versions are known; `from` may equal `to`.
  bool continues(VersionNumber from, VersionNumber to) const;
  /// The version that was executed at this time by the robot's clock: `latest` or an earlier one; nullptr:
  /// unknown.
  const KnownVersion* executed_at(VersionNumber latest, std::int64_t at_ns) const;
  /// Distance of a position from the version that the robot executes; infinite if that version is unknown.
  double distance_from_version_m(const Vec2& position_m, std::int64_t at_ns) const;
  /// Versions that were granted during the audit.
  ExecutedVersions executed_versions() const;
  /// Versions to which the robot switched in the first kMaxLead_ns after its first report. Some may have been
  /// granted before the audit.
  ExecutedVersions first_executed_versions() const;
  /// The version's record, inserted if it is new. If there is no room, evicts the least relevant record.
  KnownVersion& find_or_insert(VersionNumber number);
  /// The newest proposal with this number. Several agents of a robot may use the same number, because a
  /// restarted agent does not know its predecessor's last numbers.
  ProposalRecord* find_proposal(std::uint64_t number);
  /// The proposal that was sent at this time by the agent's clock.
  ProposalRecord* find_proposal(std::uint64_t number, std::int64_t stamp_ns);
  /// The newest proposal that contains this candidate of the same agent.
  const ProposalRecord* find_proposal_of(const msg::Version& candidate) const;
  /// Removes versions that were excluded before `before_ns`.
  void forget(std::int64_t before_ns);
  /// Advances first_recent past versions excluded before `since_ns`, which are no longer compared.
  void advance_recent(std::int64_t since_ns);
  /// Moves first_recent back to this version, so that it is compared again with its new evidence.
  void make_recent(VersionNumber number);
  /// A slot for one more proposal. Evicts the oldest proposal if there is no room.
  ProposalRecord& add_proposal();
  /// Forgets the former floor's motions, because a new simulator starts with a new floor. What coordinators
  /// still rely on is kept: registrations, attestations, and which proposals may be answered.
  void reset();
  /// Forgets the times of reports and of the observation, because the robot's clock was set back.
  void forget_times();

 private:
  /// Remembers what is needed of a version that is about to be evicted.
  void note_evicted(const KnownVersion& version);

  bool has_evicted_ = false;                      ///< distinguishes an evicted version 0 from none
  ExecutedVersions forgotten_, forgotten_first_;  ///< counts of versions that are no longer in `versions`
};

/// Whether and why the report proves that the robot no longer executes the version.
[[nodiscard]] Exclusion exclusion_by(const AuditedRobot::ReceivedReport& robot_report,
                                     const KnownVersion& version);

/// The data of a version that decide whether it is compared with another version; compact in memory.
struct LiveVersion {
  double x = 0, y = 0, reach_m = 0;
  std::int64_t start_ns = 0, executed_until_ns = kAlways,
               granted_by_ns = kAlways;  ///< kAlways: not granted
  std::uint32_t index = 0;               ///< index in AuditedRobot::versions at the time of collection
  VersionNumber number = 0;
};

/// A disc that contains the paths of some versions of a robot.
struct BoundingDisc {
  double x = 0, y = 0, reach_m = -1;  ///< negative reach: empty

  void add(const LiveVersion& version);
};

/// Fills `live` with a robot's recent versions and returns their bounding disc.
BoundingDisc collect_live_versions(const AuditedRobot& robot, std::vector<LiveVersion>& live);

}  // namespace sidestep
