// SPDX-License-Identifier: Apache-2.0
#include "coordinator/ledger.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "common/motion/clearance.hpp"
#include "common/motion/robot_model.hpp"
#include "tests/unit/coordinator/floor.hpp"

using namespace sidestep;

namespace {

struct Two {
  Ledger ledger{floor_for_tests(), {1, 2}};
  Version a = standing(1, {0, 0}), b;
  explicit Two(double apart) : b(standing(2, {apart, 0})) {
    ledger.enter(1, {&a, 1});
    ledger.enter(2, {&b, 1});
    REQUIRE(ledger.conflicts().empty());
  }
  FactUse fact(const Version& executing, double at) {
    return ledger.on_executing(executing, at_s(at), false);
  }
};

}  // namespace

TEST_CASE("a clear candidate is granted, added, and removes nothing") {
  Two two(1);
  const Version p = continued(two.a, 10, 1, {3, 0});
  CHECK(two.ledger.grant(p).granted());
  REQUIRE(two.ledger.versions(1).size() == 2);
  CHECK(two.ledger.versions(1)[0].number == 0);
  CHECK(two.ledger.versions(1)[1].number == 10);
}

TEST_CASE(
    "a candidate that would come too near is refused and changes nothing, and the verdict names who is "
    "there") {
  Two two(0.2);
  const Ruling ruling = two.ledger.grant(continued(two.a, 10, 1, {3, 0}, 0.2));
  CHECK(ruling.reason == msg::REASON_CONFLICT);
  CHECK(ruling.blocker == 2);
  CHECK(two.ledger.versions(1).size() == 1);
}

TEST_CASE(
    "candidates are judged against everything that a robot may be executing, not against its newest wish") {
  Two two(0.5);
  // Robot 2 has been granted a move away, but the verdict may be lost and it may stand for ever.
  const Version away = continued(two.b, 10, 1, {3, 0}, 0.5);
  REQUIRE(two.ledger.grant(away).granted());
  const Version towards = continued(two.a, 20, 1, {3, 0}, 0.4);
  CHECK(is_clear(towards.trajectory, away.trajectory, 0.19));
  CHECK(two.ledger.grant(towards).reason == msg::REASON_CONFLICT);
  // As soon as it is known to be on its way, the place is free.
  REQUIRE(two.fact(away, 1.01) == FactUse::kUsed);
  CHECK(two.ledger.grant(towards).granted());
}

TEST_CASE("a base that the robot cannot be executing is refused") {
  Two two(1);
  Version p = continued(two.a, 10, 1, {3, 0});
  p.base = 7;
  CHECK(two.ledger.grant(p).reason == msg::REASON_BASE_UNKNOWN);
}

TEST_CASE("a candidate has to continue its base, obey the limits, come to rest and stay on the field") {
  Two two(1);
  const auto reason = [&](Vec2 offset, Vec2 velocity, Vec2 acceleration, double brake) {
    Trajectory trajectory(at_s(1), {offset, velocity});
    trajectory.append(from_seconds(0.1), acceleration);
    if (brake > 0) append_stop(trajectory, brake);
    return two.ledger.grant({1, 1, 10, 0, trajectory}).reason;
  };
  CHECK(reason({1e-3, 0}, {0, 0}, {0, 3}, 5) == msg::REASON_NOT_CONTINUOUS);
  CHECK(reason({0, 0}, {0, 1e-3}, {0, 3}, 5) == msg::REASON_NOT_CONTINUOUS);
  CHECK(reason({0, 0}, {0, 0}, {0, 3.1}, 5) == msg::REASON_BEYOND_LIMITS);
  CHECK(reason({0, 0}, {0, 0}, {0, 3}, 5.5) == msg::REASON_BEYOND_LIMITS);
  CHECK(reason({0, 0}, {0, 0}, {0, 3}, 0) == msg::REASON_NOT_AT_REST);
  CHECK(two.ledger.versions(1).size() == 1);
}

TEST_CASE("a fact removes older versions, and newer ones whose start is not after it") {
  Two two(5);
  const Version p = continued(two.a, 10, 1, {3, 0}), q = continued(two.a, 11, 2, {3, 0}),
                r = continued(p, 12, 3, {0, 3});
  for (const Version& v : {p, q, r}) REQUIRE(two.ledger.grant(v).granted());
  REQUIRE(two.fact(two.a, 1 - 1e-9) == FactUse::kUsed);
  CHECK(two.ledger.versions(1).size() == 4);
  REQUIRE(two.fact(two.a, 1.0) == FactUse::kUsed);  // 10 was not taken at its start
  REQUIRE(two.ledger.versions(1).size() == 3);
  REQUIRE(two.fact(q, 2.5) == FactUse::kUsed);
  REQUIRE(two.ledger.versions(1).size() == 2);
  CHECK(two.ledger.versions(1)[0].number == 11);
  CHECK(two.ledger.versions(1)[1].number == 12);
}

