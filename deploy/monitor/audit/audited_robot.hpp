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
#include "deploy/monitor/audit/message_trace.hpp"
#include "idl/negotiation.h"
#include "idl/robot.h"

namespace sidestep {

inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
inline constexpr std::int64_t kAlways = std::numeric_limits<std::int64_t>::min();

/// Why a fact says that a version will never be executed again.
enum class Excluded : std::uint8_t { kNo, kOlder, kLate, kFenced, kLifted };

/// The epochs in which something was registered: the highest of them, bounded in number.
class EpochMemory {
 public:
  void add(Epoch epoch);
  bool holds(Epoch epoch) const;
  /// Whether it may have been one of them: it is, or it has been given up.
  bool may_have_held(Epoch epoch) const { return holds(epoch) || (epoch != 0 && epoch <= given_up_); }

 private:
  std::array<Epoch, 16> epochs_{};  ///< descending; 0: none
  Epoch given_up_ = 0;              ///< the highest that is no longer held
};

/// What is known of one version. Times of sending are by the auditor's clock.
struct Known {
  // What is asked of most versions first, side by side in memory.
  VersionNumber number = 0;
  bool has_content = false;
  bool is_own = false;  ///< the firmware made it, off reference
  bool was_executed = false;
  Excluded excluded = Excluded::kNo;
  Epoch granted_in = 0;                      ///< or, for the firmware's own, whose ledger was seen to hold it
  std::int64_t granted_by_ns = kNever;       ///< the verdict, or that page, was not sent after
  std::int64_t executed_until_ns = kAlways;  ///< by the robot's clock, at least
  std::int64_t alive_until_ns = kAlways;     ///< until then, at least, no fact excluded it
  std::int64_t excluded_ns = kNever;
  AuditPath path;
  EpochMemory registered_in;
  std::int64_t sent_ns = kNever;    ///< the first command with it
  Epoch sent_epoch = 0;             ///< the highest that one came with
  bool is_granted_by_page = false;  ///< its verdict was not heard, but a page that holds it was
  bool is_reported_unsent = false;  ///< so that one breach is told once
  msg::Version version;

  bool is_in(Epoch epoch) const;
  /// The same as far as is known: a coordinator may wake up after more epochs than are remembered.
  bool may_be_in(Epoch epoch) const;
};

/// A proposal that was heard, and what is known of its verdict.
struct HeardProposal {
  std::uint64_t number = 0;
  Epoch epoch = 0;
  std::size_t count = 0;
  std::array<msg::Version, msg::MAX_CANDIDATES> candidates;
  bool is_ruled = false;  ///< a verdict that cannot change any more
  VersionNumber granted = 0;

  const msg::Version* find(VersionNumber version) const;
};

/// A verdict that cannot change any more, and whose proposal was not heard before it.
struct EarlyVerdict {
  std::uint64_t proposal = 0;
  Epoch epoch = 0;
  VersionNumber granted = 0;
};

/// What the auditor knows of one robot of the roster; bounded in size.
class AuditedRobot {
 public:
  static constexpr std::size_t kMostVersions = 64;
  static constexpr std::size_t kMostProposals = 16;

  RobotId id = 0;
  std::deque<Known> versions;  ///< ascending by number; most come at the end and go at the beginning
  std::array<HeardProposal, kMostProposals> proposals;
  std::uint64_t proposal_count = 0;
  std::array<EarlyVerdict, 8> early_verdicts;
  std::size_t early_verdict_count = 0;
  std::uint64_t given_up_proposal = 0;  ///< proposals up to this number may have been given up
  VersionNumber given_up_version = 0;   ///< and versions up to this one
  std::size_t first_recent = 0;         ///< versions before this index were excluded a while ago, so all that
                                        ///< facts do not exclude are from it on

  /// The latest fact.
  struct Fact {
    std::uint64_t life = 0;  ///< of the simulator
    std::int64_t at_ns = 0;
    std::int64_t earliest_ns = kAlways, latest_ns = kAlways;
    VersionNumber executing = 0;
    Incarnation obeyed = 0;
    Epoch epoch = 0;
    std::int64_t epoch_since_ns = kNever;  ///< it was reported by then
    bool is_off_reference = false;
    bool is_lifted = false;
  };
  std::optional<Fact> fact;
  std::int64_t beyond_since_ns = kNever;  ///< all facts since then say that it is beyond the tracking bound

  /// The latest registration.
  struct Registered {
    Epoch epoch = 0;
    Incarnation incarnation = 0;
    std::int64_t earliest_ns = 0, latest_ns = 0;
    std::vector<VersionNumber> versions;
    bool is_absent = false;
    bool is_reported = false;
  };
  std::optional<Registered> registered;
  EpochMemory registered_in;
  Epoch newest_granted_in = 0;
  VersionNumber newest_granted = 0;

  Known* find(VersionNumber number);
  const Known* find(VersionNumber number) const;
  /// The same for one that was at this index not long ago.
  const Known* find_near(std::size_t index, VersionNumber number) const;
  /// Whether nothing is known of the version because what was has been given up, as it may have been.
  bool has_given_up(VersionNumber number) const { return number <= given_up_version && !find(number); }
  /// The version's record, made if it was not there; makes room by giving up what can matter least.
  Known& note(VersionNumber number);
  HeardProposal* proposal(std::uint64_t number, VersionNumber candidate);
  /// Gives up what was excluded before then.
  void forget(std::int64_t before_ns);
  /// Sets first_recent: what was excluded before then is no longer compared with others'.
  void age(std::int64_t since_ns);
  /// More is known of this version: it is compared again.
  void make_recent(VersionNumber number);
  /// A place for one more proposal.
  HeardProposal& new_proposal();
  /// A new floor: nothing that was known holds for it.
  void start_again();
};

/// Whether the fact says that the version is never executed from now on, and why.
Excluded excluded_by(const AuditedRobot::Fact& fact, const Known& version);

/// What decides whether a version has to be compared with another robot's, close together in memory.
struct Live {
  double x = 0, y = 0, reach_m = 0;
  std::int64_t start_ns = 0, executed_until_ns = kAlways,
               granted_by_ns = kAlways;  ///< kAlways: was not granted
  std::uint32_t index = 0;               ///< in AuditedRobot::versions, when it was looked at
  VersionNumber number = 0;
};

/// A disc that holds some versions of a robot.
struct Whereabouts {
  double x = 0, y = 0, reach_m = -1;  ///< below 0: there are none

  void add(const Live& version);
};

/// Fills `live` with a robot's recent versions, and says where they lie.
Whereabouts look_at(const AuditedRobot& robot, std::vector<Live>& live);

}  // namespace sidestep
