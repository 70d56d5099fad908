// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/auditor.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "common/config/shared_rules.hpp"
#include "common/messaging/robot_notices.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxEpochs = 64;
constexpr Duration kAdvancePeriod = std::chrono::milliseconds(100);
// Robots in contact may appear this far apart, because their positions are sampled.
constexpr double kContactTolerance_m = 0.001;
// Time for messages and a few cycles, in addition to braking itself.
constexpr Duration kReactionTime = std::chrono::milliseconds(200);

DisturbanceSettings disturbance_settings(const Scenario& scenario, bool is_complete) {
  const double braking_s = scenario.limits.speed_mps / scenario.limits.deceleration_mps2;
  return {2 * scenario.radius_m + kContactTolerance_m, 2 * scenario.radius_m + scenario.margin_m,
          from_seconds(braking_s) + kReactionTime, is_complete};
}

/// How far a robot may appear to be from its version because of errors of vision and clocks.
double sight_allowance_m(const Scenario& scenario) {
  return position_error_m(scenario.vision) + 2 * scenario.clock_bound_s * scenario.limits.speed_mps;
}

}  // namespace

Auditor::Auditor(const Scenario& scenario, const AuditInput& input)
    : scenario_(scenario),
      obstacles_(scenario.obstacles.begin(), scenario.obstacles.end()),
      input_(input),
      tracking_bound_m_(scenario.tracking_bound_m),
      clock_bound_ns_(from_seconds(scenario.clock_bound_s).count()),
      sight_allowance_m_(sight_allowance_m(scenario)),
      trace_(input.is_complete ? Duration{0} : input.min_latency_bound),
      agent_trace_(input.is_complete ? Duration{0} : input.min_latency_bound),
      report_coverage_(scenario.robots.size()),
      sights_(scenario.robots.size()),
      seen_displacements_(scenario.robots.size()),
      observed_(scenario.robots.size()),
      seen_contacts_(scenario),
      disturbances_(scenario.robots.size(), disturbance_settings(scenario, input.is_complete)),
      index_(kMaxRobots, scenario.robots.size()),
      orders_(roster_of(scenario), input.is_complete, stamps_,
              [this](AuditRule rule, RobotId robot, VersionNumber version, Epoch epoch, std::string detail) {
                Violation violation;
                violation.rule = rule;
                violation.robot = robot;
                violation.version = version;
                violation.epoch = epoch;
                violation.detail = std::move(detail);
                report(std::move(violation));
              }) {
  for (const RobotSpec& spec : scenario.robots) {
    index_.at(spec.id) = robots_.size();
    robots_.emplace_back().id = spec.id;
  }
  bounds_.resize(robots_.size());
  live_versions_.resize(robots_.size());
  observations_.resize(robots_.size());
  has_sound_clock_.resize(robots_.size());
}

void Auditor::report(AuditRule rule, RobotId robot, const KnownVersion* known, Epoch epoch,
                     std::string detail) {
  Violation violation;
  violation.rule = rule;
  violation.robot = robot;
  violation.version = known ? known->number : 0;
  violation.epoch = epoch;
  violation.detail = std::move(detail);
  report(std::move(violation));
}

void Auditor::report(Violation violation) {
  violation.detected = now_;
  ++totals_.violations;
  ++totals_.by_rule[static_cast<std::size_t>(violation.rule)];
  if (totals_.first.size() < AuditTotals::kMaxKept) totals_.first.push_back(violation);
  if (on_violation_) on_violation_(violation);
}

AuditedRobot* Auditor::robot_of(std::uint32_t robot, const msg::Header& header) {
  if (robot < kMaxRobots && index_[robot] < robots_.size() && header.sender() == robot)
    return &robots_[index_[robot]];
  ++totals_.invalid;
  return nullptr;
}

