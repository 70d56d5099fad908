// SPDX-License-Identifier: Apache-2.0
#include "coordinator/displaced_robots.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/coordinator/floor.hpp"

namespace sidestep::displaced_robots_test {

constexpr double kMargin_m = 0.014;
constexpr Duration kMaxDifference{4'000'000};

struct One {
  Ledger ledger{floor_for_tests(), {1}};
  Version a = rest_version(1, {0, 0});
  DisplacedRobots displaced{kMargin_m};

  One() { ledger.register_robot(1, {&a, 1}); }
  void see(const Vec2& position, double at, double sigma_m = 0) {
    displaced.observe({1, at_s(at), position, Vec2(0, 0), sigma_m * sigma_m}, ledger);
  }
};

TEST_CASE(
    "a robot seen farther from its version than margin, vision error and inflation permit is displaced") {
  One one;
  one.see({0.0169, 0}, 1);
  CHECK_FALSE(one.displaced.contains(1));
  one.see({0.0171, 0}, 2);
  CHECK(one.displaced.contains(1));

  One uncertain;
  uncertain.see({0.036, 0}, 1, 0.005);
  CHECK_FALSE(uncertain.displaced.contains(1));
  uncertain.see({0.038, 0}, 2, 0.005);
  CHECK(uncertain.displaced.contains(1));

  One inflated;
  Version stop = rest_version(1, {0, 0}, 1000);
  stop.inflation_m = 0.03;
  REQUIRE(inflated.ledger.on_executing(stop, at_s(0.5), true) == ReportOutcome::kApplied);
  inflated.see({0.0469, 0}, 1);
  CHECK_FALSE(inflated.displaced.contains(1));
  inflated.see({0.0471, 0}, 2);
  CHECK(inflated.displaced.contains(1));
}

TEST_CASE("a displaced robot is back after three consecutive observations that agree with the ledger") {
  One one;
  one.see({1, 0}, 1);
  one.see({0, 0}, 1.1);
  one.see({0, 0}, 1.2);
  one.see({1, 0}, 1.3);
  one.see({0, 0}, 1.4);
  one.see({0, 0}, 1.5);
  REQUIRE(one.displaced.contains(1));
  CHECK(one.displaced.last_observation(1)->observed_at == at_s(1.5));
  one.see({0, 0}, 1.5);  // a repeated observation, which does not count
  CHECK(one.displaced.contains(1));
  one.see({0, 0}, 1.6);
  CHECK_FALSE(one.displaced.contains(1));
}

TEST_CASE("a resting robot is displaced if the mean of its observations is half the margin away") {
  const std::uint64_t seed = 5;
  CAPTURE(seed);
  Rng rng(seed);
  One one;
  double now = 1;
  const auto observe_repeatedly = [&](double x_m, int times) {
    for (int i = 0; i < times; ++i, now += 1.0 / 60)
      one.see({x_m + rng.uniform(-0.002, 0.002), rng.uniform(-0.002, 0.002)}, now);
  };
  constexpr int kEnough = DisplacedRobots::kObservationsOfRest;
  observe_repeatedly(0.006, 2 * kEnough);
  CHECK_FALSE(one.displaced.contains(1));
  observe_repeatedly(0.009, kEnough);
  CHECK(one.displaced.contains(1));
  // The robot stays displaced, although each single observation is within vision's error.
  for (int i = 0; i < 100; ++i) {
    observe_repeatedly(0.009, 1);
    REQUIRE(one.displaced.contains(1));
  }
  SECTION("the robot is back after it is seen near its version again") {
    observe_repeatedly(0.002, kEnough + DisplacedRobots::kObservationsUntilBack);
    CHECK_FALSE(one.displaced.contains(1));
  }
  SECTION("the robot is back after it executes its own stop where it is seen") {
    Version stop = rest_version(1, {0.009, 0}, 1000);
    stop.trajectory = Trajectory::resting(at_s(now), {0.009, 0});
    REQUIRE(one.ledger.on_executing(stop, at_s(now), true) == ReportOutcome::kApplied);
    observe_repeatedly(0.009, kEnough + DisplacedRobots::kObservationsUntilBack);
    CHECK_FALSE(one.displaced.contains(1));
  }
}

TEST_CASE("the mean of observations is not used while a robot moves or has just stopped") {
  One one;
  const Version p = continued(one.a, 10, 1, {3, 0}, 0.3);
  REQUIRE(one.ledger.grant(p).is_granted());
  REQUIRE(one.ledger.on_executing(p, at_s(1.01), false) == ReportOutcome::kApplied);
  const auto behind = [&](double at) {
    return Vec2(p.trajectory.state_at(at_s(at)).position_m - Vec2(0.012, 0));
  };
  const double end = to_seconds(p.trajectory.end().time_since_epoch());
  double at = 1.05;
  for (; at < end + 0.45; at += 1.0 / 60) {
    one.see(behind(at), at);
    REQUIRE_FALSE(one.displaced.contains(1));
  }
  for (; at < end + 0.6; at += 1.0 / 60) one.see(behind(at), at);
  CHECK(one.displaced.contains(1));
}

TEST_CASE(
    "a robot's velocity is its mean over the last 15 cm, or over at least 1.5 cm if it has not moved "
    "farther") {
  One one;
  const auto velocity = [&] { return one.displaced.last_observation(1)->velocity_mps; };
  for (int i = 0; i <= 2; ++i) one.see({0.005 * i, 0}, 1 + 0.02 * i);
  CHECK(velocity().isZero(0));
  for (int i = 3; i <= 10; ++i) one.see({0.005 * i, 0}, 1 + 0.02 * i);
  CHECK(velocity().x() == Approx(0.25));
  for (int i = 1; i <= 20; ++i) one.see({0.05, 0.01 * i}, 1.2 + 0.02 * i);
  CHECK(velocity().x() == Approx(0).margin(1e-12));
  CHECK(velocity().y() == Approx(0.5));
  CHECK_FALSE(one.displaced.last_observation(2));
}

TEST_CASE("an observation is compared with the versions that the robot may have executed at its time") {
  One one;
  const Version p = continued(one.a, 10, 1, {3, 0}, 0.3);
  REQUIRE(one.ledger.grant(p).is_granted());
  const Vec2 place_m = p.trajectory.state_at(at_s(1.2)).position_m;
  SECTION("both versions are still possible") {
    one.see(place_m, 1.2);
    one.see({0, 0}, 1.21);
    CHECK_FALSE(one.displaced.contains(1));
  }
  SECTION("the robot has certainly left the first version") {
    REQUIRE(one.ledger.on_executing(p, at_s(1.25), false) == ReportOutcome::kApplied);
    one.see({0, 0}, 1.24);
    CHECK_FALSE(one.displaced.contains(1));
    one.see({0, 0}, 1.27);
    CHECK(one.displaced.contains(1));
  }
}

// Version a rests at x = 0, the own stop at x = 0.5.
TEST_CASE("a version that a robot has left still matches observations within the maximum clock difference") {
  const Duration max_difference = GENERATE(Duration{1'000'000}, Duration{4'000'000}, Duration{100'000'000});
  CAPTURE(to_seconds(max_difference));
  const Duration late = max_difference * GENERATE(1, 2, 3, 4, 5) / 4;
  CAPTURE(to_seconds(late));
  Ledger ledger(floor_for_tests(), {1}, max_difference);
  const Version a = rest_version(1, {0, 0});
  ledger.register_robot(1, {&a, 1});
  Version stop = rest_version(1, {0.5, 0}, 1000);
  stop.trajectory = Trajectory::resting(at_s(1), {0.5, 0});
  REQUIRE(ledger.on_executing(stop, at_s(1), true) == ReportOutcome::kApplied);
  const auto distance_m = ledger.distance_from_versions_m(1, {0, 0}, at_s(1) + late);
  REQUIRE(distance_m);
  CHECK(*distance_m == Approx(late <= max_difference ? 0 : 0.5).margin(1e-12));
}

TEST_CASE("an observation older than all versions that the ledger remembers is not compared") {
  One one;
  CHECK(one.displaced.observe({1, at_s(1), {0, 0}, Vec2(0, 0), 0}, one.ledger));
  Version stop = rest_version(1, {0, 0}, 1000);
  stop.trajectory = Trajectory::resting(at_s(3), {0, 0});
  Ledger restarted{floor_for_tests(), {1}};
  restarted.register_robot(1, {&stop, 1});
  const auto is_compared = [&](double at) {
    return one.displaced.observe({1, at_s(at), {0, 0}, Vec2(0, 0), 0}, restarted);
  };
  CHECK_FALSE(is_compared(2));
  CHECK_FALSE(is_compared(2));  // a repeated observation
  CHECK(is_compared(3.1));
  CHECK(is_compared(3.1));
}

TEST_CASE("an absent robot that is seen on the floor is displaced") {
  One one;
  one.ledger.on_lifted(1, at_s(1));
  one.see({0, 0}, 0.99);  // captured before the lifting
  CHECK_FALSE(one.displaced.contains(1));
  one.see({0, 0}, 1.1);
  CHECK(one.displaced.contains(1));
}

TEST_CASE("the distance from a robot's versions is the smallest over all versions that it may execute") {
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  Rng rng(seed);
  for (int round = 0; round < 300; ++round) {
    Ledger ledger(floor_for_tests(), {1}, kMaxDifference);
    Version last = rest_version(1, {0, 0});
    ledger.register_robot(1, {&last, 1});
    std::vector<Version> all{last};
    double t = 1;
    for (VersionNumber n = 1; n < 6; ++n, t += 0.05) {
      const Version next = continued(last, n, t, {rng.uniform(-2, 2), rng.uniform(-2, 2)}, 0.04);
      if (!ledger.grant(next).is_granted()) break;
      all.push_back(next);
      if (rng.chance(0.7)) last = next;
    }
    const double at = rng.uniform(1, 1.5);
    const Vec2 seen(rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3));
    double expected = std::numeric_limits<double>::infinity();
    for (const Version& version : all) {
      if (version.trajectory.start() <= at_s(at) + kMaxDifference)
        expected = std::min(expected, (version.trajectory.state_at(at_s(at)).position_m - seen).norm());
    }
    const auto distance = ledger.distance_from_versions_m(1, seen, at_s(at));
    REQUIRE(distance);
    CHECK(*distance == Approx(expected).margin(1e-12));
  }
}

}  // namespace sidestep::displaced_robots_test
