// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator.hpp"

#include <algorithm>

#include "common/messaging/observation_codec.hpp"
#include "common/motion/rest.hpp"

namespace sidestep {
namespace {

bool ends_at_rest(const Version& version) {
  return version.trajectory.residual_speed_mps() <= kPlannedRest_mps;
}

bool is_malformed(const Registration& registration) {
  return !registration.versions || !std::ranges::all_of(registration.versions->versions(), ends_at_rest);
}

}  // namespace

Coordinator::Coordinator(const FloorRules& rules, std::vector<RobotId> roster, Epoch epoch,
                         Duration max_clock_difference, Duration report_period)
    : ledger_(rules, std::move(roster), max_clock_difference),
      displaced_(rules.margin_m),
      max_clock_difference_(max_clock_difference),
      max_silence_(std::max(kMaxSilence, kMissedReports * report_period)),
      epoch_(epoch),
      unregistered_count_(ledger_.roster().size()),
      records_(kMaxRobots),
      held_(kMaxRobots) {}

void Coordinator::begin_epoch(Epoch epoch) {
  epoch_ = epoch;
  ledger_.clear();
  displaced_.clear();
  watched_until_ = {};
  for (Record& record : records_) record = {};
  unregistered_count_ = ledger_.roster().size();
  silent_count_ = 0;
}

void Coordinator::forget_times() {
  displaced_.clear();
  watched_until_ = {};
  for (Record& record : records_) record.heard_at.reset();
}

std::optional<Verdict> Coordinator::on_registration(const Registration& registration) {
  if (!is_active()) return std::nullopt;
  if (!ledger_.has_robot(registration.robot)) {
    drops_.count(DropReason::kUnknownRobot);
    return std::nullopt;
  }
  Verdict answer;
  answer.robot = registration.robot;
  answer.epoch = epoch_;
  answer.request_sent_at = registration.sent_at;
  answer.reasons.fill(register_agent(registration));
  if (const msg::Reason reason = answer.reasons.front(); reason != msg::Reason::REASON_GRANTED)
    drops_.count(reason == msg::Reason::REASON_MALFORMED ? DropReason::kMalformedRegistration
                                                         : DropReason::kRefusedRegistration,
                 registration.robot);
  return answer;
}

msg::Reason Coordinator::register_agent(const Registration& registration) {
  if (is_malformed(registration)) return msg::Reason::REASON_MALFORMED;
  if (registration.epoch != epoch_) return msg::Reason::REASON_WRONG_EPOCH;

  const RobotId robot = registration.robot;
  const std::span<const Version> versions = registration.versions->versions();
  Record& record = record_of(robot);
  const Incarnation agent = registration.incarnation;
  if (record.registered && agent == record.incarnation) return msg::Reason::REASON_GRANTED;
  if (record.registered && agent < record.incarnation) return msg::Reason::REASON_OLD_INCARNATION;
  const bool is_quarantined = ledger_.is_quarantined(robot);
  if (is_quarantined && !ends_quarantine(registration, record)) return msg::Reason::REASON_QUARANTINED;
  if (!record.registered || is_quarantined) {
    ledger_.register_robot(robot, versions);
    if (!record.registered && !record.attested) --unregistered_count_;
    record.registered = true;
    record.attested = false;
  } else {
    // The robot is registered already, so the ledger contains its versions. A new agent must not add other
    // versions without checks.
    const auto known = [&](const Version& v) {
      return std::ranges::any_of(ledger_.versions(robot),
                                 [&](const Version& w) { return w.number == v.number; });
    };
    if (!std::ranges::all_of(versions, known)) return msg::Reason::REASON_MALFORMED;
  }
  record.incarnation = agent;
  record.verdict_count = 0;
  return msg::Reason::REASON_GRANTED;
}

// Once a robot obeys a new agent, the only versions of earlier agents that it may still execute are listed in
// the registration. But the agent may have sent the registration before its robot contradicted the ledger.
bool Coordinator::ends_quarantine(const Registration& registration, const Record& record) const {
  return registration.incarnation > record.contradicted_incarnation ||
         ledger_.lists_reported(registration.robot, registration.versions->versions());
}

bool Coordinator::on_robot_report(const RobotReport& robot_report, Time now) {
  if (!is_active()) return true;
  if (!ledger_.has_robot(robot_report.robot) || !ends_at_rest(robot_report.executing)) {
    drops_.count(DropReason::kMalformedFeedback, robot_report.robot);
    return true;
  }
  Record& record = record_of(robot_report.robot);
  // The longest gap decays with every report.
  if (record.heard_at) record.longest_gap = std::max(now - *record.heard_at, record.longest_gap * 15 / 16);
  record.heard_at = now;
  if (!record.registered && !record.attested) return true;
  if (robot_report.is_absent()) {
    ledger_.on_lifted(robot_report.robot, robot_report.valid_at, robot_report.robot_incarnation);
    return true;
  }
  const bool is_of_higher_epoch = robot_report.obeyed_epoch > epoch_;
  if (is_of_higher_epoch &&
      ledger_.judge(robot_report.executing, robot_report.valid_at, robot_report.is_off_reference,
                    robot_report.robot_incarnation) == ReportOutcome::kContradiction) {
    drops_.count(DropReason::kFactOfHigherEpoch, robot_report.robot);
    return true;
  }
  const bool was_quarantined = ledger_.is_quarantined(robot_report.robot);
  const ReportOutcome outcome =
      ledger_.on_executing(robot_report.executing, robot_report.valid_at, robot_report.is_off_reference,
                           robot_report.robot_incarnation);
  if (outcome == ReportOutcome::kStale) drops_.count(DropReason::kLateFact, robot_report.robot);
  if (outcome != ReportOutcome::kContradiction) return true;
  drops_.count(DropReason::kContradictoryFact, robot_report.robot);
  record.contradicted_incarnation = std::max(
      was_quarantined ? record.contradicted_incarnation : Incarnation{0}, robot_report.obeyed_incarnation);
  return false;
}

void Coordinator::on_world_state(std::span<const RobotObservation> robots, Time now, bool is_whole) {
  if (!is_active()) return;
  find_silent(now);
  Time latest{};
  for (const RobotObservation& robot : robots) {
    if (!ledger_.has_robot(robot.robot)) continue;
    if (robot.observed_at > now + max_clock_difference_) {
      drops_.count(DropReason::kFutureObservation, robot.robot);
      is_whole = false;
      continue;
    }
    latest = std::max(latest, robot.observed_at);
    const Record& record = record_of(robot.robot);
    if (!record.registered && !record.attested) continue;
    // A silent robot need not be compared: other robots keep clear of it anyway.
    if (!displaced_.observe(robot, ledger_) && !record.silent) is_whole = false;
  }
  if (is_whole) watched_until_ = std::max(watched_until_, std::min(latest, now));
}

void Coordinator::find_silent(Time now) {
  silent_count_ = 0;
  for (const RobotId robot : ledger_.roster()) {
    Record& record = record_of(robot);
    const auto moves = [=, this](const Version& version) {
      return version.trajectory.end() + max_clock_difference_ > now;
    };
    const auto is_later = [=, this](const Version& version) {
      return version.trajectory.start() > now + max_silence_ + max_clock_difference_;
    };
    const auto versions = ledger_.versions(robot);
    const bool has_fallen_silent = record.heard_at &&
                                   now - *record.heard_at > std::max(max_silence_, 2 * record.longest_gap) &&
                                   std::ranges::any_of(versions, moves);
    // If the robot's clock has jumped ahead, its own stop starts in the future. Until that start the ledger
    // does not say where the robot is.
    const bool is_ahead = !versions.empty() && std::ranges::all_of(versions, is_later);
    record.silent = record.registered && (has_fallen_silent || is_ahead);
    silent_count_ += record.silent;
  }
}

bool Coordinator::on_attestation(RobotId robot) {
  if (!is_active() || !ledger_.has_robot(robot)) return false;
  Record& record = record_of(robot);
  if (record.registered || record.attested) return false;
  record.attested = true;
  --unregistered_count_;
  return true;
}

std::optional<Verdict> Coordinator::on_proposal(const Proposal& proposal) {
  if (!is_active()) return std::nullopt;
  if (!ledger_.has_robot(proposal.robot)) {
    drops_.count(DropReason::kUnknownRobot);
    return std::nullopt;
  }
  Record& record = record_of(proposal.robot);
  Verdict verdict;
  verdict.robot = proposal.robot;
  verdict.epoch = epoch_;
  verdict.proposal_number = proposal.number;
  verdict.request_sent_at = proposal.sent_at;
  if (const auto refusal = refusal_reason(proposal, record); refusal != msg::Reason::REASON_GRANTED) {
    drops_.count(refusal == msg::Reason::REASON_MALFORMED ? DropReason::kMalformedProposal
                                                          : DropReason::kRefusedProposal,
                 proposal.robot);
    verdict.reasons.fill(refusal);
    return verdict;
  }
  if (const Verdict* known = find_verdict(record, proposal.number)) {
    Verdict again = *known;
    again.request_sent_at = proposal.sent_at;
    return again;
  }
  if (const auto suspension = suspension_reason(proposal.robot); suspension != msg::Reason::REASON_GRANTED) {
    verdict.reasons.fill(suspension);
    return verdict;
  }
  ++proposals_;
  verdict.reasons.fill(msg::Reason::REASON_NOT_EVALUATED);
  decide(proposal, record, verdict);
  ++(verdict.granted_version ? grants_ : denials_);
  record.verdicts[record.verdict_count++ % kVerdictHistory] = verdict;
  return verdict;
}

msg::Reason Coordinator::refusal_reason(const Proposal& proposal, const Record& record) const {
  if (proposal.epoch != epoch_) return msg::Reason::REASON_WRONG_EPOCH;
  if (!is_granting() || proposal.incarnation > record.incarnation)
    return msg::Reason::REASON_NOT_ALL_REGISTERED;
  if (proposal.incarnation < record.incarnation) return msg::Reason::REASON_OLD_INCARNATION;
  if (proposal.candidate_count == 0) return msg::Reason::REASON_MALFORMED;
  return msg::Reason::REASON_GRANTED;
}

msg::Reason Coordinator::suspension_reason(RobotId robot) const {
  if (ledger_.is_quarantined(robot)) return msg::Reason::REASON_QUARANTINED;
  // Vision may see an absent robot while a person carries it. The coordinator may still grant a place to put
  // it down.
  const bool is_absent = ledger_.versions(robot).empty();
  if (is_absent) return msg::Reason::REASON_GRANTED;
  if (displaced_.contains(robot)) return msg::Reason::REASON_DISPLACED;
  return held_[robot] ? msg::Reason::REASON_HELD : msg::Reason::REASON_GRANTED;
}

const Verdict* Coordinator::find_verdict(const Record& record, VersionNumber proposal_number) const {
  const std::size_t count = std::min<std::size_t>(record.verdict_count, kVerdictHistory);
  for (std::size_t i = 0; i < count; ++i) {
    if (record.verdicts[i].proposal_number == proposal_number) return &record.verdicts[i];
  }
  return nullptr;
}

void Coordinator::decide(const Proposal& proposal, Record& record, Verdict& verdict) {
  for (std::size_t i = 0; i < proposal.candidate_count; ++i) {
    const std::optional<Version>& candidate = proposal.candidates[i];
    Ruling ruling{msg::Reason::REASON_MALFORMED};
    if (candidate && candidate->incarnation == record.incarnation) {
      ruling = candidate->number > record.newest_number ? ledger_.grant(*candidate)
                                                        : Ruling{msg::Reason::REASON_OLD_VERSION};
      record.newest_number = std::max(record.newest_number, candidate->number);
    }
    verdict.reasons[i] = ruling.reason;
    verdict.blockers[i] = ruling.blocker;
    if (ruling.is_granted()) {
      verdict.granted_version = candidate->number;
      break;
    }
  }
}

msg::CoordinatorState Coordinator::state() const {
  msg::CoordinatorState state;
  state.epoch(epoch_);
  state.coordinator_mode(!is_active()    ? msg::CoordinatorMode::COORDINATOR_STANDBY
                         : is_granting() ? msg::CoordinatorMode::COORDINATOR_GRANTING
                                         : msg::CoordinatorMode::COORDINATOR_REGISTERING);
  state.proposals(proposals_);
  state.grants(grants_);
  state.denials(denials_);
  const auto conflicts = ledger_.conflicts();
  state.conflicts(static_cast<std::uint32_t>(conflicts.size()));
  if (!conflicts.empty()) {
    state.conflict_first(conflicts.front().first);
    state.conflict_second(conflicts.front().second);
  }
  if (!is_active()) return state;
  state.watched_until_ns(to_ns(watched_until_));
  for (const RobotId robot : ledger_.roster()) {
    const Record& record = records_[robot];
    const bool is_missing = !record.registered && !record.attested;
    if (!is_missing && ledger_.versions(robot).empty()) state.absent(state.absent() + 1);
    msg::RobotNotice notice;
    notice.robot(robot);
    notice.is_missing(is_missing);
    notice.is_quarantined(ledger_.is_quarantined(robot));
    notice.is_displaced(displaced_.contains(robot));
    const auto seen = displaced_.last_observation(robot);
    notice.is_silent(record.silent && seen);
    if (is_uncontrolled(notice)) encode(*seen, notice);
    if (is_missing || notice.is_quarantined() || is_uncontrolled(notice)) state.notices().push_back(notice);
  }
  return state;
}

}  // namespace sidestep