Reception Auditor::trace(Kind kind, std::uint32_t key, const msg::Header& header) {
  const bool is_of_agent = kind == kProposalKind || kind == kRegistrationKind || kind == kCommandKind;
  MessageTrace& messages = is_of_agent ? agent_trace_ : trace_;
  const Reception reception = messages.record(channel_of(kind, key), header, now_);
  stamps_.record(channel_of(kind, key), header);
  if (!input_.is_complete && !is_of_agent && reception.missed > 0) disturbances_.on_missed();
  return reception;
}

std::int64_t Auditor::granter_time_ns(const msg::Header& header, const Reception& reception) const {
  return input_.is_complete ? reception.latest_ns : header.stamp_ns();
}

KnownVersion* Auditor::store(AuditedRobot& robot, const msg::Version& version) {
  if (version.robot() != robot.id || !is_sane(version)) {
    ++totals_.invalid;
    return nullptr;
  }
  KnownVersion& known = robot.find_or_insert(version.version_number());
  // A later agent, or another floor: what the auditor would have forgotten if it had received every message.
  const bool is_another = known.has_content && (known.version.incarnation() != version.incarnation() ||
                                                (known.number == 0 && !(known.version == version)));
  if (!input_.is_complete && is_another) {
    known = KnownVersion();
    known.number = version.version_number();
  }
  if (!known.has_content) {
    known.has_content = true;
    known.version = version;
    known.path = AuditPath(version);
    known.is_content_checked = known.is_pair_checked = input_.is_complete;
    max_inflation_m_ = std::max(max_inflation_m_, version.inflation_m());
    // An earlier fact may exclude the version.
    if (robot.last_report) known.exclusion = exclusion_by(*robot.last_report, known);
    known.excluded_ns = known.exclusion == Exclusion::kNone ? kNever : to_ns(now_);
    robot.make_recent(known.number);
  } else if (!(known.version == version)) {
    report(AuditRule::kUniqueVersion, robot.id, &known, 0,
           fmt::format("one message has a start at {} ns and ({:.6f}, {:.6f}) m, another one at {} ns and "
                       "({:.6f}, {:.6f}) m",
                       known.version.start_ns(), known.version.x_m(), known.version.y_m(), version.start_ns(),
                       version.x_m(), version.y_m()));
  }
  return &known;
}

Auditor::EpochRecord& Auditor::epoch_record(Epoch epoch) {
  const auto entry = epochs_.try_emplace(epoch).first;
  if (epochs_.size() > kMaxEpochs)
    epochs_.erase(entry == epochs_.begin() ? std::next(entry) : epochs_.begin());
  return entry->second;
}

void Auditor::on_proposal(const msg::Proposal& proposal, Time now) {
  now_ = now;
  AuditedRobot* robot = robot_of(proposal.robot(), proposal.header());
  if (!robot) return;
  (void)trace(kProposalKind, proposal.robot(), proposal.header());
  if (proposal.candidate_count() == 0 || proposal.candidate_count() > msg::MAX_CANDIDATES) {
    ++totals_.invalid;
    return;
  }
  const std::uint64_t number = proposal.candidates().front().version_number();
  const ProposalRecord* same_number = robot->find_proposal(number);
  const std::uint64_t incarnation = proposal.candidates().front().incarnation();
  if (same_number && same_number->candidates.front().incarnation() == incarnation) return;
  ProposalRecord& record = robot->add_proposal();
  record.number = number;
  record.stamp_ns = proposal.header().stamp_ns();
  record.epoch = proposal.epoch();
  record.count = proposal.candidate_count();
  for (std::size_t i = 0; i < record.count; ++i) {
    record.candidates[i] = proposal.candidates()[i];
    // The verdict may have overtaken the proposal.
    const VersionNumber candidate = record.candidates[i].version_number();
    KnownVersion* known = robot->find(candidate);
    const auto is_grant = [&](const EarlyVerdict& v) {
      return v.granted == candidate && v.request_stamp_ns == record.stamp_ns;
    };
    const bool is_this = input_.is_complete ||
                         (known && known->has_content ? known->version.incarnation() == incarnation
                                                      : std::ranges::any_of(robot->early_verdicts, is_grant));
    if (!known || !is_this) continue;
    known->is_proposed = true;
    if (known->has_content || known->granted_in == 0) continue;
    if (KnownVersion* stored = store(*robot, record.candidates[i])) {
      check_content(*robot, *stored);
      check_new_pairs(*robot, *stored);
    }
  }
  for (const EarlyVerdict& verdict : robot->early_verdicts) {
    const bool is_answer =
        verdict.proposal == number && (input_.is_complete || verdict.request_stamp_ns == record.stamp_ns);
    if (is_answer) decide(*robot, record, verdict.epoch, verdict.granted);
  }
}

