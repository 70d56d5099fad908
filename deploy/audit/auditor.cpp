// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/auditor.hpp"

#include "common/config/shared_rules.hpp"
#include "common/messaging/robot_notices.hpp"

namespace sidestep {

Auditor::Auditor(const Scenario& scenario, const AuditInput& input)
    : run_{scenario, input},
      times_(run_),
      robots_(run_, findings_),
      coverage_(run_, robots_, findings_),
      content_(run_, robots_, findings_),
      pairs_(run_, robots_, findings_),
      epochs_(run_, times_, robots_, findings_),
      orders_(roster_of(scenario), input.is_complete, times_.stamps(),
              [this](AuditRule rule, RobotId robot, VersionNumber version, Epoch epoch, std::string detail) {
                findings_.report({rule, {}, robot, {}, version, 0, epoch, std::move(detail)});
              }),
      grants_(run_, times_, robots_, epochs_, content_, pairs_, orders_, findings_),
      ledger_(run_, times_, robots_, epochs_, content_, pairs_, findings_),
      facts_(run_, robots_, epochs_, content_, pairs_, findings_),
      reference_(run_, robots_, coverage_, findings_) {}

AuditedRobot* Auditor::known_robot(RobotId robot) {
  AuditedRobot* const known = robots_.find(robot);
  if (!known) ++findings_.totals.invalid;
  return known;
}

AuditedRobot* Auditor::sender_of(RobotId robot, const msg::Header& header) {
  AuditedRobot* const sender = header.sender() == robot ? robots_.find(robot) : nullptr;
  if (!sender) ++findings_.totals.invalid;
  return sender;
}

Reception Auditor::trace(Kind kind, std::uint32_t key, const msg::Header& header) {
  const Reception reception = times_.record(kind, key, header, findings_.now);
  if (!run_.is_complete() && !MessageTimes::is_agent_kind(kind) && reception.missed > 0)
    reference_.on_missed();
  return reception;
}

void Auditor::on_proposal(const msg::Proposal& proposal, Time now) {
  findings_.now = now;
  AuditedRobot* robot = sender_of(proposal.robot(), proposal.header());
  if (!robot) return;
  (void)trace(Kind::kProposalKind, proposal.robot(), proposal.header());
  if (proposal.candidate_count() == 0 || proposal.candidate_count() > msg::MAX_CANDIDATES)
    ++findings_.totals.invalid;
  else
    grants_.on_proposal(*robot, proposal);
}

void Auditor::on_verdict(const msg::Verdict& verdict, Time now) {
  findings_.now = now;
  AuditedRobot* robot = known_robot(verdict.robot());
  if (!robot) return;
  const Reception reception = trace(Kind::kVerdictKind, robot->id, verdict.header());
  if (verdict.proposal_number() == 0) return;
  if (verdict.granted_version() != 0) coverage_.begin_run();
  grants_.on_verdict(*robot, verdict, reception);
}

void Auditor::on_registration(const msg::Registration& registration, Time now) {
  findings_.now = now;
  AuditedRobot* robot = sender_of(registration.robot(), registration.header());
  if (!robot) return;
  const Reception reception = trace(Kind::kRegistrationKind, registration.robot(), registration.header());
  if (registration.version_count() > msg::MAX_REGISTERED_VERSIONS || registration.epoch() == 0) {
    ++findings_.totals.invalid;
    return;
  }
  // If a robot on the floor registers without versions, this only informs the coordinator of the epoch.
  if (registration.version_count() == 0 && !registration.is_absent()) return;
  orders_.on_registration(registration);
  epochs_.on_registration(*robot, registration, reception);
}

void Auditor::on_coordinator(const msg::CoordinatorState& state, Time now) {
  findings_.now = now;
  const Reception reception = trace(Kind::kCoordinatorKind, 0, state.header());
  if (state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_GRANTING) {
    coverage_.begin_run();
    reference_.positions().on_displaced(displaced_robots(state));
  }
  epochs_.on_coordinator(state, reception);
}

void Auditor::on_ledger(const msg::LedgerPage& page, Time now) {
  findings_.now = now;
  const Reception reception = trace(Kind::kLedgerKind, 0, page.header());
  if (page.versions().size() > 256 || page.epoch() == 0) {
    ++findings_.totals.invalid;
    return;
  }
  coverage_.begin_run();
  coverage_.hear_ledger();
  ledger_.on_page(page, reception);
}

void Auditor::on_command(const msg::Command& command, Time now) {
  findings_.now = now;
  AuditedRobot* robot = sender_of(command.robot(), command.header());
  if (!robot) return;
  const Reception reception = trace(Kind::kCommandKind, command.robot(), command.header());
  epochs_.on_command(*robot, command, reception);
  if (command.has_version()) grants_.on_command(*robot, command, reception);
}

void Auditor::on_robot_report(const msg::Feedback& feedback, Time now) {
  findings_.now = now;
  AuditedRobot* robot = sender_of(feedback.robot(), feedback.header());
  if (!robot) return;
  const Reception reception = trace(Kind::kRobotReportKind, feedback.robot(), feedback.header());
  const auto robot_report = facts_.check(*robot, feedback, reception);
  if (!robot_report) return;
  coverage_.hear_robot_report(*robot, robot_report->executing, reception);
  reference_.positions().check(*robot, *robot_report, reception);
  facts_.keep(*robot, *robot_report);
}

void Auditor::on_truth(const msg::GroundTruth& truth, Time now) {
  findings_.now = now;
  reference_.on_truth(truth, trace(Kind::kTruthKind, truth.simulator(), truth.header()));
}

void Auditor::on_world_state(const msg::WorldState& world, Time now) {
  findings_.now = now;
  if (coverage_.has_ground_truth()) return;
  reference_.on_world_state(world, trace(Kind::kWorldKind, world.vision(), world.header()));
}

void Auditor::on_disturbance(const msg::Disturbance& disturbance, Time now) {
  findings_.now = now;
  reference_.on_disturbance(disturbance);
}

void Auditor::on_attestation(const msg::AbsenceAttestation& attestation, Time now) {
  findings_.now = now;
  AuditedRobot* robot = known_robot(attestation.robot());
  if (!robot) return;
  coverage_.expect_silence(*robot);
  epochs_.on_attestation(*robot);
}

void Auditor::on_order(const msg::Order& order, Time now) {
  findings_.now = now;
  orders_.on_order(order);
}

void Auditor::on_order_answer(const msg::OrderAnswer& answer, Time now) {
  findings_.now = now;
  times_.record_stamp(Kind::kOrderAnswerKind, 0, answer.header());
  orders_.on_answer(answer);
}

void Auditor::on_order_memory(const msg::OrderMemory& memory, Time now) {
  findings_.now = now;
  times_.record_stamp(Kind::kOrderMemoryKind, 0, memory.header());
  orders_.on_memory(memory);
}

void Auditor::on_order_status(const msg::OrderStatus& status, Time now) {
  findings_.now = now;
  times_.record_stamp(Kind::kOrderStatusKind, 0, status.header());
  orders_.on_status(status);
}

AuditTotals Auditor::totals() const {
  AuditTotals totals = findings_.totals;
  coverage_.add_to(totals, times_);
  reference_.add_to(totals);
  return totals;
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
  // Advances the auditor's time even when no message arrives.
  constexpr Duration kAdvancePeriod = std::chrono::milliseconds(100);
  call_periodically(bus, kAdvancePeriod, [&bus, &auditor] { auditor.advance(bus.now()); });
}

void refuse_other_rules(Bus& bus, const Scenario& scenario, Auditor& auditor) {
  bus.use_rules(SharedRules(scenario).fingerprint(),
                [&auditor](const TopicInfo&, const msg::Header&) { auditor.on_refused(); });
}

}  // namespace sidestep
