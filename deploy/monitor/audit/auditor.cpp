// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/auditor.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace sidestep {
namespace {

constexpr std::size_t kMostEpochs = 64;
constexpr RobotId kMostRobots = 1024;

}  // namespace

Auditor::Auditor(const Scenario& scenario, const AuditTrace& hearing)
    : scenario_(scenario),
      how_(hearing),
      tracking_bound_m_(scenario.tracking_bound_m),
      clock_bound_ns_(from_seconds(scenario.clock_bound_s).count()),
      hearing_(hearing.is_complete ? Duration{0} : hearing.fastest),
      places_m_(scenario.robots.size()),
      hands_(scenario.robots.size(), hearing.is_complete),
      index_(kMostRobots, scenario.robots.size()) {
  for (const RobotSpec& spec : scenario.robots) {
    index_.at(spec.id) = robots_.size();
    robots_.emplace_back().id = spec.id;
  }
  whereabouts_.resize(robots_.size());
  live_.resize(robots_.size());
  sights_.resize(robots_.size());
  has_sound_clock_.resize(robots_.size());
}

AuditTotals Auditor::totals() const {
  AuditTotals totals = totals_;
  totals.heard = hearing_.heard();
  totals.missed = hearing_.missed();
  return totals;
}

void Auditor::report(AuditRule rule, RobotId robot, const Known* known, Epoch epoch, std::string what) {
  Violation violation;
  violation.rule = rule;
  violation.robot = robot;
  violation.version = known ? known->number : 0;
  violation.epoch = epoch;
  violation.what = std::move(what);
  report(std::move(violation));
}

void Auditor::report(Violation violation) {
  violation.heard = now_;
  ++totals_.violations;
  ++totals_.by_rule[static_cast<std::size_t>(violation.rule)];
  if (totals_.first.size() < AuditTotals::kMostKept) totals_.first.push_back(violation);
  if (on_violation_) on_violation_(violation);
}

AuditedRobot* Auditor::robot_of(std::uint32_t robot, const msg::Header& head) {
  if (robot < kMostRobots && index_[robot] < robots_.size() && head.sender() == robot)
    return &robots_[index_[robot]];
  ++totals_.invalid;
  return nullptr;
}

Heard Auditor::note(Kind kind, std::uint32_t key, const msg::Header& head) {
  return hearing_.note(static_cast<std::uint64_t>(kind) << 32 | key, head, now_);
}

Known* Auditor::learn(AuditedRobot& robot, const msg::Version& version) {
  if (version.robot() != robot.id || !is_sane(version)) {
    ++totals_.invalid;
    return nullptr;
  }
  Known& known = robot.note(version.version_number());
  if (!known.has_content) {
    known.has_content = true;
    known.version = version;
    known.path = AuditPath(version);
    max_inflation_m_ = std::max(max_inflation_m_, version.inflation_m());
    // A fact may have excluded it before it was heard of.
    if (robot.fact) known.excluded = excluded_by(*robot.fact, known);
    known.excluded_ns = known.excluded == Excluded::kNo ? kNever : to_ns(now_);
    robot.make_recent(known.number);
  } else if (!(known.version == version)) {
    report(
        AuditRule::kOneMeaning, robot.id, &known, 0,
        fmt::format("starts at {} ns from ({:.6f}, {:.6f}) m, and elsewhere at {} ns from ({:.6f}, {:.6f}) m",
                    known.version.start_ns(), known.version.x_m(), known.version.y_m(), version.start_ns(),
                    version.x_m(), version.y_m()));
  }
  return &known;
}

Auditor::EpochRecord& Auditor::epoch_record(Epoch epoch) {
  const auto at = epochs_.try_emplace(epoch).first;
  if (epochs_.size() > kMostEpochs) epochs_.erase(at == epochs_.begin() ? std::next(at) : epochs_.begin());
  return at->second;
}

void Auditor::on_proposal(const msg::Proposal& proposal, Time now) {
  now_ = now;
  AuditedRobot* robot = robot_of(proposal.robot(), proposal.head());
  if (!robot) return;
  (void)note(kProposalKind, proposal.robot(), proposal.head());
  if (proposal.candidate_count() == 0 || proposal.candidate_count() > msg::MAX_CANDIDATES) {
    ++totals_.invalid;
    return;
  }
  const std::uint64_t number = proposal.candidates().front().version_number();
  if (robot->proposal(number, 0)) return;
  HeardProposal& heard = robot->new_proposal();
  heard.number = number;
  heard.epoch = proposal.epoch();
  heard.count = proposal.candidate_count();
  for (std::size_t i = 0; i < heard.count; ++i) {
    heard.candidates[i] = proposal.candidates()[i];
    // Its verdict may have overtaken it.
    Known* known = robot->find(heard.candidates[i].version_number());
    if (!known || known->has_content || known->granted_in == 0) continue;
    if (Known* learnt = learn(*robot, heard.candidates[i])) {
      judge_content(*robot, *learnt);
      judge_new_pairs_of(*robot, *learnt);
    }
  }
  for (const EarlyVerdict& verdict : robot->early_verdicts) {
    if (verdict.proposal == number) rule(*robot, heard, verdict.epoch, verdict.granted);
  }
}

