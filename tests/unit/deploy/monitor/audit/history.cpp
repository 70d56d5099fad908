// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/deploy/monitor/audit/history.hpp"

#include <algorithm>

#include "deploy/simulate/system/sim_system.hpp"

namespace sidestep {

void History::each_version(const std::function<void(msg::Version&)>& use) {
  for (HeardMessage& heard : messages) {
    if (auto* proposal = std::get_if<msg::Proposal>(&heard.message)) {
      for (std::size_t i = 0; i < proposal->candidate_count(); ++i) use(proposal->candidates()[i]);
    } else if (auto* registration = std::get_if<msg::Registration>(&heard.message)) {
      for (std::size_t i = 0; i < registration->version_count(); ++i) use(registration->versions()[i]);
    } else if (auto* page = std::get_if<msg::LedgerPage>(&heard.message)) {
      for (msg::Version& version : page->versions()) use(version);
    } else if (auto* command = std::get_if<msg::Command>(&heard.message)) {
      if (command->has_version()) use(command->granted());
    } else if (auto* feedback = std::get_if<msg::Feedback>(&heard.message)) {
      use(feedback->executing());
    }
  }
}

void History::push(RobotId pushed, Time at) {
  each<msg::GroundTruth>([&](msg::GroundTruth& truth, Time heard_at) {
    if (heard_at < at) return;
    for (msg::TruthRobot& robot : truth.robots()) {
      if (robot.robot() == pushed) robot.disturbance_end_ns(to_ns(at));
    }
  });
}

void History::each_mention(RobotId robot, VersionNumber number,
                           const std::function<void(msg::Version&)>& use) {
  each_version([&](msg::Version& version) {
    if (version.robot() == robot && version.version_number() == number) use(version);
  });
}

History history_of(const Scenario& scenario, std::uint64_t seed, Duration duration) {
  History history{scenario, {}};
  SimSystem system(scenario, seed);
  SimBus bus(system.network());
  bus.listen_aside();
  const auto keep = [&]<typename Message>(const Topic<Message>& topic, RobotId robot) {
    bus.subscribe<Message>(topic, robot, [&](const Message& message) {
      history.messages.push_back({bus.now(), message});
    });
  };
  keep(topics::kProposal, 0);
  keep(topics::kRegistration, 0);
  keep(topics::kCoordinator, 0);
  keep(topics::kLedger, 0);
  keep(topics::kTruth, 0);
  for (const RobotSpec& robot : scenario.robots) {
    keep(topics::kVerdict, robot.id);
    keep(topics::kCommand, robot.id);
    keep(topics::kFeedback, robot.id);
  }
  system.run_for(duration);
  return history;
}

AuditTotals audit_of(const History& history, const AuditTrace& hearing) {
  Auditor auditor(history.scenario, hearing);
  struct Hear {
    Auditor& auditor;
    Time at;
    void operator()(const msg::Proposal& m) const { auditor.on_proposal(m, at); }
    void operator()(const msg::Verdict& m) const { auditor.on_verdict(m, at); }
    void operator()(const msg::Registration& m) const { auditor.on_registration(m, at); }
    void operator()(const msg::CoordinatorState& m) const { auditor.on_coordinator(m, at); }
    void operator()(const msg::LedgerPage& m) const { auditor.on_ledger(m, at); }
    void operator()(const msg::Command& m) const { auditor.on_command(m, at); }
    void operator()(const msg::Feedback& m) const { auditor.on_feedback(m, at); }
    void operator()(const msg::GroundTruth& m) const { auditor.on_truth(m, at); }
  };
  for (const HeardMessage& heard : history.messages) std::visit(Hear{auditor, heard.at}, heard.message);
  return auditor.totals();
}

History badly_heard(const History& history, std::uint64_t seed, double loss, Duration joined_after) {
  Rng rng(seed);
  History heard{history.scenario, {}};
  const Time from = history.messages.front().at + joined_after;
  for (const HeardMessage& message : history.messages) {
    for (int copy = 0; copy < 2; ++copy) {
      if (copy == 1 && !rng.chance(0.1)) continue;
      const Time at = message.at + from_seconds(0.02 * rng.uniform() * rng.uniform());
      if (at >= from && !rng.chance(loss)) heard.messages.push_back({at, message.message});
    }
  }
  std::ranges::stable_sort(heard.messages, {}, &HeardMessage::at);
  return heard;
}

std::string lines(const AuditTotals& totals) {
  std::string text;
  for (const Violation& violation : totals.first) text += to_line(violation) + '\n';
  return text;
}

}  // namespace sidestep
