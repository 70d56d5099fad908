// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/clock_monitor.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"

namespace sidestep::clock_monitor_test {

constexpr Incarnation kSelf = 1000;
constexpr Epoch kEpoch = 7;
const Duration kBound = from_seconds(0.0005);
constexpr double kCycle_s = 1.0 / 60;

Time at_s(double seconds) { return time_from_ns(1'000'000'000'000'000) + from_seconds(seconds); }

/// An agent with a robot and a coordinator whose clocks are ahead of the agent's by `robot_s` and
/// `coordinator_s`. Network delays are uniform from `min_delay_s` to `min_delay_s + spread_s`.
struct ClockFixture {
  double robot_s = 0, coordinator_s = 0, min_delay_s = 0.0002, spread_s = 0.0002;
  Rng rng{1};
  ClockMonitor clocks{SafetyBudget{}, 0.01};

  ClockFixture() { clocks.on_epoch(kEpoch); }
  double delay() { return min_delay_s + rng.uniform(0, spread_s); }
  RobotReport robot_report(double sent) {
    const double received = sent + delay(), answered = received + 0.003;
    RobotReport f;
    f.robot_incarnation = 5;
    f.obeyed_incarnation = kSelf;
    f.command = {at_s(sent), at_s(received + robot_s)};
    f.valid_at = at_s(answered + robot_s);
    return f;
  }
  Verdict verdict(double asked) {
    clocks.on_request_sent(at_s(asked));
    Verdict v;
    v.epoch = kEpoch;
    v.request_sent_at = at_s(asked);
    v.sent_at = at_s(asked + delay() + coordinator_s);
    return v;
  }
  void measure_robot(double sent) {
    const RobotReport f = robot_report(sent);
    const Time answered = f.valid_at - from_seconds(robot_s);
    clocks.on_robot_report(f, kSelf, answered + from_seconds(delay()));
  }
  void measure_coordinator(double asked) {
    const Verdict v = verdict(asked);
    const Time answered = v.sent_at - from_seconds(coordinator_s);
    clocks.on_verdict(v, answered + from_seconds(delay()));
  }
  std::uint64_t invalid() const { return drops_of(clocks).total(DropReason::kImplausibleClock); }
  void measure_both(double from, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      measure_robot(from + i * kCycle_s);
      measure_coordinator(from + i * kCycle_s);
    }
  }
};

TEST_CASE("motion requires recent measurements of both clocks") {
  ClockFixture f;
  CHECK_FALSE(f.clocks.allows_motion(at_s(0)));
  CHECK(f.clocks.is_measurement_due(at_s(0)));
  f.measure_robot(0);
  CHECK_FALSE(f.clocks.allows_motion(at_s(0.01)));
  CHECK_FALSE(f.clocks.is_beyond_bound(at_s(0.01)));
  msg::AgentStatus status;
  f.clocks.fill(status, at_s(0.01));
  CHECK(status.clock_uncertainty_s() < 0);
  f.measure_coordinator(0);
  CHECK(f.clocks.allows_motion(at_s(0.01)));
  f.clocks.fill(status, at_s(0.01));
  CHECK(status.clock_uncertainty_s() > 0);
  f.measure_both(0.01, 48);
  REQUIRE(f.clocks.max_speed_mps(at_s(0.85)) > 2);
  CHECK_FALSE(f.clocks.is_measurement_due(at_s(1.7)));
  CHECK(f.clocks.is_measurement_due(at_s(1.9)));
  f.measure_robot(3.5);
  CHECK_FALSE(f.clocks.allows_motion(at_s(3.6)));
  f.measure_coordinator(3.6);
  CHECK(f.clocks.allows_motion(at_s(3.7)));
  CHECK_FALSE(f.clocks.allows_motion(at_s(6)));
}

TEST_CASE(
    "a robot whose clock agrees with the coordinator's within the bound may move, even if the agent's clock "
    "is wrong") {
  const double own_s = GENERATE(0.0, 0.1, -3600.0, 5.0);
  const double offset_s = GENERATE(0.0, 0.0004, -0.0004);
  CAPTURE(own_s, offset_s);
  ClockFixture f;
  f.coordinator_s = own_s;
  f.robot_s = own_s + offset_s;
  f.measure_both(0, 60);
  CHECK(f.clocks.allows_motion(at_s(1)));
  const auto known = f.clocks.robot_coordinator_offset(at_s(1));
  REQUIRE(known);
  CHECK(known->low <= from_seconds(offset_s));
  CHECK(known->high >= from_seconds(offset_s));
  // The agent also estimates its robot's clock.
  CHECK(to_seconds(f.clocks.robot_offset()) == Approx(f.robot_s).margin(0.0006));
  CHECK(f.clocks.max_robot_offset(at_s(1)) >= from_seconds(f.robot_s) - Duration{1000});
  if (own_s == 0 && offset_s == 0) CHECK(f.clocks.robot_offset() == Duration{0});
}

TEST_CASE(
    "an offset in either direction is detected if it exceeds the bound by more than the fastest round "
    "trips") {
  const double offset_s = GENERATE(0.0011, -0.0011, 0.02, -0.02, 3600.0);
  CAPTURE(offset_s);
  ClockFixture f;
  f.robot_s = offset_s;
  f.measure_both(0, 60);
  CHECK(f.clocks.is_beyond_bound(at_s(1)));
  CHECK_FALSE(f.clocks.allows_motion(at_s(1)));
  msg::AgentStatus status;
  status.agent_state(msg::AgentState::AGENT_WAITING);
  f.clocks.fill(status, at_s(1));
  CHECK(status.agent_state() == msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND);
  CHECK(std::abs(status.clock_offset_s() - offset_s) <= status.clock_uncertainty_s());
  // The clock is corrected.
  f.robot_s = 0;
  f.measure_both(1, 10);
  CHECK(f.clocks.allows_motion(at_s(1 + 10 * kCycle_s)));
}

TEST_CASE("the larger the offset that the measurements permit, the lower the maximum speed") {
  ClockFixture quick;
  CHECK(quick.clocks.max_speed_mps(at_s(0)) == 0);
  quick.measure_robot(0);
  CHECK(quick.clocks.max_speed_mps(at_s(0.01)) == 0);
  quick.measure_both(0, 60);
  CHECK(quick.clocks.max_speed_mps(at_s(1)) > 2);
  CHECK(quick.clocks.max_speed_mps(at_s(4)) == 0);  // the last measurement is too old

  // The default margin reserves 2 mm per robot for clock errors.
  ClockFixture slow;
  slow.min_delay_s = 0.01;
  slow.spread_s = 0;
  slow.measure_both(0, 60);
  CHECK(slow.clocks.max_speed_mps(at_s(1)) == Approx(0.002 / 0.02).epsilon(0.05));
  slow.robot_s = 0.004;
  slow.measure_both(1, 60);
  CHECK_FALSE(slow.clocks.is_beyond_bound(at_s(2)));
  // Before the change, the offset may have been anywhere in the interval, so both offsets remain possible.
  CHECK(slow.clocks.max_speed_mps(at_s(2)) <= 0.002 / 0.019);

  for (const double offset_s : {0.0004, -0.0004}) {
    ClockFixture known;
    known.robot_s = offset_s;
    known.min_delay_s = known.spread_s = 0.00005;
    known.measure_both(0, 60);
    CHECK(known.clocks.max_speed_mps(at_s(1)) > 2);
    CHECK(known.clocks.max_speed_mps(at_s(1)) < 0.002 / 0.0004);
  }
}

TEST_CASE("the larger the offset that the measurements permit, the larger the robot's possible lag") {
  ClockFixture f;
  f.measure_both(0, 60);
  CHECK(f.clocks.max_lag(at_s(1)) < Duration{500'000});
  CHECK(f.clocks.max_lag(at_s(4)) == ClockMonitor::kMaxMeasurementAge);  // the last measurement is too old

  const double offset_s = GENERATE(0.0, -0.06, 0.06);
  CAPTURE(offset_s);
  ClockFixture slow;
  slow.robot_s = offset_s;
  slow.min_delay_s = 0.05;
  slow.spread_s = 0;
  slow.measure_both(0, 60);
  REQUIRE(slow.clocks.allows_motion(at_s(1.2)));
  // The measured offset is within 0.1 s of the true one. A robot whose clock is behind lags.
  CHECK(to_seconds(slow.clocks.max_lag(at_s(1.2)) + kBound) == Approx(0.1 - offset_s).epsilon(0.02));
}

TEST_CASE("a clock jump during motion is detected within two cycles") {
  ClockFixture f;
  f.measure_both(0, 60);
  REQUIRE(f.clocks.allows_motion(at_s(1)));
  f.robot_s = 0.05;
  f.measure_both(1, 2);
  CHECK(f.clocks.is_beyond_bound(at_s(1 + 2 * kCycle_s)));
}

TEST_CASE("an agent still knows the measured clock of a coordinator that begins another epoch") {
  ClockFixture f;
  f.measure_both(0, 10);
  const auto measured = f.clocks.robot_coordinator_offset(at_s(0.2));
  REQUIRE(measured);
  f.min_delay_s = 0.05;
  double t = 0.2;
  const auto uncertainty_in_epoch = [&](Epoch epoch, std::uint32_t sender, Incarnation incarnation) {
    f.clocks.on_epoch(epoch);
    CHECK_FALSE(f.clocks.robot_coordinator_offset(at_s(t)));
    CHECK(f.clocks.is_measurement_due(at_s(t)));
    Verdict verdict = f.verdict(t);
    verdict.epoch = epoch;
    verdict.sender = sender;
    verdict.incarnation = incarnation;
    f.clocks.on_verdict(verdict, at_s(t += 0.11));
    const auto offset = f.clocks.robot_coordinator_offset(at_s(t));
    REQUIRE(offset);
    return offset->uncertainty();
  };
  CHECK(uncertainty_in_epoch(kEpoch + 1, 0, 0) < measured->uncertainty() + from_seconds(0.0001));
  CHECK(uncertainty_in_epoch(kEpoch + 2, 1, 0) > from_seconds(0.05));
  CHECK(uncertainty_in_epoch(kEpoch + 3, 0, 0) < measured->uncertainty() + from_seconds(0.0003));
  CHECK(uncertainty_in_epoch(kEpoch + 4, 0, 1) > from_seconds(0.05));
}

TEST_CASE("clock measurements start over in a new epoch and after a restart of the robot") {
  ClockFixture f;
  f.measure_both(0, 10);
  REQUIRE(f.clocks.allows_motion(at_s(0.2)));
  f.clocks.on_epoch(kEpoch + 1);
  CHECK_FALSE(f.clocks.allows_motion(at_s(0.2)));
  Verdict late = f.verdict(0.2);
  f.clocks.on_verdict(late, at_s(0.201));
  CHECK_FALSE(f.clocks.allows_motion(at_s(0.21)));
  late = f.verdict(0.22);
  late.epoch = kEpoch + 1;
  f.clocks.on_verdict(late, at_s(0.221));
  CHECK(f.clocks.allows_motion(at_s(0.23)));

  RobotReport rebooted = f.robot_report(0.24);
  rebooted.robot_incarnation = 6;
  rebooted.command.reset();
  f.clocks.on_robot_report(rebooted, kSelf, at_s(0.245));
  CHECK(f.clocks.allows_motion(at_s(0.25)));
  f.robot_s = 0.3;
  rebooted = f.robot_report(0.26);
  rebooted.robot_incarnation = 6;
  f.clocks.on_robot_report(rebooted, kSelf, at_s(0.265));
  CHECK(f.clocks.is_beyond_bound(at_s(0.27)));
}

TEST_CASE("clock measurements from before a robot's restart do not narrow the offset interval after it") {
  ClockFixture f;
  f.spread_s = 0;
  f.measure_both(0, 10);
  REQUIRE(f.clocks.max_robot_offset(at_s(0.2)) < from_seconds(0.0004));
  f.robot_s = 0.0005;
  f.min_delay_s = 0.001;
  RobotReport restarted = f.robot_report(0.2);
  restarted.robot_incarnation = 6;
  f.clocks.on_robot_report(restarted, kSelf,
                           restarted.valid_at - from_seconds(f.robot_s) + from_seconds(0.001));
  CHECK(f.clocks.max_robot_offset(at_s(0.21)) >= from_seconds(f.robot_s));
}

TEST_CASE("echoes of other senders' messages and impossible timestamps are ignored") {
  ClockFixture f;
  f.measure_robot(0);
  Verdict foreign = f.verdict(0.01);
  foreign.request_sent_at += Duration{1};
  f.clocks.on_verdict(foreign, at_s(0.011));
  foreign.request_sent_at = Time{};
  f.clocks.on_verdict(foreign, at_s(0.011));
  CHECK_FALSE(f.clocks.allows_motion(at_s(0.02)));
  CHECK(f.invalid() == 0);
  f.measure_coordinator(0.02);
  REQUIRE(f.clocks.allows_motion(at_s(0.03)));

  const auto before = f.clocks.robot_coordinator_offset(at_s(0.03));
  std::uint64_t refused = 0;
  for (const Time stamp : {time_from_ns(-1), Time::max(), Time::min()}) {
    Verdict v = f.verdict(0.03);
    v.sent_at = stamp;
    f.clocks.on_verdict(v, at_s(0.031));
    RobotReport hostile = f.robot_report(0.03);
    hostile.command->sent_at = stamp;
    f.clocks.on_robot_report(hostile, kSelf, at_s(0.034));
    hostile = f.robot_report(0.03);
    hostile.command->received_at = stamp;
    f.clocks.on_robot_report(hostile, kSelf, at_s(0.034));
    hostile = f.robot_report(0.03);
    hostile.valid_at = stamp;
    f.clocks.on_robot_report(hostile, kSelf, at_s(0.034));
    refused += 4;
  }
  RobotReport other = f.robot_report(0.03);
  other.obeyed_incarnation = kSelf + 1;
  other.valid_at = time_from_ns(1);
  f.clocks.on_robot_report(other, kSelf, at_s(0.034));
  CHECK(f.invalid() == refused);
  const auto after = f.clocks.robot_coordinator_offset(at_s(0.03));
  REQUIRE(after);
  CHECK(after->low == before->low);
  CHECK(after->high == before->high);
}

TEST_CASE("an agent measures the other clocks again after its own clock has been set") {
  const double jump_s = GENERATE(-3500.0, -5.0, -0.05, 0.05, 5.0, 3500.0);
  CAPTURE(jump_s);
  ClockFixture f;
  f.measure_both(0, 60);
  REQUIRE(f.clocks.allows_motion(at_s(1.01)));
  // From now on, both other clocks are behind or ahead of the agent's.
  f.robot_s = f.coordinator_s = -jump_s;
  const double now = 1 + jump_s;
  if (jump_s < 0) CHECK_FALSE(f.clocks.allows_motion(at_s(now)));
  if (jump_s < 0) CHECK(f.clocks.is_measurement_due(at_s(now)));
  f.measure_both(now, 10);
  CHECK(f.clocks.allows_motion(at_s(now + 0.2)));
  CHECK(to_seconds(f.clocks.robot_offset()) == Approx(-jump_s).margin(0.002));
}

}  // namespace sidestep::clock_monitor_test
