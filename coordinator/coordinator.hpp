// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/protocol/drop_counters.hpp"
#include "common/protocol/negotiation_messages.hpp"
#include "common/protocol/robot_messages.hpp"
#include "coordinator/displaced_robots.hpp"
#include "coordinator/ledger.hpp"

namespace sidestep {

/// Handles registration, verdicts and the ledger of one epoch; it is the only place where versions are
/// compared. Its grants do not depend on any clock; `now` is only used to detect silent robots. Messages may
/// be late, repeated or wrong; an invalid message changes nothing.
class Coordinator {
 public:
  /// With epoch 0 the coordinator stands by and answers no messages. `max_clock_difference` is the maximum
  /// difference between any two clocks of robots, cameras and this coordinator. `report_period` is the period
  /// at which robots report facts.
  Coordinator(const FloorRules& rules, std::vector<RobotId> roster, Epoch epoch,
              Duration max_clock_difference = sidestep::max_clock_difference(SafetyBudget{}.clock_bound_s),
              Duration report_period = {});

  /// Clears all state and begins an epoch, or stands by if `epoch` is 0.
  void begin_epoch(Epoch epoch);

  /// The answer to a proposal. nullopt while standing by, or if the robot is not on the roster.
  [[nodiscard]] std::optional<Verdict> on_proposal(const Proposal& proposal);
  /// The answer to a registration. It has proposal_number 0, and REASON_GRANTED if the agent is now
  /// registered. nullopt while standing by, or if the robot is not on the roster.
  std::optional<Verdict> on_registration(const Registration& registration);
  /// Processes a fact from a robot. Returns false if it contradicts the ledger; the robot is then
  /// quarantined, that is, nothing is granted to it until it is lifted or a new agent registers it.
  bool on_robot_report(const RobotReport& robot_report, Time now);
  /// Compares where vision sees the robots with the ledger. Nothing is granted to displaced robots.
  /// `is_whole` means that no observation of the world state was dropped. A world state does not count as
  /// supervision if any observation was dropped or cannot be compared.
  void on_world_state(std::span<const RobotObservation> robots, Time now, bool is_whole = true);
  /// Records the operator's attestation, valid in this epoch, that a robot is not on the floor. Returns false
  /// if the coordinator is not waiting for the robot's registration.
  bool on_attestation(RobotId robot);

  /// Holds or releases a robot, also in later epochs. Nothing is granted to a held robot, so it stops as its
  /// current version allows. Initially no robot is held.
  void set_held(RobotId robot, bool is_held) { held_[robot] = is_held; }

  /// Call when this coordinator's clock was set back: discards all recorded times and all accepted
  /// observations.
  void forget_times();

  bool is_active() const { return epoch_ != 0; }
  /// False until every robot on the roster has registered or its absence is attested.
  bool is_granting() const { return is_active() && unregistered_count_ == 0; }
  Epoch epoch() const { return epoch_; }
  const Ledger& ledger() const { return ledger_; }
  const DisplacedRobots& displaced() const { return displaced_; }
  /// Whether a robot that should be moving is silent: no fact has arrived for the longest of kMaxSilence,
  /// kMissedReports report periods and twice the longest recent gap, so robots do not count as silent on a
  /// slow network. A robot also counts as silent if all its versions start farther in the future than that.
  bool is_silent(RobotId robot) const { return records_[robot].silent; }
  static constexpr Duration kMaxSilence{50'000'000};
  static constexpr int kMissedReports = 3;
  /// Whether any robot is displaced or silent.
  bool has_uncontrolled_robots() const { return displaced_.any() || silent_count_ > 0; }

  msg::CoordinatorState state() const;
  /// Counts of messages that were not used, over all epochs.
  const DropCounters& drops() const { return drops_; }

 private:
  static constexpr std::size_t kVerdictHistory = 8;

  /// State of a robot's agent.
  struct Record {
    bool registered = false;
    bool attested = false;  // its absence is attested instead of a registration
    bool silent = false;
    std::optional<Time> heard_at;  // when the last fact arrived
    Duration longest_gap{0};       // longest recent gap between facts
    Incarnation incarnation = 0;
    Incarnation contradicted_incarnation =
        0;                            // latest agent that the robot obeyed when it contradicted the ledger
    VersionNumber newest_number = 0;  // highest version number proposed so far
    std::array<Verdict, kVerdictHistory> verdicts;
    std::uint64_t verdict_count = 0;  // number of verdicts in this incarnation
  };

  Record& record_of(RobotId robot) { return records_[robot]; }
  msg::Reason register_agent(const Registration& registration);
  /// Whether an agent's registration ends its robot's quarantine.
  bool ends_quarantine(const Registration& registration, const Record& record) const;
  const Verdict* find_verdict(const Record& record, VersionNumber proposal_number) const;
  void decide(const Proposal& proposal, Record& record, Verdict& verdict);
  msg::Reason refusal_reason(const Proposal& proposal, const Record& record) const;
  void find_silent(Time now);
  /// Why nothing is granted to a registered robot; REASON_GRANTED if nothing prevents grants.
  msg::Reason suspension_reason(RobotId robot) const;

  Ledger ledger_;
  DisplacedRobots displaced_;
  Duration max_clock_difference_, max_silence_;
  Time watched_until_{};  // time of the latest observation in a world state that was compared completely
  Epoch epoch_;
  std::size_t unregistered_count_, silent_count_ = 0;
  std::vector<Record> records_;  // indexed by robot
  std::vector<bool> held_;       // indexed by robot
  std::uint64_t proposals_ = 0, grants_ = 0, denials_ = 0;
  DropCounters drops_;
};

}  // namespace sidestep
