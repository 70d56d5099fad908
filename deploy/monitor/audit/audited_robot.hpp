// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "common/motion/version.hpp"
#include "deploy/monitor/audit/audit_path.hpp"
#include "deploy/monitor/senders/message_trace.hpp"
#include "idl/negotiation.hpp"
#include "idl/robot.hpp"

namespace sidestep {

inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
inline constexpr std::int64_t kAlways = std::numeric_limits<std::int64_t>::min();
/// Versions that begin this long after a robot's first fact were granted after that fact, and after an
/// auditor that joined a run had found all senders.
inline constexpr std::int64_t kMaxLead_ns = 2'000'000'000;

/// Why a fact rules out that a version is executed from then on.
enum class Exclusion : std::uint8_t { kNone, kOlder, kLate, kFenced, kLifted };

/// The highest epochs in which something was registered; bounded in number.
class EpochMemory {
 public:
  void add(Epoch epoch);
  bool holds(Epoch epoch) const;
  bool is_empty() const { return epochs_.front() == 0; }
  /// Whether the epoch is held or may have been evicted.
  bool may_have_held(Epoch epoch) const { return holds(epoch) || (epoch != 0 && epoch <= max_evicted_); }

 private:
  std::array<Epoch, 16> epochs_{};  ///< descending; 0: none
  Epoch max_evicted_ = 0;
};

/// What is known about one version. Sending times are by the auditor's clock; those of grants are by the
/// coordinator's clock if the auditor may miss messages.
struct KnownVersion {
  // The members that are read for most versions come first, adjacent in memory.
  VersionNumber number = 0;
  bool has_content = false;
  bool is_own_stop = false;  ///< made by the firmware when it lost its reference
  bool was_executed = false;
  Exclusion exclusion = Exclusion::kNone;
  Epoch granted_in = 0;                      ///< for an own stop: the epoch whose ledger page held it
  std::int64_t granted_by_ns = kNever;       ///< latest sending time of the verdict, or of that page
  std::int64_t executed_until_ns = kAlways;  ///< lower bound, by the robot's clock
  /// Lower bound of the time until which the ledger held it, see Auditor::granter_time_ns.
  std::int64_t alive_until_ns = kAlways;
  std::int64_t excluded_ns = kNever;
  // What pages of the ledger show, by the coordinator's clock. Unused if the auditor receives every message.
  Epoch listed_in = 0;                      ///< the latest epoch whose pages listed it
  std::int64_t listed_from_ns = kNever;     ///< the first page that listed it
  std::int64_t entered_after_ns = kAlways;  ///< the last page before that one without it
  AuditPath path;
  EpochMemory registered_in;
  std::int64_t sent_ns = kNever;    ///< earliest sending time of the first command that carries it
  Epoch sent_epoch = 0;             ///< the highest epoch of those commands
  bool is_granted_by_page = false;  ///< inferred from a ledger page, because the verdict was missed
  bool is_proposed = false;         ///< its proposal was received, or may have been evicted
  bool is_reported_unsent = false;  ///< so that a breach is reported once
  bool is_content_checked = false;  ///< against its base, too
  bool is_pair_checked = false;     ///< against the other robots' versions in the ledger
  msg::Version version;

  /// Whether it was granted or registered in the epoch.
  bool is_in(Epoch epoch) const;
  /// Whether a ledger has held it, as far as is known.
  bool was_in_ledger() const { return number == 0 || granted_in != 0 || !registered_in.is_empty(); }
  /// Whether its proposal, its grant and a command with it were received, and all that they are compared
  /// with.
  bool is_traced() const {
    return is_proposed && granted_in != 0 && sent_ns != kNever && is_content_checked && is_pair_checked;
  }
  /// Whether it is or may be in the epoch. A coordinator may resume after more epochs than are remembered.
  bool may_be_in(Epoch epoch) const;
};

/// A received proposal and what is known about its verdict.
struct ProposalRecord {
  std::uint64_t number = 0;
  std::int64_t stamp_ns = 0;  ///< by the agent's clock; its verdict repeats it
  Epoch epoch = 0;
  std::size_t count = 0;
  std::array<msg::Version, msg::MAX_CANDIDATES> candidates;
  bool is_decided = false;  ///< by a final verdict
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

/// What the auditor knows about one robot of the roster; bounded in size.
class AuditedRobot {
 public:
  static constexpr std::size_t kMaxVersions = 64;
  static constexpr std::size_t kMaxProposals = 16;

  RobotId id = 0;
  std::deque<KnownVersion>
      versions;  ///< ascending by number; mostly appended at the end, removed at the front
  std::array<ProposalRecord, kMaxProposals> proposals;
  std::uint64_t proposal_count = 0;
  std::array<EarlyVerdict, 8> early_verdicts;
  std::size_t early_verdict_count = 0;
  std::uint64_t max_evicted_proposal = 0;  ///< proposals up to this number may have been evicted
  Epoch forgotten_in = 0;                 ///< up to this epoch, ledgers may list versions that reset() forgot
  VersionNumber max_evicted_version = 0;  ///< versions up to this number may have been evicted
  std::int64_t traceable_from_ns = kNever;  ///< versions that start later were granted during the audit
  std::size_t first_recent = 0;             ///< versions before this index were excluded long ago

