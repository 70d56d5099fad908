// SPDX-License-Identifier: Apache-2.0
// External events in the ledger: robots lose their references, epochs begin with conflicts, robots are lifted
// and placed.
#include <algorithm>
#include <map>

#include "common/motion/escape.hpp"
#include "common/motion/robot_model.hpp"
#include "coordinator/ledger.hpp"
#include "tests/catch.hpp"
#include "tests/unit/coordinator/floor.hpp"

namespace sidestep::ledger_disturbance_test {

constexpr auto kNotContinuous = msg::Reason::REASON_NOT_CONTINUOUS;

Version off_reference(RobotId robot, VersionNumber number, double at, Vec2 position, Vec2 velocity,
                      double inflation_m = 0) {
  Trajectory stop(at_s(at), {position, velocity});
  append_stop(stop, 5);
  return {robot, 1, number, 0, stop, inflation_m};
}

Vec2 random_in_disc(Rng& rng, double max_norm) {
  const Vec2 direction = rotated({1, 0}, rng.uniform(0, 6.28));
  return rng.uniform(0, max_norm) * direction;
}

struct Two {
  Ledger ledger{floor_for_tests(), {1, 2}};
  Version a, b;
  Two(Vec2 at_a, Vec2 at_b) : a(rest_version(1, at_a)), b(rest_version(2, at_b)) {
    ledger.register_robot(1, {&a, 1});
    ledger.register_robot(2, {&b, 1});
  }
};

/// Minimum distance between two trajectories' points from `from` on: by sampling, and a ternary search around
/// each local minimum of the samples.
double min_distance_m(const Trajectory& a, const Trajectory& b, Time from) {
  const auto distance = [&](double t_s) {
    const Time t = from + from_seconds(t_s);
    return (a.state_at(t).position_m - b.state_at(t).position_m).norm();
  };
  constexpr double kStep_s = 0.01;
  const double end_s = std::max(0.0, to_seconds(std::max(a.end(), b.end()) - from)) + kStep_s;
  double min_distance = distance(0);
  for (double t = 0; t < end_s; t += kStep_s) {
    double low = std::max(0.0, t - kStep_s), high = t + kStep_s;
    if (distance(t) > distance(low) || distance(t) > distance(high)) continue;
    for (int i = 0; i < 40; ++i) {
      const double third = (high - low) / 3;
      if (distance(low + third) < distance(high - third)) {
        high -= third;
      } else {
        low += third;
      }
    }
    min_distance = std::min({min_distance, distance(low), distance(t)});
  }
  return std::min(min_distance, (a.rest_position_m() - b.rest_position_m()).norm());
}

/// The amount by which two robots' versions violate their required separation; 0 if they are clear.
double shortfall_m(const Ledger& ledger, RobotId i, RobotId j, double min_separation_m) {
  double worst = 0;
  for (const Version& v : ledger.versions(i)) {
    for (const Version& w : ledger.versions(j)) {
      const Time from = std::max(v.trajectory.start(), w.trajectory.start());
      const double separation = min_separation_m + v.inflation_m + w.inflation_m;
      worst = std::max(worst, separation - min_distance_m(v.trajectory, w.trajectory, from));
    }
  }
  return worst;
}

TEST_CASE("the own stop of a robot that lost its reference replaces all its versions without checks") {
  Two two({0, 0}, {1, 0});
  const Version p = continued(two.a, 10, 1, {3, 0});
  REQUIRE(two.ledger.grant(p).is_granted());
  const Version stop = off_reference(1, 1000, 0.9, {0.5, 0}, {2.5, 0}, 0.01);
  CHECK(two.ledger.on_executing(stop, at_s(0.9), true) == ReportOutcome::kApplied);
  REQUIRE(two.ledger.versions(1).size() == 1);
  CHECK(two.ledger.versions(1)[0].number == 1000);
  REQUIRE(two.ledger.conflicts().size() == 1);
  CHECK(two.ledger.conflicts()[0] == Conflict{1, 2});
  // The same fact arrives again, then an earlier one.
  CHECK(two.ledger.on_executing(stop, at_s(0.95), true) == ReportOutcome::kApplied);
  CHECK(two.ledger.on_executing(two.a, at_s(0.8), false) == ReportOutcome::kStale);
  CHECK(two.ledger.grant(continued(p, 11, 1.1, {3, 0})).reason == msg::Reason::REASON_BASE_UNKNOWN);
}

TEST_CASE("an own stop that is not newer than all versions is a contradiction") {
  Two two({0, 0}, {1, 0});
  const Version p = continued(two.a, 10, 1, {0, 3});
  REQUIRE(two.ledger.grant(p).is_granted());
  CHECK(two.ledger.on_executing(off_reference(1, 5, 0.9, {0, 0.1}, {0, 0}), at_s(0.9), true) ==
        ReportOutcome::kContradiction);
  CHECK(two.ledger.versions(1).size() == 3);  // the robot is quarantined, and its stop is kept in addition
}

TEST_CASE("other robots keep clear of a robot's inflation, which ends only where the robot rests") {
  Two two({0, 0}, {1, 0});
  const Version stop = off_reference(1, 1000, 0.5, {0, 0}, {0, 0.5}, 0.05);
  REQUIRE(two.ledger.on_executing(stop, at_s(0.5), true) == ReportOutcome::kApplied);
  CHECK(two.ledger.conflicts().empty());
  // Robot 2 comes to rest near robot 1. It is clear of robot 1 without inflation, but not with an inflation
  // of 0.05 m.
  Version near = continued(two.b, 20, 1, {-3, 0}, 0.3);
  const double rest_m = near.trajectory.rest_position_m().x();
  CAPTURE(rest_m);
  const Version adjacent = rest_version(1, {rest_m - 0.22, 0.05});
  Two exact(adjacent.trajectory.rest_position_m(), {1, 0}),
      inflated(adjacent.trajectory.rest_position_m(), {1, 0});
  CHECK(exact.ledger.grant(near).is_granted());
  Version larger = off_reference(1, 1000, 0.5, {rest_m - 0.22, 0.05}, {0, 0}, 0.05);
  REQUIRE(inflated.ledger.on_executing(larger, at_s(0.5), true) == ReportOutcome::kApplied);
  CHECK(inflated.ledger.grant(near).reason == msg::Reason::REASON_CONFLICT);

  Version moving = continued(stop, 1001, 0.52, {0, 1}), other = moving;
  moving.inflation_m = 0;
  CHECK(two.ledger.grant(moving).reason == kNotContinuous);
  other.inflation_m = 0.02;
  CHECK(two.ledger.grant(other).reason == kNotContinuous);
  other.inflation_m = 0.05;
  CHECK(two.ledger.grant(other).is_granted());
  Version rested = continued(stop, 1002, 2, {0, 1});
  CHECK(two.ledger.grant(rested).is_granted());
  rested = continued(rested, 1003, 3, {0, 1});
  rested.inflation_m = 0.05;
  CHECK(two.ledger.grant(rested).reason == kNotContinuous);  // a proposal cannot add inflation
}

TEST_CASE("robots in conflict may move apart but not closer together") {
  Two two({0, 0}, {0.15, 0});
  REQUIRE(two.ledger.conflicts().size() == 1);
  CHECK(two.ledger.grant(continued(two.a, 10, 1, {3, 0})).reason == msg::Reason::REASON_CONFLICT);
  CHECK(two.ledger.grant(continued(two.a, 11, 1, {0.1, 2.9})).reason == msg::Reason::REASON_CONFLICT);
  const Version away = continued(two.a, 12, 1, {-3, 0}, 0.2);
  REQUIRE(two.ledger.grant(away).is_granted());
  CHECK(two.ledger.conflicts().size() == 1);  // the robot may still execute its previous version
  REQUIRE(two.ledger.on_executing(away, at_s(1), false) == ReportOutcome::kApplied);
  CHECK(two.ledger.conflicts().size() == 1);  // the robot has only begun to move away
  const Version on = continued(away, 13, 1.19, {-1, 0}, 0.2);
  REQUIRE(two.ledger.grant(on).is_granted());
  REQUIRE(two.ledger.on_executing(on, at_s(1.2), false) == ReportOutcome::kApplied);
  CHECK(two.ledger.conflicts().empty());
  // Once apart, the robots must keep their full separation, so moving back as close as before is refused.
  const auto distance = [&](double seconds) {
    return (continued(on, 14, 3, {3, 0}, seconds).trajectory.rest_position_m() -
            two.b.trajectory.rest_position_m())
        .norm();
  };
  double seconds = 0.1;
  while (distance(seconds) > 0.17) seconds += 0.002;
  REQUIRE(distance(seconds) > 0.16);
  const Version back = continued(on, 14, 3, {3, 0}, seconds);
  CHECK(two.ledger.grant(back).reason == msg::Reason::REASON_CONFLICT);
}

TEST_CASE("a robot pushed too close to an obstacle or off the field may move out but not farther in") {
  FloorRules rules = floor_for_tests();
  rules.obstacles.push_back(Circle{{2, 0}, 0.5});
  Ledger ledger(rules, {1});
  Version in = rest_version(1, {1.45, 0}), out = rest_version(1, {9.95, 3});
  ledger.register_robot(1, {&in, 1});
  CHECK(ledger.grant(continued(in, 10, 1, {3, 0})).reason == msg::Reason::REASON_OBSTACLE);
  CHECK(ledger.grant(continued(in, 11, 1, {-3, 0})).is_granted());
  ledger.clear();
  ledger.register_robot(1, {&out, 1});
  CHECK(ledger.grant(continued(out, 10, 1, {3, 0})).reason == msg::Reason::REASON_OUTSIDE_FIELD);
  CHECK(ledger.grant(continued(out, 11, 1, {-3, 0})).is_granted());
  CHECK(ledger.grant(continued(out, 12, 1, {0, 3})).is_granted());
}

TEST_CASE("lifting a robot removes its versions except those that have not started yet") {
  Two two({0, 0}, {1, 0});
  const Version p = continued(two.a, 10, 1, {0, 3});
  REQUIRE(two.ledger.grant(p).is_granted());
  two.ledger.on_lifted(1, at_s(0.9));
  REQUIRE(two.ledger.versions(1).size() == 1);
  CHECK(two.ledger.versions(1)[0].number == 10);
  CHECK(two.ledger.grant(rest_version(1, {3, 3}, 11)).reason == msg::Reason::REASON_BASE_UNKNOWN);
  two.ledger.on_lifted(1, at_s(1));
  CHECK(two.ledger.versions(1).empty());
  CHECK(two.ledger.on_executing(two.a, at_s(0.8), false) == ReportOutcome::kStale);
  CHECK(two.ledger.versions(1).empty());
  CHECK(two.ledger.on_executing(two.a, at_s(1.1), false) == ReportOutcome::kContradiction);

  CHECK(two.ledger.grant(continued(two.a, 12, 1, {0, 3})).reason == msg::Reason::REASON_ABSENT);
  CHECK(two.ledger.grant(rest_version(1, {0.85, 0}, 12)).reason == msg::Reason::REASON_CONFLICT);
  CHECK(two.ledger.grant(rest_version(1, {19, 0}, 12)).reason == msg::Reason::REASON_OUTSIDE_FIELD);
  Version placed = rest_version(1, {3, 3}, 13);
  placed.trajectory = Trajectory::resting(at_s(2), {3, 3});
  REQUIRE(two.ledger.grant(placed).is_granted());
  two.ledger.on_lifted(1, at_s(1.9));  // the rest version has not started yet
  CHECK(two.ledger.versions(1).size() == 1);
  CHECK(two.ledger.on_executing(placed, at_s(2), false) == ReportOutcome::kApplied);
  // The robot is lifted again, so it no longer executes that version.
  two.ledger.on_lifted(1, at_s(2.5));
  CHECK(two.ledger.versions(1).empty());
}

TEST_CASE("a lifting ends when the robot restarts, even if its clock is then behind") {
  Two two({0, 0}, {1, 0});
  const Incarnation first = 100, second = 200;
  two.ledger.on_lifted(1, at_s(100), first);
  CHECK(two.ledger.on_executing(two.a, at_s(50), true, first) == ReportOutcome::kStale);
  const Version placed = rest_version(1, {3, 3}, 13);
  REQUIRE(two.ledger.grant(placed).is_granted());
  CHECK(two.ledger.on_executing(placed, at_s(2), false, second) == ReportOutcome::kApplied);
  Version stop = placed;
  stop.number = 14;
  CHECK(two.ledger.on_executing(stop, at_s(2.5), true, second) == ReportOutcome::kApplied);
  CHECK(two.ledger.versions(1).front().number == 14);
  // The robot is lifted again, at a time of its new clock.
  two.ledger.on_lifted(1, at_s(3), second);
  CHECK(two.ledger.versions(1).empty());
  CHECK(two.ledger.on_executing(stop, at_s(2.9), true, second) == ReportOutcome::kStale);
}

TEST_CASE("in random histories, no grant brings two robots closer than external events have left them") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  FloorRules rules = floor_for_tests();
  rules.field = {1.6, 1.6};
  rules.margin_m = 0.01;
  const std::vector<RobotId> roster{0, 1, 2, 3, 4};
  Ledger ledger(rules, roster);
  std::map<RobotId, Version> executing;
  for (const RobotId robot : roster) {
    executing[robot] = rest_version(robot, 0.35 * rotated({1, 0}, robot * 1.2566));
    ledger.register_robot(robot, {&executing[robot], 1});
  }
  std::map<Conflict, double> shortfall;
  int grants = 0, escapes = 0, pushes = 0, ended = 0;
  double now = 1;
  for (VersionNumber number = 1; number < 9'000; ++number) {
    const auto robot = static_cast<RobotId>(rng.below(roster.size()));
    now += 0.004;
    const bool is_pushed = rng.chance(0.02);
    const std::size_t conflicts = ledger.conflicts().size();
    if (is_pushed) {
      const State state = executing[robot].trajectory.state_at(at_s(now));
      const double inflation_m = rng.uniform(0, 0.02);
      const Vec2 velocity = random_in_disc(rng, 1.5), displacement = random_in_disc(rng, 0.1);
      executing[robot] =
          off_reference(robot, number, now, state.position_m + displacement, velocity, inflation_m);
      REQUIRE(ledger.on_executing(executing[robot], at_s(now), true) == ReportOutcome::kApplied);
      ++pushes;
    } else {
      const auto held = ledger.versions(robot);
      const Version base = held[rng.below(held.size())];
      const double start =
          std::max(now, to_seconds(base.trajectory.start().time_since_epoch()) + 1e-3) + 0.01;
      const Vec2 velocity = base.trajectory.state_at(at_s(start)).velocity_mps;
      const Vec2 desired = limit_acceleration(sample_acceleration(velocity, rules.limits, rng), velocity,
                                              rules.limits, from_seconds(0.15));
      Version candidate = continued(base, number, start, desired, 0.15);
      candidate.inflation_m = velocity.norm() == 0 && rng.chance(0.5) ? 0 : base.inflation_m;
      const bool granted = ledger.grant(candidate).is_granted();
      grants += granted;
      bool is_escape = false;
      for (const RobotId other : roster) {
        for (const Version& w : ledger.versions(other)) {
          const Time from = std::max(candidate.trajectory.start(), w.trajectory.start());
          is_escape = is_escape || (granted && other != robot &&
                                    min_distance_m(candidate.trajectory, w.trajectory, from) <
                                        rules.min_separation_m() - 1e-6);
        }
      }
      escapes += is_escape;
    }
    if (rng.chance(0.6)) {
      Version& current = executing[robot];
      for (const Version& v : ledger.versions(robot)) {
        const bool possible =
            v.base == current.number && v.number > current.number && v.trajectory.start() <= at_s(now);
        if (possible && rng.chance(0.7)) {
          current = v;
          break;
        }
      }
      REQUIRE(ledger.on_executing(current, at_s(now), false) == ReportOutcome::kApplied);
    }
    ended += ledger.conflicts().size() < conflicts;
    for (const RobotId i : roster) {
      for (const RobotId j : roster) {
        if (i >= j) continue;
        const double worst = shortfall_m(ledger, i, j, rules.min_separation_m());
        CAPTURE(number, i, j);
        if (!is_pushed || (i != robot && j != robot)) REQUIRE(worst <= shortfall[{i, j}] + 1e-6);
        shortfall[{i, j}] = worst;
        const bool is_listed = std::ranges::count(ledger.conflicts(), Conflict{i, j}) == 1;
        if (worst > 1e-6) REQUIRE(is_listed);
        if (worst < -1e-6 || (worst == 0 && is_listed)) REQUIRE_FALSE(is_listed);
      }
    }
  }
  CAPTURE(grants, escapes, pushes, ended);
  CHECK(grants > 200);
  CHECK(escapes > 20);
  CHECK(pushes > 20);
  CHECK(ended >= 3);
}

}  // namespace sidestep::ledger_disturbance_test