void Auditor::on_registration(const msg::Registration& registration, Time now) {
  now_ = now;
  AuditedRobot* robot = robot_of(registration.robot(), registration.header());
  if (!robot) return;
  const Reception reception = trace(kRegistrationKind, registration.robot(), registration.header());
  const Epoch epoch = registration.epoch();
  if (registration.version_count() > msg::MAX_REGISTERED_VERSIONS || epoch == 0) {
    ++totals_.invalid;
    return;
  }
  // Such a registration registers nobody, and only informs a coordinator of the epoch.
  if (registration.version_count() == 0 && !registration.is_absent()) return;
  orders_.on_registration(registration);
  AuditedRobot::Registered registered;
  registered.epoch = epoch;
  registered.incarnation = registration.header().incarnation();
  registered.earliest_ns = reception.earliest_ns;
  registered.latest_ns = reception.latest_ns;
  registered.stamp_ns = registration.header().stamp_ns();
  registered.is_absent = registration.is_absent();
  for (std::size_t i = 0; i < registration.version_count(); ++i) {
    KnownVersion* known = store(*robot, registration.versions()[i]);
    if (!known) return;
    registered.versions.push_back(known->number);
    known->registered_in.add(epoch);
  }
  robot->registered_in.add(epoch);
  // The attestation stays valid in the epochs that had begun.
  robot->attested_until = std::min(robot->attested_until, std::max(epoch, robot->attested_in));
  if (!robot->registered || epoch >= robot->registered->epoch) robot->registered = std::move(registered);
}

void Auditor::on_coordinator(const msg::CoordinatorState& state, Time now) {
  now_ = now;
  const Reception reception = trace(kCoordinatorKind, 0, state.header());
  newest_epoch_ = std::max(newest_epoch_, state.epoch());
  if (state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_GRANTING) {
    begin_run();
    named_displaced_ = displaced_robots(state);
  }
  const auto known = epochs_.find(state.epoch());
  if (known == epochs_.end() || known->second.is_reported) return;
  const std::vector<RobotId> missing = missing_robots(state);
  if (missing.empty()) return;
  const std::int64_t sent_ns = input_.is_complete ? reception.earliest_ns : state.header().stamp_ns();
  if (known->second.granter_incarnation != state.header().incarnation() ||
      sent_ns <= known->second.first_grant_ns || !are_times_comparable(state.header()))
    return;
  known->second.is_reported = true;
  report(AuditRule::kAllRegistered, missing.front(), nullptr, state.epoch(),
         fmt::format("{} robots' registrations are missing, although the coordinator has granted",
                     missing.size()));
}

void Auditor::on_order(const msg::Order& order, Time now) {
  now_ = now;
  orders_.on_order(order);
}

void Auditor::on_order_answer(const msg::OrderAnswer& answer, Time now) {
  now_ = now;
  stamps_.record(channel_of(kOrderAnswerKind, 0), answer.header());
  orders_.on_answer(answer);
}

void Auditor::on_order_memory(const msg::OrderMemory& memory, Time now) {
  now_ = now;
  stamps_.record(channel_of(kOrderMemoryKind, 0), memory.header());
  orders_.on_memory(memory);
}

void Auditor::on_order_status(const msg::OrderStatus& status, Time now) {
  now_ = now;
  stamps_.record(channel_of(kOrderStatusKind, 0), status.header());
  orders_.on_status(status);
}