TEST_CASE("facts may come late, twice and in any order") {
  Two two(5);
  const Version p = continued(two.a, 10, 1, {3, 0}), q = continued(p, 11, 1.1, {3, 0});
  REQUIRE(two.ledger.grant(p).granted());
  REQUIRE(two.ledger.grant(q).granted());
  REQUIRE(two.fact(q, 1.2) == FactUse::kUsed);
  for (int i = 0; i < 2; ++i) {
    CHECK(two.fact(p, 1.05) == FactUse::kLate);
    CHECK(two.fact(two.a, 0.5) == FactUse::kLate);
    CHECK(two.fact(q, 1.15) == FactUse::kUsed);
  }
  REQUIRE(two.ledger.versions(1).size() == 1);
  CHECK(two.ledger.versions(1)[0].number == 11);
}

TEST_CASE("a fact that cannot be true if the ledger is says so, and changes nothing") {
  Two two(5);
  const Version p = continued(two.a, 10, 1, {3, 0}), q = continued(p, 12, 1.1, {3, 0});
  REQUIRE(two.ledger.grant(p).granted());
  REQUIRE(two.ledger.grant(q).granted());
  Version unknown = p, other = p;
  unknown.number = 11;
  CHECK(two.fact(unknown, 100) == FactUse::kContradiction);
  unknown.number = 999;
  CHECK(two.fact(unknown, 100) == FactUse::kContradiction);
  // One number, two versions.
  other.trajectory = continued(two.a, 10, 1, {2.9, 0}).trajectory;
  CHECK(two.fact(other, 100) == FactUse::kContradiction);
  CHECK(two.ledger.versions(1).size() == 3);
  // What is older than everything it holds may be late.
  REQUIRE(two.fact(q, 1.2) == FactUse::kUsed);
  CHECK(two.fact(unknown, 1.3) == FactUse::kContradiction);
  CHECK(two.fact(p, 1.3) == FactUse::kLate);
}

TEST_CASE("without facts the ledger fills up and then grants no more") {
  Two two(10);
  Version last = two.a;
  msg::Reason reason = msg::REASON_GRANTED;
  for (VersionNumber n = 1; n < 20 && reason == msg::REASON_GRANTED; ++n) {
    const Version next = continued(last, n, 1 + 0.02 * static_cast<double>(n), {0.5, 0});
    reason = two.ledger.grant(next).reason;
    last = next;
  }
  CHECK(reason == msg::REASON_LEDGER_FULL);
  CHECK(two.ledger.versions(1).size() == VersionSet::kCapacity);
}

TEST_CASE("whatever is granted, lost and reported, all versions of different robots stay clear") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u, 5u);
  CAPTURE(seed);
  Rng rng(seed);
  const FloorRules rules = floor_for_tests();
  std::vector<RobotId> roster{0, 1, 2, 3, 4, 5, 6, 7};
  Ledger ledger(rules, roster);
  std::map<RobotId, Version> executing;
  for (const RobotId robot : roster) {
    executing[robot] = standing(robot, 0.3 * rotated({1, 0}, robot * 0.785398));
    ledger.enter(robot, {&executing[robot], 1});
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
    const Vec2 desired =
        limited(sample(velocity, rules.limits, rng), velocity, rules.limits, from_seconds(0.15));
    const Ruling ruling = ledger.grant(continued(base, number, start, desired, 0.15));
    grants += ruling.granted();
    conflicts += ruling.reason == msg::REASON_CONFLICT;
    if (rng.chance(0.5)) {
      // The robot happens to take one of its versions whose time has come, or stays with what it has.
      Version& current = executing[robot];
      for (const Version& v : ledger.versions(robot)) {
        const bool possible = v.base == current.number && v.trajectory.start() > current.trajectory.start() &&
                              v.trajectory.start() <= at_s(now);
        if (possible && rng.chance(0.7)) {
          current = v;
          break;
        }
      }
      // Only a true fact: whatever could still have been taken with a start before now was not.
      REQUIRE(ledger.on_executing(current, at_s(now), false) == FactUse::kUsed);
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
