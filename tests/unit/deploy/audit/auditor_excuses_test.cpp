// SPDX-License-Identifier: Apache-2.0
// Contacts in ground truth that disturbances may excuse.
#include <cmath>

#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/tampering.hpp"

namespace sidestep::auditor_excuses_test {

using namespace std::chrono_literals;

/// The time when all robots of the history have arrived and rest.
Time rest_begin(MessageHistory& history) {
  Time begin = history.messages.front().at;
  history.each<msg::GroundTruth>([&](msg::GroundTruth& truth, Time at) {
    for (const msg::TrueRobotState& robot : truth.robots()) {
      if (std::hypot(robot.vx_mps(), robot.vy_mps()) > 0.04) begin = at;
    }
  });
  return begin;
}

TEST_CASE("a contact soon after a push is excused, but a contact long after a push is not") {
  const bool is_complete = GENERATE(true, false);
  const auto [after, is_excused] = GENERATE(table<Duration, bool>({{50ms, true}, {400ms, false}}));
  CAPTURE(is_complete, to_seconds(after));
  MessageHistory history = crossing();
  const Time push = rest_begin(history) + 150ms;
  REQUIRE(push + after + 100ms < history.messages.back().at);
  history.push(2, push);
  history.touch(2, 3, push + after);
  const AuditTotals totals = audit_of(history, is_complete ? kComplete : AuditInput{});
  INFO(lines(totals));
  CHECK((count(totals, AuditRule::kContact) == 0) == is_excused);
  CHECK((totals.excused_contacts == 1) == is_excused);
}

TEST_CASE("a push does not excuse a contact of the pushed robot's neighbours") {
  MessageHistory history = crossing();
  const Time push = history.messages.front().at + 1500ms;
  history.push(2, push);
  history.touch(0, 1, push + 50ms);
  const AuditTotals totals = audit_of(history, kComplete);
  CHECK(count(totals, AuditRule::kContact) == 1);
  CHECK(totals.excused_contacts == 0);
}

TEST_CASE("excused contacts are listed by cause and pair, with the share of excused time") {
  MessageHistory history = crossing();
  const Time push = history.messages.front().at + 1500ms;
  history.push(2, push);
  history.touch(2, 5, push + 50ms);
  history.touch(2, 5, push + 60ms);
  history.touch(2, std::nullopt, push + 70ms);
  const AuditTotals totals = audit_of(history, kComplete);
  INFO(lines(totals));
  REQUIRE(totals.excused.size() == 2);
  CHECK(totals.excused[0].cause == "push");
  CHECK(totals.excused[0].first == 2);
  CHECK_FALSE(totals.excused[0].second);
  CHECK(totals.excused[0].contacts == 1);
  CHECK(totals.excused[1].second == std::optional<RobotId>(5));
  CHECK(totals.excused[1].contacts == 2);
  CHECK(totals.excused_contacts == 3);
  CHECK(totals.violations == 0);
  CHECK(totals.excused_time_share() > 0);
  // Robots 2 and 5, which are in 13 of 28 pairs, are disturbed for at most two of four seconds.
  CHECK(totals.excused_time_share() < 13.0 / 28 / 2);
}

TEST_CASE("a run without disturbances excuses nothing") {
  MessageHistory history = crossing();
  history.touch(2, 3, history.messages.front().at + 1s);
  const AuditTotals totals = audit_of(history, kComplete);
  CHECK(count(totals, AuditRule::kContact) == 1);
  CHECK(totals.excused.empty());
  CHECK(totals.pair_s > 28 * 3);
  CHECK(totals.excused_pair_s == 0);
}

TEST_CASE("contacts that ground truth counts but does not list are neither excused nor violations") {
  MessageHistory history = crossing();
  const Time push = history.messages.front().at + 1500ms;
  history.push(2, push);
  for (int i = 0; i < 12; ++i) history.touch(2, 5, push + 50ms);
  const AuditTotals totals = audit_of(history, kComplete);
  CHECK(totals.excused_contacts == msg::MAX_CONTACTS);
  CHECK(totals.unidentified_contacts == 12 - msg::MAX_CONTACTS);
  CHECK(totals.violations == 0);
  CHECK(totals.verdict() == AuditVerdict::kNotJudged);
}

}  // namespace sidestep::auditor_excuses_test
