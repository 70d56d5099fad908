// SPDX-License-Identifier: Apache-2.0
// Messages that an auditor misses or receives late. None of these cases is a violation.
#include <algorithm>

#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/tampering.hpp"

namespace sidestep::auditor_missed_test {

using namespace std::chrono_literals;

/// The audit of a history in which all messages of one type arrive late.
template <typename Late>
AuditTotals audit_with_delayed(const MessageHistory& history, Duration delay) {
  std::vector<Delivery> deliveries;
  for (const ReceivedMessage& received : history.messages) {
    const bool is_late = std::holds_alternative<Late>(received.message);
    deliveries.push_back({received.at + (is_late ? delay : Duration{0}), &received.message});
  }
  std::ranges::stable_sort(deliveries, {}, &Delivery::at);
  return audit_of(history.scenario, deliveries, {});
}

void require_no_violation(const AuditTotals& totals) {
  INFO(verdict_line(totals) << "\n" << lines(totals));
  REQUIRE(totals.violations == 0);
}

TEST_CASE("an overloaded auditor that receives all robot reports late raises no false alarm") {
  const Duration delay = GENERATE(Duration{8ms}, Duration{40ms}, Duration{150ms});
  CAPTURE(to_seconds(delay));
  require_no_violation(audit_with_delayed<msg::Feedback>(crossing(), delay));
}

TEST_CASE("an auditor that receives all messages of one kind late raises no false alarm") {
  SECTION("verdicts") { require_no_violation(audit_with_delayed<msg::Verdict>(crossing(), 150ms)); }
  SECTION("ledger pages") { require_no_violation(audit_with_delayed<msg::LedgerPage>(crossing(), 150ms)); }
  SECTION("proposals") { require_no_violation(audit_with_delayed<msg::Proposal>(crossing(), 150ms)); }
  SECTION("commands") { require_no_violation(audit_with_delayed<msg::Command>(crossing(), 150ms)); }
  SECTION("registrations") { require_no_violation(audit_with_delayed<msg::Registration>(crossing(), 150ms)); }
  SECTION("ground truth") { require_no_violation(audit_with_delayed<msg::GroundTruth>(crossing(), 150ms)); }
}

TEST_CASE(
    "an auditor that missed an attestation of absence does not demand the absent robot's registration") {
  MessageHistory history = crossing();
  const Time back = history.messages.front().at + 2s;
  const auto is_of_absent = [](const auto& message) { return message.robot() == 3; };
  history.remove_if<msg::Registration>(is_of_absent);
  history.remove_if<msg::Command>(is_of_absent);
  history.remove_if<msg::Proposal>(is_of_absent);
  history.remove_if<msg::Verdict>(is_of_absent);
  history.each<msg::LedgerPage>([&](msg::LedgerPage& page, Time) {
    std::erase_if(page.versions(), [&](const msg::Version& version) { return version.robot() == 3; });
  });
  std::uint64_t sent = 0;
  std::optional<msg::Version> rest;
  history.each<msg::Feedback>([&](msg::Feedback& robot_report, Time) {
    if (robot_report.robot() != 3) return;
    if (!rest) rest = robot_report.executing();
    robot_report.executing(*rest);
    robot_report.obeyed_epoch(0);
    robot_report.obeyed_incarnation(0);
    robot_report.header().message_number(++sent);
  });
  std::erase_if(history.messages, [&](const ReceivedMessage& received) {
    const auto* robot_report = std::get_if<msg::Feedback>(&received.message);
    return robot_report && robot_report->robot() == 3 && received.at < back;
  });
  const AuditTotals totals = audit_of(history, {});
  INFO(lines(totals));
  CHECK(count(totals, AuditRule::kAllRegistered) == 0);
}

TEST_CASE("two agents may use the same proposal number, even if the auditor misses one agent's proposal") {
  MessageHistory history = crossing();
  const Switch s = first_moving_switch(history);
  // Adds a restarted agent that proposes the same number and is granted its second candidate.
  std::optional<ReceivedMessage> grant;
  for (const ReceivedMessage& received : history.messages) {
    const auto* verdict = std::get_if<msg::Verdict>(&received.message);
    if (verdict && verdict->robot() == s.robot && verdict->granted_version() == s.number) grant = received;
  }
  REQUIRE(grant);
  auto& verdict = std::get<msg::Verdict>(grant->message);
  verdict.request_stamp_ns(verdict.request_stamp_ns() + 3'000'000);
  verdict.granted_version(s.number + 700);
  const auto place = std::ranges::find_if(
      history.messages, [&](const ReceivedMessage& received) { return received.at > grant->at + 5ms; });
  history.messages.insert(place, {grant->at + 5ms, verdict});
  require_no_violation(audit_of(history, {}));
}

TEST_CASE("a robot that starts beside an obstacle may drive away, even if its earlier versions were missed") {
  MessageHistory history = crossing();
  // The history ends before the first of the other robots passes the obstacle.
  const Time end = history.messages.front().at + 1500ms;
  std::erase_if(history.messages, [&](const ReceivedMessage& received) { return received.at > end; });
  std::optional<Vec2> start_m;
  history.each<msg::Feedback>([&](msg::Feedback& robot_report, Time) {
    if (robot_report.robot() == 2 && !start_m)
      start_m = Vec2(robot_report.executing().x_m(), robot_report.executing().y_m());
  });
  REQUIRE(start_m);
  history.scenario.obstacles.push_back(Circle{*start_m * 1.02, 0.001});
  const AuditTotals whole = audit_of(history, kComplete);
  INFO(lines(whole));
  REQUIRE(whole.violations == 0);
  const std::uint64_t seed = GENERATE(range(1u, 9u));
  CAPTURE(seed);
  require_no_violation(audit_of(degraded(history, seed, 0.6, Duration{0}), {}));
}

/// The crossing with a second coordinator that takes over while the robots drive.
MessageHistory takeover() {
  Scenario scenario = crossing().scenario;
  scenario.coordinators = 2;
  MessageHistory history{scenario, {}};
  SimSystem system(scenario, 5);
  const HistoryRecorder recorder(system, history);
  system.run_for(2s);
  system.kill("coordinator");
  system.kill("coordinator 1");
  system.restart("coordinator 1");
  system.run_for(2s);
  return history;
}

TEST_CASE("a registered version may have been granted in an earlier epoch whose grants were missed") {
  MessageHistory history = takeover();
  require_no_violation(audit_of(history, kComplete));
  Epoch last = 0;
  history.each<msg::LedgerPage>([&](msg::LedgerPage& page, Time) { last = std::max(last, page.epoch()); });
  history.remove_if<msg::Registration>([](const msg::Registration&) { return true; });
  history.remove_if<msg::Verdict>([&](const msg::Verdict& verdict) { return verdict.epoch() < last; });
  history.remove_if<msg::LedgerPage>([&](const msg::LedgerPage& page) { return page.epoch() < last; });
  require_no_violation(audit_of(history, {}));
}

/// The crossing in which a robot is lifted and put down elsewhere.
MessageHistory lift_and_place() {
  MessageHistory history{crossing().scenario, {}};
  SimSystem system(history.scenario, 6);
  const HistoryRecorder recorder(system, history);
  msg::Disturbance disturbance;
  disturbance.robot(2);
  const auto disturb = [&](msg::DisturbanceKind kind) {
    disturbance.disturbance_kind(kind);
    system.disturb(disturbance);
  };
  system.run_for(1s);
  disturb(msg::DisturbanceKind::DISTURBANCE_LIFT);
  system.run_for(300ms);
  disturbance.x_m(history.scenario.field.length_m / 2 - 0.5);
  disturbance.y_m(history.scenario.field.width_m / 2 - 0.5);
  disturb(msg::DisturbanceKind::DISTURBANCE_PLACE);
  system.run_for(3s);
  return history;
}

TEST_CASE("a robot that is put down elsewhere raises no false alarm if its lifting was missed") {
  MessageHistory history = lift_and_place();
  require_no_violation(audit_of(history, kComplete));
  std::uint64_t lifted = 0;
  history.each<msg::Feedback>([&](msg::Feedback& robot_report, Time) { lifted += robot_report.is_lifted(); });
  REQUIRE(lifted > 10);
  SECTION("all reports of the lifted robot are missed") {
    history.remove_if<msg::Feedback>(
        [](const msg::Feedback& robot_report) { return robot_report.is_lifted(); });
    require_no_violation(audit_of(history, {}));
  }
  SECTION("all reports but one from the lifting until the robot drives are missed") {
    bool was_lifted = false;
    std::erase_if(history.messages, [&](const ReceivedMessage& received) {
      const auto* robot_report = std::get_if<msg::Feedback>(&received.message);
      if (!robot_report || robot_report->robot() != 2) return false;
      was_lifted |= robot_report->is_lifted();
      // One report of the lifted robot is received.
      return was_lifted &&
             (robot_report->executing().version_number() == 0 || robot_report->executing().base() == 0) &&
             lifted-- > 1;
    });
    require_no_violation(audit_of(history, {}));
  }
}

TEST_CASE("a contact before an auditor joined is not judged") {
  MessageHistory history = crossing();
  history.touch(2, 3, history.messages.front().at + 500ms);
  const Time joined = history.messages.front().at + 1s;
  std::erase_if(history.messages, [&](const ReceivedMessage& received) { return received.at < joined; });
  const AuditTotals totals = audit_of(history, {});
  INFO(verdict_line(totals) << "\n" << lines(totals));
  CHECK(totals.violations == 0);
  CHECK(totals.undecided_contacts == 1);
  CHECK(totals.verdict() == AuditVerdict::kNotJudged);
}

TEST_CASE("if messages were missed, contacts of disturbed robots are not judged, but other contacts are") {
  const bool is_of_disturbed = GENERATE(true, false);
  CAPTURE(is_of_disturbed);
  MessageHistory history = crossing();
  const Time push = history.messages.front().at + 500ms;
  history.push(2, push);
  history.touch(is_of_disturbed ? 2 : 4, is_of_disturbed ? 3 : 5, push + 3s);
  int robot_reports = 0;
  std::erase_if(history.messages, [&](const ReceivedMessage& received) {
    const auto* robot_report = std::get_if<msg::Feedback>(&received.message);
    return robot_report && robot_report->robot() == 2 && received.at > push && ++robot_reports < 3;
  });
  const AuditTotals totals = audit_of(history, {});
  INFO(verdict_line(totals) << "\n" << lines(totals));
  CHECK((count(totals, AuditRule::kContact) > 0) == !is_of_disturbed);
  CHECK(totals.undecided_contacts == (is_of_disturbed ? 1 : 0));
}

TEST_CASE("an auditor that hears no ledger pages does not judge") {
  MessageHistory history = crossing();
  history.remove_if<msg::LedgerPage>([](const msg::LedgerPage&) { return true; });
  const AuditTotals totals = audit_of(history, {});
  CHECK(totals.violations == 0);
  CHECK(totals.verdict() == AuditVerdict::kNotJudged);
  CHECK(totals.coverage.versions < 0.1);
}

}  // namespace sidestep::auditor_missed_test