  /// The latest fact.
  struct Fact {
    std::uint64_t life = 0;  ///< incarnation of the robot
    std::int64_t at_ns = 0;
    std::int64_t earliest_ns = kAlways, latest_ns = kAlways;  ///< bounds of its sending time
    VersionNumber executing = 0;
    Incarnation obeyed_incarnation = 0;
    Epoch obeyed_epoch = 0;
    std::int64_t epoch_since_ns = kNever;  ///< upper bound of the time of the first fact with this epoch
    VersionNumber last_executed = 0;       ///< off the floor: the last version that it executed there
    bool is_off_reference = false;
    bool is_lifted = false;
  };
  std::optional<Fact> fact;
  Time heard_at{};  ///< when it arrived
  /// All facts since then report an error beyond the drift bound, and beyond the tracking bound.
  std::int64_t drifted_since_ns = kNever, beyond_bound_since_ns = kNever;

  /// The latest registration.
  struct Registered {
    Epoch epoch = 0;
    Incarnation incarnation = 0;
    std::int64_t earliest_ns = 0, latest_ns = 0;  ///< bounds of its sending time
    std::int64_t stamp_ns = 0;                    ///< its sending time by the agent's clock
    std::vector<VersionNumber> versions;
    bool is_absent = false;
    bool is_reported = false;  ///< so that a breach is reported once
  };
  std::optional<Registered> registered;
  EpochMemory registered_in;
  /// The latest page of the ledger that listed versions of the robot, by the coordinator's clock.
  struct Listing {
    Epoch epoch = 0;
    std::int64_t at_ns = kAlways;
  };
  Listing listed;
  /// Of the robot's clock, by its last fact. Exact only if the auditor receives everything at once.
  std::int64_t clock_ahead_ns = 0;
  /// An operator has attested its absence: epochs up to this one may have begun without its registration.
  Epoch attested_until = 0;
  Epoch attested_in = 0;  ///< the newest epoch that had begun when its absence was attested last

  /// Executed versions, and those of them that are traced. Only versions that an agent made and that were
  /// granted during the audit count.
  struct ExecutedVersions {
    std::uint64_t all = 0, traced = 0;
    void add(const KnownVersion& version, std::int64_t from_ns);
  };
  Epoch newest_granted_in = 0;
  VersionNumber newest_granted = 0;

  KnownVersion* find(VersionNumber number);
  const KnownVersion* find(VersionNumber number) const;
  /// The same for a version that recently was at this index.
  const KnownVersion* find_near(std::size_t index, VersionNumber number) const;
  /// Whether the version is unknown and may have been evicted.
  bool was_evicted(VersionNumber number) const { return number <= max_evicted_version && !find(number); }
  /// Whether all versions are known that the robot executed from one version to another, which may be equal.
  bool continues(VersionNumber from, VersionNumber to) const;
  /// Those of the robot's whole life.
  ExecutedVersions executed_versions() const;
  /// The version's record, inserted if it is new. When full, evicts the least relevant record.
  KnownVersion& find_or_insert(VersionNumber number);
  /// The newest proposal with this number. Those of several agents of the robot may share it: a restarted
  /// agent does not know the last numbers of the one before it.
  ProposalRecord* find_proposal(std::uint64_t number);
  /// The one that was sent at this time by the agent's clock.
  ProposalRecord* find_proposal(std::uint64_t number, std::int64_t stamp_ns);
  /// The newest proposal with this candidate of the same agent.
  const ProposalRecord* find_proposal_of(const msg::Version& candidate) const;
  /// Removes versions that were excluded before `before_ns`.
  void forget(std::int64_t before_ns);
  /// Advances first_recent past versions excluded before `since_ns`: they are no longer compared with other
  /// robots' versions.
  void advance_recent(std::int64_t since_ns);
  /// Moves first_recent back to this version, so that it is compared again with what is now known about it.
  void make_recent(VersionNumber number);
  /// Slot for one more proposal; evicts the oldest one when full.
  ProposalRecord& add_proposal();
  /// Forgets everything but the id and the counters: a new simulator starts with a new floor.
  void reset();
  /// Forgets the times of facts: the robot's clock was set back.
  void forget_times();

 private:
  ExecutedVersions forgotten_;
};

/// Whether and why the fact rules out that the version is executed from then on.
[[nodiscard]] Exclusion exclusion_by(const AuditedRobot::Fact& fact, const KnownVersion& version);

/// The part of a version that decides whether it must be compared with another robot's; compact in memory.
struct LiveVersion {
  double x = 0, y = 0, reach_m = 0;
  std::int64_t start_ns = 0, executed_until_ns = kAlways,
               granted_by_ns = kAlways;  ///< kAlways: not granted
  std::uint32_t index = 0;               ///< in AuditedRobot::versions, at the time of collection
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
