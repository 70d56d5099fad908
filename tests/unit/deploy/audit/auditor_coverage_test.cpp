// SPDX-License-Identifier: Apache-2.0
// The share of a run that an audit covered, and the resulting verdict.
#include <map>

#include "common/config/shared_rules.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/tampering.hpp"

namespace sidestep::auditor_coverage_test {

using namespace std::chrono_literals;

void require_covered(const AuditTotals& totals) {
  INFO(verdict_line(totals) << "\n" << lines(totals));
  CHECK(totals.verdict() == AuditVerdict::kPassed);
  CHECK(totals.coverage.messages >= 0.999);
  CHECK(totals.coverage.versions >= 0.99);
  CHECK(totals.coverage.pairs >= 0.99);
  CHECK(totals.coverage.time >= 0.99);
  CHECK(totals.coverage.reference >= 0.99);
}

TEST_CASE("an audit that hears all messages covers the whole run") {
  const AuditTotals totals = audit_of(crossing(), kComplete);
  require_covered(totals);
  CHECK(totals.coverage.share() == 1);
  CHECK(totals.reference == AuditReference::kGroundTruth);
  CHECK(totals.run_s > 3);
  CHECK(totals.excused_time_share() == 0);
}

TEST_CASE("an audit that loses no messages judges a run even if it joins late") {
  const Duration joined_after = GENERATE(Duration{0}, Duration{300'000'000});
  CAPTURE(to_seconds(joined_after));
  require_covered(audit_of(degraded(crossing(), 1, 0, joined_after), {}));
}

TEST_CASE("an audit that hears 60 % of the messages does not pass") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  const AuditTotals totals = audit_of(degraded(crossing(), seed, 0.4, Duration{0}), {});
  INFO(verdict_line(totals));
  CHECK(totals.violations == 0);
  CHECK(totals.verdict() == AuditVerdict::kNotJudged);
  CHECK(totals.coverage.messages == Approx(0.6).margin(0.1));
  CHECK_THAT(verdict_line(totals), ContainsSubstring("% of the messages were missed"));
}

/// The crossing from one time to another, since its first message.
MessageHistory crossing_between(Duration from, Duration until) {
  MessageHistory history = crossing();
  const Time begin = history.messages.front().at;
  std::erase_if(history.messages, [&](const ReceivedMessage& received) {
    return received.at < begin + from || received.at >= begin + until;
  });
  return history;
}

TEST_CASE("an audit of less than two seconds judges a run that it hears completely from the start") {
  const AuditInput input = GENERATE(kComplete, AuditInput{});
  CAPTURE(input.is_complete);
  require_covered(audit_of(crossing_between(0ms, 1900ms), input));
}

TEST_CASE("an audit of less than two seconds does not pass if proposals were made before it joined") {
  MessageHistory history = crossing_between(1200ms, 3000ms);
  const Time heard_from = history.messages.front().at + 1000ms;
  std::erase_if(history.messages, [&](const ReceivedMessage& received) {
    return std::holds_alternative<msg::Proposal>(received.message) && received.at < heard_from;
  });
  const AuditTotals totals = audit_of(history, {});
  INFO(verdict_line(totals) << "\n" << lines(totals));
  CHECK(totals.violations == 0);
  CHECK(totals.untraced_first_versions > 0);
  CHECK(totals.verdict() == AuditVerdict::kNotJudged);
  CHECK_THAT(verdict_line(totals), ContainsSubstring("executed versions"));
}

