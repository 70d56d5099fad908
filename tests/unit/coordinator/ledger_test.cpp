// SPDX-License-Identifier: Apache-2.0
#include "coordinator/ledger.hpp"

#include <map>

#include "common/motion/clearance.hpp"
#include "common/motion/robot_model.hpp"
#include "tests/catch.hpp"
#include "tests/unit/coordinator/floor.hpp"

namespace sidestep::ledger_test {

struct Two {
  Ledger ledger{floor_for_tests(), {1, 2}};
  Version a = rest_version(1, {0, 0}), b;
  explicit Two(double apart) : b(rest_version(2, {apart, 0})) {
    ledger.register_robot(1, {&a, 1});
    ledger.register_robot(2, {&b, 1});
    REQUIRE(ledger.conflicts().empty());
  }
  ReportOutcome report(const Version& executing, double at) {
    return ledger.on_executing(executing, at_s(at), false);
  }
};

TEST_CASE("a clear candidate is granted and added, and nothing is removed") {
  Two two(1);
  const Version p = continued(two.a, 10, 1, {3, 0});
  CHECK(two.ledger.grant(p).is_granted());
  REQUIRE(two.ledger.versions(1).size() == 2);
  CHECK(two.ledger.versions(1)[0].number == 0);
  CHECK(two.ledger.versions(1)[1].number == 10);
}

TEST_CASE("a conflicting candidate is refused and changes nothing, and the ruling names the other robot") {
  Two two(0.2);
  const Ruling ruling = two.ledger.grant(continued(two.a, 10, 1, {3, 0}, 0.2));
  CHECK(ruling.reason == msg::Reason::REASON_CONFLICT);
  CHECK(ruling.blocker == 2);
  CHECK(two.ledger.versions(1).size() == 1);
}

TEST_CASE("candidates are checked against all versions that a robot may execute, not only its newest") {
  Two two(0.5);
  // Robot 2 has been granted a move away, but the verdict may be lost, so the robot may stay where it is.
  const Version away = continued(two.b, 10, 1, {3, 0}, 0.5);
  REQUIRE(two.ledger.grant(away).is_granted());
  const Version towards = continued(two.a, 20, 1, {3, 0}, 0.4);
  CHECK(is_clear(towards.trajectory, away.trajectory, 0.19));
  CHECK(two.ledger.grant(towards).reason == msg::Reason::REASON_CONFLICT);
  // Once robot 2 is known to execute the move, its old position is free.
  REQUIRE(two.report(away, 1.01) == ReportOutcome::kApplied);
  CHECK(two.ledger.grant(towards).is_granted());
}

TEST_CASE("a candidate whose base is not in the ledger is refused") {
  Two two(1);
  Version p = continued(two.a, 10, 1, {3, 0});
  p.base = 7;
  CHECK(two.ledger.grant(p).reason == msg::Reason::REASON_BASE_UNKNOWN);
}

TEST_CASE("a candidate must continue its base, obey the limits, come to rest and stay on the field") {
  Two two(1);
  const auto reason = [&](Vec2 offset, Vec2 velocity, Vec2 acceleration, double brake) {
    Trajectory trajectory(at_s(1), {offset, velocity});
    trajectory.append(from_seconds(0.1), acceleration);
    if (brake > 0) append_stop(trajectory, brake);
    return two.ledger.grant({1, 1, 10, 0, trajectory}).reason;
  };
  CHECK(reason({1e-3, 0}, {0, 0}, {0, 3}, 5) == msg::Reason::REASON_NOT_CONTINUOUS);
  CHECK(reason({0, 0}, {0, 1e-3}, {0, 3}, 5) == msg::Reason::REASON_NOT_CONTINUOUS);
  CHECK(reason({0, 0}, {0, 0}, {0, 3.1}, 5) == msg::Reason::REASON_BEYOND_LIMITS);
  CHECK(reason({0, 0}, {0, 0}, {0, 3}, 5.5) == msg::Reason::REASON_BEYOND_LIMITS);
  CHECK(reason({0, 0}, {0, 0}, {0, 3}, 0) == msg::Reason::REASON_NOT_AT_REST);
  CHECK(two.ledger.versions(1).size() == 1);
}

TEST_CASE("a fact removes older versions, and newer versions that start no later than the time of the fact") {
  Two two(5);
  const Version p = continued(two.a, 10, 1, {3, 0}), q = continued(two.a, 11, 2, {3, 0}),
                r = continued(p, 12, 3, {0, 3});
  for (const Version& v : {p, q, r}) REQUIRE(two.ledger.grant(v).is_granted());
  REQUIRE(two.report(two.a, 1 - 1e-9) == ReportOutcome::kApplied);
  CHECK(two.ledger.versions(1).size() == 4);
  REQUIRE(two.report(two.a, 1.0) ==
          ReportOutcome::kApplied);  // the robot did not switch to version 10 at its start
  REQUIRE(two.ledger.versions(1).size() == 3);
  REQUIRE(two.report(q, 2.5) == ReportOutcome::kApplied);
  REQUIRE(two.ledger.versions(1).size() == 2);
  CHECK(two.ledger.versions(1)[0].number == 11);
  CHECK(two.ledger.versions(1)[1].number == 12);
}

TEST_CASE("facts that arrive late, repeatedly or out of order remove no version") {
  Two two(5);
  const Version p = continued(two.a, 10, 1, {3, 0}), q = continued(p, 11, 1.1, {3, 0});
  REQUIRE(two.ledger.grant(p).is_granted());
  REQUIRE(two.ledger.grant(q).is_granted());
  REQUIRE(two.report(q, 1.2) == ReportOutcome::kApplied);
  for (int i = 0; i < 2; ++i) {
    CHECK(two.report(p, 1.05) == ReportOutcome::kStale);
    CHECK(two.report(two.a, 0.5) == ReportOutcome::kStale);
    CHECK(two.report(q, 1.15) == ReportOutcome::kApplied);
  }
  REQUIRE(two.ledger.versions(1).size() == 1);
  CHECK(two.ledger.versions(1)[0].number == 11);
}

TEST_CASE("a fact that is inconsistent with the ledger is a contradiction and removes nothing") {
  Two two(5);
  const Version p = continued(two.a, 10, 1, {3, 0}), q = continued(p, 12, 1.1, {3, 0});
  REQUIRE(two.ledger.grant(p).is_granted());
  REQUIRE(two.ledger.grant(q).is_granted());
  Version unknown = p, other = p;
  unknown.number = 11;
  CHECK(two.report(unknown, 100) == ReportOutcome::kContradiction);
  unknown.number = 999;
  CHECK(two.report(unknown, 100) == ReportOutcome::kContradiction);
  // A known number with different content.
  other.trajectory = continued(two.a, 10, 1, {2.9, 0}).trajectory;
  CHECK(two.report(other, 100) == ReportOutcome::kContradiction);
  // The version that the robot reported last is kept in addition.
  REQUIRE(two.ledger.versions(1).size() == 4);
  CHECK(two.ledger.versions(1)[3].trajectory.rest_position_m() == other.trajectory.rest_position_m());
  CHECK(two.ledger.is_quarantined(1));
}

TEST_CASE("a fact about a version older than all held versions is late, not a contradiction") {
  Two two(5);
  const Version p = continued(two.a, 10, 1, {3, 0}), q = continued(p, 12, 1.1, {3, 0});
  REQUIRE(two.ledger.grant(p).is_granted());
  REQUIRE(two.ledger.grant(q).is_granted());
  REQUIRE(two.report(q, 1.2) == ReportOutcome::kApplied);
  CHECK(two.report(p, 1.3) == ReportOutcome::kStale);
  CHECK_FALSE(two.ledger.is_quarantined(1));
}

TEST_CASE("a quarantine ends after sixty consecutive facts that agree with the ledger") {
  Two two(5);
  const Version p = continued(two.a, 10, 1, {3, 0});
  REQUIRE(two.ledger.grant(p).is_granted());
  Version unknown = p;
  unknown.number = 999;
  const auto report = [&](const Version& executing, int times) {
    for (int i = 0; i < times; ++i) (void)two.report(executing, 1.5);
  };
  REQUIRE(two.report(unknown, 1.2) == ReportOutcome::kContradiction);
  report(p, 59);
  CHECK(two.ledger.is_quarantined(1));
  CHECK(two.ledger.versions(1).size() == 3);
  REQUIRE(two.report(unknown, 1.3) == ReportOutcome::kContradiction);
  report(p, 59);
  CHECK(two.ledger.is_quarantined(1));
  report(p, 1);
  CHECK_FALSE(two.ledger.is_quarantined(1));
  REQUIRE(two.ledger.versions(1).size() == 1);
  CHECK(two.ledger.versions(1)[0].number == 10);
}

TEST_CASE("a quarantined robot that is pushed keeps its versions in addition to its own stop") {
  Two two(5);
  REQUIRE(two.report(continued(two.a, 999, 1, {3, 0}), 1.2) == ReportOutcome::kContradiction);
  Version stop = rest_version(1, {0.5, 0}, 5000);
  CHECK(two.ledger.on_executing(stop, at_s(2), true) == ReportOutcome::kApplied);
  REQUIRE(two.ledger.versions(1).size() == 2);
  CHECK(two.ledger.versions(1)[1].number == 5000);
  for (int i = 0; i < 60; ++i) (void)two.ledger.on_executing(stop, at_s(3), true);
  CHECK_FALSE(two.ledger.is_quarantined(1));
  REQUIRE(two.ledger.versions(1).size() == 1);
  CHECK(two.ledger.versions(1)[0].number == 5000);
}

TEST_CASE("without facts the ledger fills up and then grants nothing") {
  Two two(10);
  Version last = two.a;
  msg::Reason reason = msg::Reason::REASON_GRANTED;
  for (VersionNumber n = 1; n < 20 && reason == msg::Reason::REASON_GRANTED; ++n) {
    const Version next = continued(last, n, 1 + 0.02 * static_cast<double>(n), {0.5, 0});
    reason = two.ledger.grant(next).reason;
    last = next;
  }
  CHECK(reason == msg::Reason::REASON_LEDGER_FULL);
  CHECK(two.ledger.versions(1).size() == VersionSet::kCapacity);
}

TEST_CASE("versions of different robots stay clear of each other through random grants, losses and facts") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u, 5u);
  CAPTURE(seed);
  Rng rng(seed);
  const FloorRules rules = floor_for_tests();
  std::vector<RobotId> roster{0, 1, 2, 3, 4, 5, 6, 7};
  Ledger ledger(rules, roster);
  std::map<RobotId, Version> executing;
  for (const RobotId robot : roster) {
    executing[robot] = rest_version(robot, 0.3 * rotated({1, 0}, robot * 0.785398));
    ledger.register_robot(robot, {&executing[robot], 1});
  }
  REQUIRE(ledger.conflicts().empty());
  std::uint64_t grants = 0, conflicts = 0;
  double now = 1;
  for (VersionNumber number = 1; number < 6000; ++number) {
    const auto robot = static_cast<RobotId>(rng.below(roster.size()));
    now += 0.002;
    const auto held = ledger.versions(robot);
    const Version base = held[rng.below(held.size())];
    const double start = std::max(now, to_seconds(base.trajectory.start().time_since_epoch()) + 1e-3) + 0.01;
    const Vec2 velocity = base.trajectory.state_at(at_s(start)).velocity_mps;
    const Vec2 desired = limit_acceleration(sample_acceleration(velocity, rules.limits, rng), velocity,
                                            rules.limits, from_seconds(0.15));
    const Ruling ruling = ledger.grant(continued(base, number, start, desired, 0.15));
    grants += ruling.is_granted();
    conflicts += ruling.reason == msg::Reason::REASON_CONFLICT;
    if (rng.chance(0.5)) {
      // The robot switches to one of its due versions or keeps its current one.
      Version& current = executing[robot];
      for (const Version& v : ledger.versions(robot)) {
        const bool possible = v.base == current.number && v.trajectory.start() > current.trajectory.start() &&
                              v.trajectory.start() <= at_s(now);
        if (possible && rng.chance(0.7)) {
          current = v;
          break;
        }
      }
      // The fact is true: the robot did not switch to any other version that starts before now.
      REQUIRE(ledger.on_executing(current, at_s(now), false) == ReportOutcome::kApplied);
    }
    if (number % 100 != 0) continue;
    for (const RobotId i : roster) {
      for (const RobotId j : roster) {
        if (i >= j) continue;
        for (const Version& v : ledger.versions(i)) {
          for (const Version& w : ledger.versions(j)) {
            const Time from = std::max(v.trajectory.start(), w.trajectory.start());
            for (int k = 0; k <= 40; ++k) {
              const Time t = from + from_seconds(0.02 * k);
              const double distance =
                  (v.trajectory.state_at(t).position_m - w.trajectory.state_at(t).position_m).norm();
              REQUIRE(distance >= rules.min_separation_m());
            }
          }
        }
      }
    }
  }
  CHECK(grants > 200);
  CHECK(conflicts > 200);
}

}  // namespace sidestep::ledger_test
