// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/clock_watch.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "common/random/rng.hpp"

using namespace sidestep;

namespace {

constexpr RobotId kRobot = 3;
constexpr Incarnation kSelf = 1000;
constexpr Epoch kEpoch = 7;
const Duration kBound = from_seconds(0.0005);
constexpr double kCycle_s = 1.0 / 60;

Time at_s(double seconds) { return time_from_ns(1'000'000'000'000'000) + from_seconds(seconds); }

/// An agent between a robot and a coordinator whose clocks are ahead of the agent's by so much, on a network
/// that takes a fifth of a millisecond and up to so much more.
struct Between {
  double robot_s = 0, coordinator_s = 0, spread_s = 0.0002;
  Rng rng{1};
  ClockWatch clocks{kRobot, kBound};

  Between() { clocks.on_epoch(kEpoch); }
  double delay() { return 0.0002 + rng.uniform(0, spread_s); }
  msg::Feedback feedback(double sent) {
    const double heard = sent + delay(), answered = heard + 0.003;
    msg::Feedback f;
    f.robot(kRobot);
    f.head().incarnation(5);
    f.obeyed_incarnation(kSelf);
    f.heard_stamp_ns(to_ns(at_s(sent)));
    f.heard_at_ns(to_ns(at_s(heard + robot_s)));
    f.at_ns(to_ns(at_s(answered + robot_s)));
    return f;
  }
  msg::Verdict verdict(double asked) {
    clocks.on_asked(at_s(asked));
    msg::Verdict v;
    v.robot(kRobot);
    v.epoch(kEpoch);
    v.asked_stamp_ns(to_ns(at_s(asked)));
    v.head().stamp_ns(to_ns(at_s(asked + delay() + coordinator_s)));
    return v;
  }
  void hear_robot(double sent) {
    const msg::Feedback f = feedback(sent);
    const Time answered = time_from_ns(f.at_ns()) - from_seconds(robot_s);
    clocks.on_feedback(f, kSelf, answered + from_seconds(delay()));
  }
  void hear_coordinator(double asked) {
    const msg::Verdict v = verdict(asked);
    const Time answered = time_from_ns(v.head().stamp_ns()) - from_seconds(coordinator_s);
    clocks.on_verdict(v, answered + from_seconds(delay()));
  }
  std::uint64_t invalid(double now) const {
    msg::AgentStatus status;
    clocks.fill(status, at_s(now));
    return status.invalid();
  }
  void hear_both(double from, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      hear_robot(from + i * kCycle_s);
      hear_coordinator(from + i * kCycle_s);
    }
  }
};

}  // namespace

TEST_CASE("nothing may move before both clocks have been measured, and again when that was long ago") {
  Between b;
  CHECK_FALSE(b.clocks.allows_motion(at_s(0)));
  CHECK(b.clocks.is_measurement_due(at_s(0)));
  b.hear_robot(0);
  CHECK_FALSE(b.clocks.allows_motion(at_s(0.01)));
  CHECK_FALSE(b.clocks.is_beyond_bound(at_s(0.01)));
  msg::AgentStatus status;
  b.clocks.fill(status, at_s(0.01));
  CHECK(status.clock_uncertainty_s() < 0);
  b.hear_coordinator(0);
  CHECK(b.clocks.allows_motion(at_s(0.01)));
  b.clocks.fill(status, at_s(0.01));
  CHECK(status.clock_uncertainty_s() > 0);
  CHECK_FALSE(b.clocks.is_measurement_due(at_s(0.9)));
  CHECK(b.clocks.is_measurement_due(at_s(1.1)));
  b.hear_robot(2.5);
  CHECK_FALSE(b.clocks.allows_motion(at_s(2.6)));
  b.hear_coordinator(2.6);
  CHECK(b.clocks.allows_motion(at_s(2.7)));
  CHECK_FALSE(b.clocks.allows_motion(at_s(5)));
}

TEST_CASE("a robot's clock within the bound of the coordinator's may move, whatever the agent's own shows") {
  const double own_s = GENERATE(0.0, 0.1, -3600.0, 5.0);
  const double offset_s = GENERATE(0.0, 0.0004, -0.0004);
  CAPTURE(own_s, offset_s);
  Between b;
  b.coordinator_s = own_s;
  b.robot_s = own_s + offset_s;
  b.hear_both(0, 60);
  CHECK(b.clocks.allows_motion(at_s(1)));
  const auto known = b.clocks.robot_to_coordinator(at_s(1));
  REQUIRE(known);
  CHECK(known->low <= from_seconds(offset_s));
  CHECK(known->high >= from_seconds(offset_s));
  // What the agent makes of its robot's clock.
  CHECK(to_seconds(b.clocks.robot_ahead()) == Approx(b.robot_s).margin(0.0006));
  CHECK(b.clocks.robot_ahead_at_most(at_s(1)) >= from_seconds(b.robot_s) - Duration{1000});
  if (own_s == 0 && offset_s == 0) CHECK(b.clocks.robot_ahead() == Duration{0});
}

TEST_CASE("an offset beyond the bound by more than the quickest messages take is noticed, both ways") {
  const double offset_s = GENERATE(0.0011, -0.0011, 0.02, -0.02, 3600.0);
  CAPTURE(offset_s);
  Between b;
  b.robot_s = offset_s;
  b.hear_both(0, 60);
  CHECK(b.clocks.is_beyond_bound(at_s(1)));
  CHECK_FALSE(b.clocks.allows_motion(at_s(1)));
  msg::AgentStatus status;
  status.agent_state(msg::AGENT_WAITING);
  b.clocks.fill(status, at_s(1));
  CHECK(status.agent_state() == msg::AGENT_OFF_CLOCK);
  CHECK(std::abs(status.clock_offset_s() - offset_s) <= status.clock_uncertainty_s());
  // Somebody sets it right.
  b.robot_s = 0;
  b.hear_both(1, 10);
  CHECK(b.clocks.allows_motion(at_s(1 + 10 * kCycle_s)));
}

TEST_CASE("a clock that jumps while the robot drives is noticed within two cycles") {
  Between b;
  b.hear_both(0, 60);
  REQUIRE(b.clocks.allows_motion(at_s(1)));
  b.robot_s = 0.05;
  b.hear_both(1, 2);
  CHECK(b.clocks.is_beyond_bound(at_s(1 + 2 * kCycle_s)));
}

TEST_CASE("a new epoch has a clock of its own, and so has a robot that started again") {
  Between b;
  b.hear_both(0, 10);
  REQUIRE(b.clocks.allows_motion(at_s(0.2)));
  b.clocks.on_epoch(kEpoch + 1);
  CHECK_FALSE(b.clocks.allows_motion(at_s(0.2)));
  msg::Verdict late = b.verdict(0.2);
  b.clocks.on_verdict(late, at_s(0.201));
  CHECK_FALSE(b.clocks.allows_motion(at_s(0.21)));
  late = b.verdict(0.22);
  late.epoch(kEpoch + 1);
  b.clocks.on_verdict(late, at_s(0.221));
  CHECK(b.clocks.allows_motion(at_s(0.23)));

  msg::Feedback rebooted = b.feedback(0.24);
  rebooted.head().incarnation(6);
  rebooted.heard_stamp_ns(0);
  b.clocks.on_feedback(rebooted, kSelf, at_s(0.245));
  CHECK(b.clocks.allows_motion(at_s(0.25)));
  b.robot_s = 0.3;
  rebooted = b.feedback(0.26);
  rebooted.head().incarnation(6);
  b.clocks.on_feedback(rebooted, kSelf, at_s(0.265));
  CHECK(b.clocks.is_beyond_bound(at_s(0.27)));
}

TEST_CASE("echoes of somebody else's messages, and stamps that make no sense, do not count") {
  Between b;
  b.hear_robot(0);
  msg::Verdict foreign = b.verdict(0.01);
  foreign.asked_stamp_ns(foreign.asked_stamp_ns() + 1);
  b.clocks.on_verdict(foreign, at_s(0.011));
  foreign = b.verdict(0.01);
  foreign.robot(kRobot + 1);
  b.clocks.on_verdict(foreign, at_s(0.011));
  foreign = b.verdict(0.01);
  foreign.asked_stamp_ns(0);
  b.clocks.on_verdict(foreign, at_s(0.011));
  CHECK_FALSE(b.clocks.allows_motion(at_s(0.02)));
  CHECK(b.invalid(0.02) == 0);
  b.hear_coordinator(0.02);
  REQUIRE(b.clocks.allows_motion(at_s(0.03)));

  constexpr std::int64_t kHostile[] = {-1, std::numeric_limits<std::int64_t>::max(),
                                       std::numeric_limits<std::int64_t>::min()};
  const auto before = b.clocks.robot_to_coordinator(at_s(0.03));
  std::uint64_t refused = 0;
  for (const std::int64_t stamp : kHostile) {
    msg::Verdict v = b.verdict(0.03);
    v.head().stamp_ns(stamp);
    b.clocks.on_verdict(v, at_s(0.031));
    msg::Feedback f = b.feedback(0.03);
    f.heard_stamp_ns(stamp);
    b.clocks.on_feedback(f, kSelf, at_s(0.034));
    f = b.feedback(0.03);
    f.heard_at_ns(stamp);
    b.clocks.on_feedback(f, kSelf, at_s(0.034));
    f = b.feedback(0.03);
    f.at_ns(stamp);
    b.clocks.on_feedback(f, kSelf, at_s(0.034));
    refused += 4;
  }
  msg::Feedback other = b.feedback(0.03);
  other.obeyed_incarnation(kSelf + 1);
  other.at_ns(1);
  b.clocks.on_feedback(other, kSelf, at_s(0.034));
  other = b.feedback(0.03);
  other.robot(kRobot + 1);
  b.clocks.on_feedback(other, kSelf, at_s(0.034));
  CHECK(b.invalid(0.04) == refused);
  const auto after = b.clocks.robot_to_coordinator(at_s(0.03));
  REQUIRE(after);
  CHECK(after->low == before->low);
  CHECK(after->high == before->high);
}