void Auditor::on_registration(const msg::Registration& registration, Time now) {
  now_ = now;
  AuditedRobot* robot = robot_of(registration.robot(), registration.head());
  if (!robot) return;
  const Heard heard = note(kRegistrationKind, registration.robot(), registration.head());
  const Epoch epoch = registration.epoch();
  if (registration.version_count() > msg::MAX_REGISTERED_VERSIONS || epoch == 0) {
    ++totals_.invalid;
    return;
  }
  AuditedRobot::Registered registered;
  registered.epoch = epoch;
  registered.incarnation = registration.head().incarnation();
  registered.earliest_ns = heard.earliest_ns;
  registered.latest_ns = heard.latest_ns;
  registered.is_absent = registration.is_absent();
  for (std::size_t i = 0; i < registration.version_count(); ++i) {
    Known* known = learn(*robot, registration.versions()[i]);
    if (!known) return;
    registered.versions.push_back(known->number);
    known->registered_in.add(epoch);
  }
  robot->registered_in.add(epoch);
  if (!robot->registered || epoch >= robot->registered->epoch) robot->registered = std::move(registered);
}

void Auditor::on_coordinator(const msg::CoordinatorState& state, Time now) {
  now_ = now;
  const Heard heard = note(kCoordinatorKind, 0, state.head());
  const auto known = epochs_.find(state.epoch());
  if (known == epochs_.end() || known->second.is_reported || state.missing().empty()) return;
  if (known->second.granter_life != state.head().incarnation() ||
      heard.earliest_ns <= known->second.first_grant_ns)
    return;
  known->second.is_reported = true;
  report(AuditRule::kAllRegistered, state.missing().front(), nullptr, state.epoch(),
         fmt::format("the coordinator misses {} robots' registrations after it has granted",
                     state.missing().size()));
}

void Auditor::on_command(const msg::Command& command, Time now) {
  now_ = now;
  AuditedRobot* robot = robot_of(command.robot(), command.head());
  if (!robot) return;
  const Heard heard = note(kCommandKind, command.robot(), command.head());
  auto& streams = agent_epochs_[robot->id];
  auto stream = std::ranges::find(streams, command.head().incarnation(), &AgentStream::incarnation);
  if (stream == streams.end()) {
    if (streams.size() >= 8) streams.erase(streams.begin());
    stream = streams.insert(streams.end(), {command.head().incarnation(), command.epoch()});
  }
  if (heard.is_newest && command.epoch() < stream->epoch) {
    report(AuditRule::kEpochBack, robot->id, nullptr, command.epoch(),
           fmt::format("after commands under epoch {}", stream->epoch));
  }
  if (heard.is_newest) stream->epoch = std::max(stream->epoch, command.epoch());
  if (!command.has_version()) return;

  Known* known = learn(*robot, command.granted());
  if (!known) return;
  known->sent_ns = std::min(known->sent_ns, heard.earliest_ns);
  known->sent_epoch = std::max(known->sent_epoch, command.epoch());
  judge_forwarded(*robot, known->number);
}

void Auditor::judge_forwarded(AuditedRobot& robot, VersionNumber number) {
  Known* known = robot.find(number);
  if (!known || known->sent_ns == kNever || known->is_reported_unsent) return;
  const HeardProposal* proposal = robot.proposal(0, number);
  const bool was_denied = proposal && proposal->is_ruled && proposal->granted != number;
  const bool was_never_granted =
      how_.is_complete && known->granted_in == 0 && known->number > robot.given_up_version;
  if (!was_denied && !was_never_granted) return;
  known->is_reported_unsent = true;
  report(AuditRule::kForwarded, robot.id, known, known->sent_epoch,
         was_denied
             ? fmt::format("the verdict on proposal {} granted {}", proposal->number, proposal->granted)
             : "no verdict has granted it");
}

void listen(Bus& bus, const Scenario& scenario, Auditor& auditor) {
  const auto hear = [&]<typename Message>(const Topic<Message>& topic, RobotId robot,
                                          void (Auditor::*on)(const Message&, Time)) {
    bus.subscribe<Message>(
        topic, robot, [&bus, &auditor, on](const Message& message) { (auditor.*on)(message, bus.now()); });
  };
  hear(topics::kProposal, 0, &Auditor::on_proposal);
  hear(topics::kRegistration, 0, &Auditor::on_registration);
  hear(topics::kCoordinator, 0, &Auditor::on_coordinator);
  hear(topics::kLedger, 0, &Auditor::on_ledger);
  hear(topics::kTruth, 0, &Auditor::on_truth);
  for (const RobotSpec& robot : scenario.robots) {
    hear(topics::kVerdict, robot.id, &Auditor::on_verdict);
    hear(topics::kCommand, robot.id, &Auditor::on_command);
    hear(topics::kFeedback, robot.id, &Auditor::on_feedback);
  }
}

}  // namespace sidestep
