// SPDX-License-Identifier: Apache-2.0
// Positions and contacts without ground truth: vision is the reference.
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/tampering.hpp"

namespace sidestep::auditor_vision_test {

using namespace std::chrono_literals;

/// The crossing as seen by a system without ground truth.
MessageHistory seen_crossing() {
  MessageHistory history = crossing();
  history.remove_if<msg::GroundTruth>([](const msg::GroundTruth&) { return true; });
  return history;
}

/// Changes vision's observations of one robot between `from` and `until` after the beginning.
void change_sight(MessageHistory& history, RobotId robot, Duration from, Duration until,
                  const std::function<void(msg::TrackedRobot&, const msg::WorldState&)>& change) {
  const Time begin = history.messages.front().at;
  history.each<msg::WorldState>([&](msg::WorldState& world, Time at) {
    if (at < begin + from || at >= begin + until) return;
    for (msg::TrackedRobot& tracked : world.robots()) {
      if (tracked.robot() == robot) change(tracked, world);
    }
  });
}

void shift(msg::TrackedRobot& robot, double x_m) {
  robot.x_m(robot.x_m() + x_m);
  robot.observed_x_m(robot.observed_x_m() + x_m);
}

/// Shows a robot beside another robot at this distance.
void put_beside(msg::TrackedRobot& robot, const msg::WorldState& world, RobotId other, double distance_m) {
  for (const msg::TrackedRobot& tracked : world.robots()) {
    if (tracked.robot() != other) continue;
    robot.observed_at_ns(tracked.observed_at_ns());
    robot.observed_x_m(tracked.observed_x_m() + distance_m);
    robot.observed_y_m(tracked.observed_y_m());
  }
}

TEST_CASE("without ground truth, vision is the reference and the report says so") {
  const AuditTotals totals = audit_of(seen_crossing(), kComplete);
  INFO(verdict_line(totals) << "\n" << lines(totals));
  CHECK(totals.reference == AuditReference::kVision);
  CHECK(totals.violations == 0);
  CHECK(totals.verdict() == AuditVerdict::kPassed);
  CHECK(totals.coverage.reference > 0.99);
  CHECK(totals.max_position_error_m > 0);
  CHECK(totals.max_position_error_m < 0.01);
}

TEST_CASE("an incomplete history without ground truth raises no false alarm") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  const double loss = GENERATE(0.0, 0.3);
  CAPTURE(seed, loss);
  const AuditTotals totals = audit_of(degraded(seen_crossing(), seed, loss, Duration{0}), {});
  INFO(verdict_line(totals) << "\n" << lines(totals));
  CHECK(totals.violations == 0);
  CHECK((totals.verdict() == AuditVerdict::kPassed) == (loss == 0));
}

TEST_CASE("with ground truth, vision is not used even if it shows a displacement") {
  MessageHistory history = crossing();
  change_sight(history, 2, 1500ms, 2500ms,
               [](msg::TrackedRobot& robot, const msg::WorldState&) { shift(robot, 0.5); });
  const AuditTotals totals = audit_of(history, kComplete);
  CHECK(totals.reference == AuditReference::kGroundTruth);
  CHECK(totals.violations == 0);
}

TEST_CASE("ground truth that arrives late replaces vision, and the report says so") {
  MessageHistory history = crossing();
  const Time late = history.messages.front().at + 2s;
  std::erase_if(history.messages, [&](const ReceivedMessage& received) {
    return received.at < late && std::holds_alternative<msg::GroundTruth>(received.message);
  });
  const AuditTotals totals = audit_of(history, kComplete);
  INFO(lines(totals));
  CHECK(totals.reference == AuditReference::kVisionThenGroundTruth);
  CHECK(totals.violations == 0);
}

TEST_CASE("a displacement shown by vision is reported once if it lasts") {
  const auto [duration, reported] = GENERATE(table<Duration, std::uint64_t>({{100ms, 0}, {800ms, 1}}));
  const bool is_complete = GENERATE(true, false);
  CAPTURE(to_seconds(duration), is_complete);
  MessageHistory history = seen_crossing();
  change_sight(history, 2, 2s, 2s + duration,
               [](msg::TrackedRobot& robot, const msg::WorldState&) { shift(robot, 0.03); });
  const AuditTotals totals = audit_of(history, is_complete ? kComplete : AuditInput{});
  INFO(lines(totals));
  CHECK(count(totals, AuditRule::kPosition) == reported);
}

TEST_CASE("contacts shown by vision are reported") {
  const double distance_m = GENERATE(0.178, 0.186);
  const bool is_complete = GENERATE(true, false);
  CAPTURE(distance_m, is_complete);
  MessageHistory history = seen_crossing();
  change_sight(history, 2, 2s, 2100ms, [&](msg::TrackedRobot& robot, const msg::WorldState& world) {
    put_beside(robot, world, 3, distance_m);
  });
  const AuditTotals totals = audit_of(history, is_complete ? kComplete : AuditInput{});
  INFO(lines(totals));
  CHECK(count(totals, AuditRule::kContact) == (distance_m < 0.18 ? 1 : 0));
}

TEST_CASE("a disturbance announced by an operator excuses a contact shown by vision") {
  const RobotId pushed = GENERATE(RobotId{2}, RobotId{5});
  CAPTURE(pushed);
  MessageHistory history = seen_crossing();
  history.push(pushed, history.messages.front().at + 1900ms);
  change_sight(history, 2, 2s, 2100ms, [](msg::TrackedRobot& robot, const msg::WorldState& world) {
    put_beside(robot, world, 3, 0.178);
  });
  const AuditTotals totals = audit_of(history, kComplete);
  INFO(lines(totals));
  CHECK(count(totals, AuditRule::kContact) == (pushed == 2 ? 0 : 1));
  CHECK(totals.excused_contacts == (pushed == 2 ? 1 : 0));
}

TEST_CASE("time in which vision does not see a robot is not covered") {
  MessageHistory history = seen_crossing();
  const Time begin = history.messages.front().at;
  history.each<msg::WorldState>([&](msg::WorldState& world, Time at) {
    if (at < begin + 2s || at >= begin + 3s) return;
    std::erase_if(world.robots(), [](const msg::TrackedRobot& robot) { return robot.robot() == 2; });
  });
  const AuditTotals totals = audit_of(history, kComplete);
  CHECK(totals.coverage.reference < 0.75);
  CHECK(totals.verdict() == AuditVerdict::kNotJudged);
}

TEST_CASE("without ground truth and vision nothing is judged") {
  MessageHistory history = seen_crossing();
  history.remove_if<msg::WorldState>([](const msg::WorldState&) { return true; });
  const AuditTotals totals = audit_of(history, kComplete);
  CHECK(totals.reference == AuditReference::kNone);
  CHECK(totals.verdict() == AuditVerdict::kNotJudged);
  CHECK_THAT(verdict_line(totals), ContainsSubstring("neither ground truth nor vision was received"));
}

}  // namespace sidestep::auditor_vision_test
