// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator.hpp"

#include <algorithm>

namespace sidestep {
namespace {

// A registered version must end at rest; speeds below this are rounding errors.
constexpr double kAtRest_mps = 1e-6;

bool ends_at_rest(const Version& version) { return version.trajectory.residual_speed_mps() <= kAtRest_mps; }

bool is_malformed(const Registration& registration) {
  return !registration.versions || !std::ranges::all_of(registration.versions->versions(), ends_at_rest);
}

}  // namespace

Coordinator::Coordinator(const FloorRules& rules, std::vector<RobotId> roster, Epoch epoch)
    : ledger_(rules, std::move(roster)),
      epoch_(epoch),
      unregistered_count_(ledger_.roster().size()),
      records_(kMaxRobots) {}

void Coordinator::begin_epoch(Epoch epoch) {
  epoch_ = epoch;
  contradicted_ = false;
  ledger_.clear();
  for (Record& record : records_) record = {};
  unregistered_count_ = ledger_.roster().size();
}

std::optional<Verdict> Coordinator::on_registration(const Registration& registration) {
  if (!is_active()) return std::nullopt;
  if (!ledger_.has_robot(registration.robot)) {
    ++invalid_;
    return std::nullopt;
  }
  Verdict answer;
  answer.robot = registration.robot;
  answer.epoch = epoch_;
  answer.request_sent_at = registration.sent_at;
  answer.reasons.fill(register_agent(registration));
  if (answer.reasons.front() == msg::Reason::REASON_MALFORMED) ++invalid_;
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
  if (!record.registered) {
    ledger_.register_robot(robot, versions);
    record.registered = true;
    --unregistered_count_;
  } else {
    // A new agent of a registered robot: the ledger already contains the robot's versions, and no others may
    // be added without checks.
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

void Coordinator::on_feedback(const Feedback& feedback) {
  if (!is_active()) return;
  if (!ledger_.has_robot(feedback.robot) || !ends_at_rest(feedback.executing)) {
    ++invalid_;
    return;
  }
  if (!record_of(feedback.robot).registered) return;
  if (feedback.is_absent()) {
    ledger_.on_lifted(feedback.robot, feedback.valid_at, feedback.robot_incarnation);
  } else if (ledger_.on_executing(feedback.executing, feedback.valid_at, feedback.is_off_reference,
                                  feedback.robot_incarnation) == FactOutcome::kContradiction) {
    contradicted_ = true;
  }
}

std::optional<Verdict> Coordinator::on_proposal(const Proposal& proposal) {
  if (!is_active()) return std::nullopt;
  if (!ledger_.has_robot(proposal.robot)) {
    ++invalid_;
    return std::nullopt;
  }
  Record& record = record_of(proposal.robot);
  Verdict verdict;
  verdict.robot = proposal.robot;
  verdict.epoch = epoch_;
  verdict.proposal_number = proposal.number;
  verdict.request_sent_at = proposal.sent_at;
  if (const auto refusal = refusal_reason(proposal, record); refusal != msg::Reason::REASON_GRANTED) {
    if (refusal == msg::Reason::REASON_MALFORMED) ++invalid_;
    verdict.reasons.fill(refusal);
    return verdict;
  }
  if (const Verdict* known = find_verdict(record, proposal.number)) {
    Verdict again = *known;
    again.request_sent_at = proposal.sent_at;
    return again;
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
  state.invalid(invalid_);
  const auto conflicts = ledger_.conflicts();
  state.conflicts(static_cast<std::uint32_t>(conflicts.size()));
  if (!conflicts.empty()) {
    state.conflict_first(conflicts.front().first);
    state.conflict_second(conflicts.front().second);
  }
  for (const RobotId robot : ledger_.roster()) {
    if (!is_active()) continue;
    if (!records_[robot].registered) {
      state.missing().push_back(robot);
    } else if (ledger_.versions(robot).empty()) {
      state.absent(state.absent() + 1);
    }
  }
  return state;
}

}  // namespace sidestep
