// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator.hpp"

#include <algorithm>

#include "common/messaging/codec.hpp"

namespace sidestep {
namespace {

// A registered version must end at rest; speeds below this are rounding errors.
constexpr double kAtRest_mps = 1e-6;

bool ends_at_rest(const Version& version) { return version.trajectory.residual_speed_mps() <= kAtRest_mps; }

/// The registered versions; nullopt if the registration is malformed.
std::optional<std::vector<Version>> versions_of(const msg::Registration& registration) {
  if (registration.is_absent() != (registration.version_count() == 0)) return std::nullopt;
  if (registration.version_count() > VersionSet::kCapacity) return std::nullopt;
  std::vector<Version> versions;
  for (std::size_t i = 0; i < registration.version_count(); ++i) {
    const auto version = decode(registration.versions()[i]);
    const auto is_same = [&](const Version& other) { return other.number == version->number; };
    if (!version || version->robot != registration.robot() || !ends_at_rest(*version) ||
        std::ranges::any_of(versions, is_same)) {
      return std::nullopt;
    }
    versions.push_back(*version);
  }
  return versions;
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

std::optional<msg::Verdict> Coordinator::on_registration(const msg::Registration& registration) {
  if (!is_active()) return std::nullopt;
  if (!ledger_.has_robot(registration.robot()) || registration.header().sender() != registration.robot()) {
    ++invalid_;
    return std::nullopt;
  }
  msg::Verdict answer;
  answer.robot(registration.robot());
  answer.epoch(epoch_);
  answer.request_stamp_ns(registration.header().stamp_ns());
  answer.reasons().fill(register_agent(registration));
  if (answer.reasons().front() == msg::REASON_MALFORMED) ++invalid_;
  return answer;
}

msg::Reason Coordinator::register_agent(const msg::Registration& registration) {
  const RobotId robot = registration.robot();
  const auto versions = versions_of(registration);
  if (!versions) return msg::REASON_MALFORMED;
  if (registration.epoch() != epoch_) return msg::REASON_WRONG_EPOCH;

  Record& record = record_of(robot);
  const Incarnation agent = registration.header().incarnation();
  if (record.registered && agent == record.incarnation) return msg::REASON_GRANTED;
  if (record.registered && agent < record.incarnation) return msg::REASON_OLD_INCARNATION;
  if (!record.registered) {
    ledger_.register_robot(robot, *versions);
    record.registered = true;
    --unregistered_count_;
  } else {
    // A new agent of a registered robot: the ledger already contains the robot's versions, and no others may
    // be added without checks.
    const auto known = [&](const Version& v) {
      return std::ranges::any_of(ledger_.versions(robot),
                                 [&](const Version& w) { return w.number == v.number; });
    };
    if (!std::ranges::all_of(*versions, known)) return msg::REASON_MALFORMED;
  }
  record.incarnation = agent;
  record.verdict_count = 0;
  return msg::REASON_GRANTED;
}

void Coordinator::on_feedback(const msg::Feedback& feedback) {
  const RobotId robot = feedback.robot();
  if (!is_active()) return;
  const auto executing = decode(feedback.executing());
  const bool is_sound = ledger_.has_robot(robot) && feedback.header().sender() == robot && executing &&
                        executing->robot == robot && ends_at_rest(*executing);
  if (!is_sound) {
    ++invalid_;
    return;
  }
  if (!record_of(robot).registered) return;
  const Time at = time_from_ns(feedback.valid_at_ns());
  if (feedback.is_lifted() && executing->number == 0) {
    ledger_.on_lifted(robot, at);
  } else if (ledger_.on_executing(*executing, at, feedback.is_off_reference()) ==
             FactOutcome::kContradiction) {
    contradicted_ = true;
  }
}

std::optional<msg::Verdict> Coordinator::on_proposal(const msg::Proposal& proposal) {
  const RobotId robot = proposal.robot();
  if (!is_active()) return std::nullopt;
  if (!ledger_.has_robot(robot) || proposal.header().sender() != robot) {
    ++invalid_;
    return std::nullopt;
  }
  Record& record = record_of(robot);
  msg::Verdict verdict;
  verdict.robot(robot);
  verdict.epoch(epoch_);
  verdict.proposal_number(proposal.candidates().front().version_number());
  verdict.request_stamp_ns(proposal.header().stamp_ns());
  verdict.granted_version(0);
  if (const auto refusal = refusal_reason(proposal, record); refusal != msg::REASON_GRANTED) {
    if (refusal == msg::REASON_MALFORMED) ++invalid_;
    verdict.reasons().fill(refusal);
    return verdict;
  }
  if (const msg::Verdict* known = find_verdict(record, verdict.proposal_number())) {
    msg::Verdict again = *known;
    again.request_stamp_ns(verdict.request_stamp_ns());
    return again;
  }
  ++proposals_;
  verdict.reasons().fill(msg::REASON_NOT_EVALUATED);
  decide(proposal, record, verdict);
  ++(verdict.granted_version() ? grants_ : denials_);
  record.verdicts[record.verdict_count++ % kVerdictHistory] = verdict;
  return verdict;
}

msg::Reason Coordinator::refusal_reason(const msg::Proposal& proposal, const Record& record) const {
  if (proposal.epoch() != epoch_) return msg::REASON_WRONG_EPOCH;
  if (!is_granting() || proposal.header().incarnation() > record.incarnation)
    return msg::REASON_NOT_ALL_REGISTERED;
  if (proposal.header().incarnation() < record.incarnation) return msg::REASON_OLD_INCARNATION;
  if (proposal.candidate_count() == 0 || proposal.candidate_count() > msg::MAX_CANDIDATES) {
    return msg::REASON_MALFORMED;
  }
  return msg::REASON_GRANTED;
}

const msg::Verdict* Coordinator::find_verdict(const Record& record, std::uint64_t proposal_number) const {
  const std::size_t count = std::min<std::size_t>(record.verdict_count, kVerdictHistory);
  for (std::size_t i = 0; i < count; ++i) {
    if (record.verdicts[i].proposal_number() == proposal_number) return &record.verdicts[i];
  }
  return nullptr;
}

void Coordinator::decide(const msg::Proposal& proposal, Record& record, msg::Verdict& verdict) {
  const auto& first = proposal.candidates().front();
  for (std::size_t i = 0; i < proposal.candidate_count(); ++i) {
    const auto& message = proposal.candidates()[i];
    const auto candidate = decode(message);
    Ruling ruling{msg::REASON_MALFORMED};
    if (candidate && candidate->robot == proposal.robot() && candidate->incarnation == record.incarnation &&
        message.base() == first.base() && message.start_ns() == first.start_ns()) {
      ruling = candidate->number > record.newest_number ? ledger_.grant(*candidate)
                                                        : Ruling{msg::REASON_OLD_VERSION};
      record.newest_number = std::max(record.newest_number, candidate->number);
    }
    verdict.reasons()[i] = ruling.reason;
    verdict.blockers()[i] = ruling.blocker;
    if (ruling.is_granted()) {
      verdict.granted_version(candidate->number);
      break;
    }
  }
}

msg::CoordinatorState Coordinator::state() const {
  msg::CoordinatorState state;
  state.epoch(epoch_);
  state.coordinator_mode(!is_active()    ? msg::COORDINATOR_STANDBY
                         : is_granting() ? msg::COORDINATOR_GRANTING
                                         : msg::COORDINATOR_REGISTERING);
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