void Auditor::on_command(const msg::Command& command, Time now) {
  now_ = now;
  AuditedRobot* robot = robot_of(command.robot(), command.header());
  if (!robot) return;
  const Reception reception = trace(kCommandKind, command.robot(), command.header());
  auto& streams = agent_epochs_[robot->id];
  auto stream = std::ranges::find(streams, command.header().incarnation(), &AgentStream::incarnation);
  if (stream == streams.end()) {
    if (streams.size() >= 8) streams.erase(streams.begin());
    stream = streams.insert(streams.end(), {command.header().incarnation(), command.epoch()});
  }
  if (reception.is_newest && command.epoch() < stream->epoch) {
    report(AuditRule::kEpochRegression, robot->id, nullptr, command.epoch(),
           fmt::format("follows commands under epoch {}", stream->epoch));
  }
  if (reception.is_newest) stream->epoch = std::max(stream->epoch, command.epoch());
  if (!command.has_version()) return;

  KnownVersion* known = store(*robot, command.version());
  if (!known) return;
  known->sent_ns = std::min(known->sent_ns, reception.earliest_ns);
  known->sent_epoch = std::max(known->sent_epoch, command.epoch());
  check_forwarded(*robot, known->number);
}

void Auditor::check_forwarded(AuditedRobot& robot, VersionNumber number) {
  KnownVersion* known = robot.find(number);
  if (!known || known->sent_ns == kNever || known->is_reported_unsent) return;
  const ProposalRecord* proposal = robot.find_proposal_of(known->version);
  const bool was_denied = proposal && proposal->is_decided && proposal->granted != number;
  const bool was_never_granted =
      input_.is_complete && known->granted_in == 0 && known->number > robot.max_evicted_version;
  if (!was_denied && !was_never_granted) return;
  known->is_reported_unsent = true;
  report(AuditRule::kForwarded, robot.id, known, known->sent_epoch,
         was_denied ? fmt::format("the verdict on proposal {} granted version {}", proposal->number,
                                  proposal->granted)
                    : "no verdict has granted it");
}

void listen(Bus& bus, const Scenario& scenario, Auditor& auditor) {
  const auto subscribe = [&]<typename Message>(const Topic<Message>& topic,
                                               void (Auditor::*on)(const Message&, Time), RobotId robot = 0) {
    bus.subscribe<Message>(
        topic, robot, [&bus, &auditor, on](const Message& message) { (auditor.*on)(message, bus.now()); });
  };
  subscribe(topics::kProposal, &Auditor::on_proposal);
  subscribe(topics::kRegistration, &Auditor::on_registration);
  subscribe(topics::kCoordinator, &Auditor::on_coordinator);
  subscribe(topics::kLedger, &Auditor::on_ledger);
  subscribe(topics::kTruth, &Auditor::on_truth);
  subscribe(topics::kWorld, &Auditor::on_world_state);
  subscribe(topics::kDisturbance, &Auditor::on_disturbance);
  subscribe(topics::kAttestation, &Auditor::on_attestation);
  subscribe(topics::kOrder, &Auditor::on_order);
  subscribe(topics::kOrderAnswer, &Auditor::on_order_answer);
  subscribe(topics::kOrderMemory, &Auditor::on_order_memory);
  subscribe(topics::kAgentOrders, &Auditor::on_order_memory);
  subscribe(topics::kOrderStatus, &Auditor::on_order_status);
  for (const RobotSpec& robot : scenario.robots) {
    subscribe(topics::kVerdict, &Auditor::on_verdict, robot.id);
    subscribe(topics::kCommand, &Auditor::on_command, robot.id);
    subscribe(topics::kFeedback, &Auditor::on_robot_report, robot.id);
  }
  // Advances also when no message arrives.
  call_periodically(bus, kAdvancePeriod, [&bus, &auditor] { auditor.advance(bus.now()); });
}

void refuse_other_rules(Bus& bus, const Scenario& scenario, Auditor& auditor) {
  bus.use_rules(SharedRules(scenario).fingerprint(),
                [&auditor](const TopicInfo&, const msg::Header&) { auditor.on_refused(); });
}

}  // namespace sidestep