TEST_CASE("an audit of robot reports and ground truth alone does not pass, however short it is") {
  const Duration until = GENERATE(Duration(1'500'000'000), Duration(2'500'000'000), Duration(4'000'000'000));
  CAPTURE(to_seconds(until));
  MessageHistory history = crossing_between(0ms, until);
  std::erase_if(history.messages, [](const ReceivedMessage& received) {
    return !std::holds_alternative<msg::Feedback>(received.message) &&
           !std::holds_alternative<msg::GroundTruth>(received.message);
  });
  const AuditTotals totals = audit_of(history, {});
  INFO(verdict_line(totals) << "\n" << lines(totals));
  CHECK(totals.violations == 0);
  CHECK(totals.coverage.versions == 0);
  CHECK(totals.verdict() == AuditVerdict::kNotJudged);
  CHECK_THAT(verdict_line(totals), ContainsSubstring("100.0 % of the executed versions lack a proposal") &&
                                       ContainsSubstring("no page of the ledger was received"));
}

TEST_CASE("an audit without the ledger does not pass even if no robot executes a version") {
  MessageHistory history = crossing();
  std::erase_if(history.messages, [](const ReceivedMessage& received) {
    return !std::holds_alternative<msg::Feedback>(received.message) &&
           !std::holds_alternative<msg::GroundTruth>(received.message) &&
           !std::holds_alternative<msg::CoordinatorState>(received.message);
  });
  history.each<msg::Feedback>(
      [first = std::map<RobotId, msg::Version>()](msg::Feedback& feedback, Time) mutable {
        feedback.executing(first.try_emplace(feedback.robot(), feedback.executing()).first->second);
      });
  const AuditTotals totals = audit_of(history, {});
  INFO(verdict_line(totals) << "\n" << lines(totals));
  CHECK(totals.verdict() != AuditVerdict::kPassed);
  CHECK_THAT(shortfall(totals), ContainsSubstring("no page of the ledger was received"));
}

TEST_CASE("an audit that finds a violation fails the run even with low coverage") {
  MessageHistory history = degraded(crossing(), 5, 0.2, Duration{0});
  history.scenario.margin_m += 0.005;
  const AuditTotals totals = audit_of(history, {});
  CHECK(totals.coverage.share() < Coverage::kMinimum);
  CHECK(totals.verdict() == AuditVerdict::kFailed);
}

/// Audits the crossing without the messages of one type in its second half.
template <typename Message>
AuditTotals audit_without(const AuditInput& input) {
  MessageHistory history = crossing();
  const Time from = history.messages.front().at + 1500ms;
  std::erase_if(history.messages, [&](const ReceivedMessage& received) {
    return received.at >= from && std::holds_alternative<Message>(received.message);
  });
  return audit_of(history, input);
}

TEST_CASE("an audit that stops hearing messages of one type does not pass even without a gap in numbers") {
  const AuditInput input;
  AuditTotals totals;
  SECTION("robot reports") {
    totals = audit_without<msg::Feedback>(input);
    CHECK(totals.coverage.time < 0.7);
  }
  SECTION("proposals") {
    totals = audit_without<msg::Proposal>(input);
    CHECK(totals.coverage.versions < 0.7);
  }
  SECTION("commands") {
    totals = audit_without<msg::Command>(input);
    CHECK(totals.coverage.versions < 0.7);
  }
  SECTION("ground truth") {
    totals = audit_without<msg::GroundTruth>(input);
    CHECK(totals.coverage.reference < 0.7);
  }
  INFO(verdict_line(totals) << "\n" << lines(totals));
  CHECK(totals.violations == 0);
  CHECK(totals.coverage.messages == 1);
  CHECK(totals.verdict() == AuditVerdict::kNotJudged);
}

TEST_CASE("undecided pairs lower the coverage") {
  MessageHistory history = crossing();
  // A history in which all versions were granted with 5 cm too little margin, on unknown bases.
  history.scenario.margin_m += 0.05;
  history.each_version([](msg::Version& version) {
    if (version.version_number() != 0) version.base(version.version_number() - 1);
  });
  std::erase_if(history.messages, [](const ReceivedMessage& received) {
    return std::holds_alternative<msg::Proposal>(received.message);
  });
  const AuditTotals totals = audit_of(history, {});
  INFO(verdict_line(totals));
  REQUIRE(totals.undecided_pairs > 20);
  CHECK(totals.coverage.pairs ==
        Approx(1 - static_cast<double>(totals.undecided_pairs) / static_cast<double>(totals.compared_pairs)));
}

TEST_CASE("an audit that hears no coordinator does not pass") {
  MessageHistory history = crossing();
  std::erase_if(history.messages, [](const ReceivedMessage& received) {
    return std::holds_alternative<msg::Verdict>(received.message) ||
           std::holds_alternative<msg::LedgerPage>(received.message) ||
           std::holds_alternative<msg::CoordinatorState>(received.message);
  });
  const AuditTotals totals = audit_of(history, {});
  INFO(verdict_line(totals) << "\n" << lines(totals));
  CHECK(totals.violations == 0);
  CHECK(totals.coverage.versions < 0.1);
  CHECK(totals.verdict() == AuditVerdict::kNotJudged);
}

TEST_CASE("agent messages without effect, such as those of a disconnected host, may be missed") {
  // Robots rest for a moment between two goals, and then get commands without versions.
  Scenario scenario = crossing().scenario;
  for (RobotSpec& robot : scenario.robots) robot.goals.push_back({robot.start_m, std::nullopt});
  MessageHistory history = history_of(scenario, 3, 6s);
  history.remove_if<msg::Command>([](const msg::Command& command) { return !command.has_version(); });
  const AuditTotals totals = audit_of(history, {});
  CHECK(totals.missed > 0);
  require_covered(totals);
}

TEST_CASE("a silent robot is covered but a robot whose reports are missed is not") {
  MessageHistory history = crossing();
  const Time begin = history.messages.front().at, from = begin + 1500ms, until = begin + 2500ms;
  const bool were_sent = GENERATE(false, true);
  CAPTURE(were_sent);
  std::uint64_t removed = 0;
  std::vector<ReceivedMessage> kept;
  for (ReceivedMessage received : history.messages) {
    auto* feedback = std::get_if<msg::Feedback>(&received.message);
    const bool is_of_robot = feedback && feedback->robot() == 2;
    if (is_of_robot && received.at >= from && received.at < until) {
      ++removed;
      continue;
    }
    // Closes the gap in the message numbers, as if the robot had not sent the removed messages.
    if (is_of_robot && !were_sent)
      feedback->header().message_number(feedback->header().message_number() - removed);
    // Removes the messages that would show which versions the robot executed during the gap.
    const auto* command = std::get_if<msg::Command>(&received.message);
    if (command && command->robot() == 2 && received.at >= from - 100ms && received.at < until) continue;
    const auto* proposal = std::get_if<msg::Proposal>(&received.message);
    if (proposal && proposal->robot() == 2 && received.at >= from - 100ms && received.at < until) continue;
    if (std::holds_alternative<msg::LedgerPage>(received.message) && received.at >= from - 100ms &&
        received.at < until)
      continue;
    kept.push_back(received);
  }
  history.messages = std::move(kept);
  const AuditTotals totals = audit_of(history, {});
  INFO(verdict_line(totals) << "\n" << lines(totals));
  CHECK(removed > 30);
  CHECK(totals.coverage.time == (were_sent ? Approx(1 - 1 / totals.run_s).margin(0.03) : Approx(1)));
}

TEST_CASE(
    "missed robot reports do not lower the time coverage if all versions executed in the gap are known") {
  MessageHistory history = crossing();
  const Time from = history.messages.front().at + 1500ms;
  history.remove_if<msg::Feedback>([&](const msg::Feedback& f) {
    return f.robot() == 2 && time_from_ns(f.header().stamp_ns()) >= from &&
           time_from_ns(f.header().stamp_ns()) < from + 700ms;
  });
  const AuditTotals totals = audit_of(history, {});
  INFO(verdict_line(totals) << "\n" << lines(totals));
  CHECK(totals.violations == 0);
  CHECK(totals.coverage.time == 1);
  CHECK(totals.coverage.messages < 1);
}

TEST_CASE("messages of processes with different rules are refused and counted") {
  const Scenario& scenario = crossing().scenario;
  SimSystem system(scenario, 4);
  Scenario changed = scenario;
  changed.margin_m = 0.05;
  system.use_scenario("vision", changed);
  system.kill("vision");
  system.restart("vision");
  system.use_scenario(twin_process(3), changed);
  system.restart(twin_process(3));
  SimBus bus(system.network());
  bus.become_observer();
  const bool refuses = GENERATE(false, true);
  CAPTURE(refuses);
  Auditor auditor(scenario, kComplete);
  if (refuses) refuse_other_rules(bus, scenario, auditor);
  listen(bus, scenario, auditor);
  std::uint64_t received = 0;
  bus.observe<msg::Command>(topics::kCommand, 3, [&](const msg::Command& command) {
    received += command.header().rules() != SharedRules(scenario).fingerprint();
  });
  system.run_for(500ms);
  REQUIRE(received > 10);
  const AuditTotals totals = auditor.totals();
  INFO(lines(totals));
  CHECK((totals.refused >= received) == refuses);
  CHECK((totals.refused > 0) == refuses);
  if (refuses) CHECK(totals.violations == 0);
}

}  // namespace sidestep::auditor_coverage_test
