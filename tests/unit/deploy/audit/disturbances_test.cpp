// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/disturbances.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::disturbances_test {

using namespace std::chrono_literals;

constexpr Duration kPeriod = 10ms;
constexpr Time kBegin{100s};
constexpr DisturbanceSettings kSettings{0.181, 0.19, 600ms, true, 0.01};

using Robots = std::vector<std::optional<ObservedRobot>>;
using Cause = std::optional<std::string_view>;

/// Robots 0 to 3 at rest in place, far apart.
///
///     0      1      2      3
Robots at_rest() {
  Robots robots;
  for (int i = 0; i < 4; ++i) robots.push_back(ObservedRobot{Vec2(3 * i, 0), 0, 0, true});
  return robots;
}

struct Floor {
  void run(Duration duration) {
    for (Duration t{0}; t < duration; t += kPeriod) {
      now += kPeriod;
      disturbances.update(now, robots);
    }
  }
  void push(std::size_t robot, Duration duration = 0ms) {
    disturbances.announce(robot, "push");
    disturbances.disturb(robot, now + duration, now);
  }
  Cause contact(std::optional<std::size_t> first, std::optional<std::size_t> second) {
    return disturbances.on_contact(first, second, now);
  }

  Robots robots = at_rest();
  Disturbances disturbances{4, kSettings};
  Time now = kBegin;
};

TEST_CASE("only contacts of a disturbed robot are excused, and the excuse states the cause") {
  Floor floor;
  CHECK_FALSE(floor.contact(0, 1));
  floor.push(0, 1s);
  floor.run(500ms);
  CHECK_FALSE(floor.contact(1, 2));
  CHECK_FALSE(floor.contact(1, std::nullopt));
  CHECK(floor.contact(0, 1) == Cause("push"));
  CHECK(floor.contact(2, 0) == Cause("push"));
  CHECK(floor.contact(std::nullopt, 0) == Cause("push"));
}

TEST_CASE("a robot counts as resting where a disturbance left it until it moves or is back in place") {
  Floor floor;
  floor.robots[0]->is_in_place = floor.robots[1]->is_in_place = false;
  floor.push(0);
  floor.run(60s);
  CHECK_FALSE(floor.disturbances.is_displaced(0));
  CHECK(floor.disturbances.rests_displaced(0));
  CHECK_FALSE(floor.disturbances.rests_displaced(1));
  SECTION("the robot moves") {
    floor.robots[0]->speed_mps = 0.2;
    floor.run(20ms);
    floor.robots[0]->speed_mps = 0;
  }
  SECTION("the robot is back in place") { floor.robots[0]->is_in_place = true; }
  floor.run(20ms);
  floor.robots[0]->is_in_place = false;
  floor.run(20ms);
  CHECK_FALSE(floor.disturbances.rests_displaced(0));
}

TEST_CASE("a robot whose clock has jumped is excused until it rests, even if it drives on its reference") {
  Floor floor;
  floor.robots[0]->speed_mps = 1;
  floor.disturbances.announce(0, Disturbances::kClockCause);
  floor.disturbances.disturb(0, floor.now, floor.now);
  floor.run(3s);
  CHECK(floor.contact(0, 1) == Cause("clock"));
  floor.robots[0]->speed_mps = 0;
  floor.run(2s);
  CHECK_FALSE(floor.contact(0, 2));
}

TEST_CASE("a pair is excused until both robots have rested since the disturbance") {
  Floor floor;
  floor.push(0, 500ms);
  floor.run(500ms);
  CHECK(floor.disturbances.is_displaced(0));
  floor.run(150ms);
  CHECK_FALSE(floor.disturbances.is_displaced(0));
  floor.run(150ms);
  CHECK_FALSE(floor.contact(0, 1));
  CHECK_FALSE(floor.contact(0, std::nullopt));
}

TEST_CASE(
    "a disturbed robot's contact with a moving robot is excused until that robot has had time to brake") {
  Floor floor;
  floor.robots[1]->speed_mps = 1;
  floor.push(0);
  floor.run(300ms);
  SECTION("the other robot was at rest") { CHECK_FALSE(floor.contact(0, 2)); }
  SECTION("the other robot is still moving") { CHECK(floor.contact(0, 1) == Cause("push")); }
  SECTION("the other robot has rested and moves again") {
    floor.robots[1]->speed_mps = 0;
    floor.run(150ms);
    floor.robots[1]->speed_mps = 1;
    floor.run(20ms);
    CHECK_FALSE(floor.contact(0, 1));
  }
  SECTION("the other robot has had time to brake") {
    floor.run(600ms);
    CHECK_FALSE(floor.contact(0, 1));
  }
}

TEST_CASE("a disturbed robot that keeps driving is back once it is in place a while after the disturbance") {
  Floor floor;
  floor.robots[0]->speed_mps = 1;
  floor.push(0);
  floor.run(900ms);
  CHECK(floor.disturbances.is_displaced(0));
  floor.robots[0]->is_in_place = false;
  floor.run(5s);
  CHECK(floor.disturbances.is_displaced(0));
  CHECK(floor.contact(0, 1) == Cause("push"));
  floor.robots[0]->is_in_place = true;
  floor.run(1100ms);
  CHECK_FALSE(floor.disturbances.is_displaced(0));
}

TEST_CASE("an excuse ends even if the robot never returns or the disturbance has no known end") {
  Floor floor;
  const bool is_lifted = GENERATE(false, true);
  CAPTURE(is_lifted);
  if (is_lifted)
    floor.robots[0].reset();
  else
    floor.robots[0]->is_in_place = false;
  SECTION("the robot never returns to its place") { floor.push(0); }
  SECTION("the disturbance has no known end") { floor.disturbances.disturb(0, Time::max(), floor.now); }
  floor.run(19s);
  CHECK(floor.contact(0, 1));
  floor.run(21s);
  CHECK_FALSE(floor.contact(0, 1));
  CHECK_FALSE(floor.contact(0, std::nullopt));
}

TEST_CASE("an excuse ends after about a minute even if a late end is reported or the clock is set back") {
  Floor floor;
  floor.push(0, 1h);
  SECTION("the reported end is in an hour") {}
  SECTION("the clock is set back") { floor.now -= 50s; }
  floor.run(62s);
  CHECK_FALSE(floor.contact(0, 1));
}

TEST_CASE("a pair that is in conflict stays excused until the two robots are apart again") {
  Floor floor;
  floor.robots[1]->position_m = {0.185, 0};
  floor.push(0);
  floor.run(3s);
  CHECK_FALSE(floor.contact(0, 2));
  SECTION("the robots are too close for the margin") { CHECK(floor.contact(0, 1) == Cause("push")); }
  SECTION("the robots are too close for one robot's inflation") {
    floor.robots[1]->position_m = {0.195, 0};
    floor.robots[0]->inflation_m = 0.01;
    floor.run(1s);
    CHECK(floor.contact(0, 1) == Cause("push"));
  }
  SECTION("the robots are apart") {
    floor.robots[1]->position_m = {0.195, 0};
    floor.run(20ms);
    CHECK_FALSE(floor.contact(0, 1));
  }
}

TEST_CASE("a robot that was pushed towards an obstacle stays excused until it is clear of it") {
  Floor floor;
  floor.robots[0]->from_obstacles_m = 0.004;
  floor.push(0);
  floor.run(3s);
  CHECK(floor.contact(0, std::nullopt) == Cause("push"));
  CHECK_FALSE(floor.disturbances.is_displaced(0));  // a crash with an opponent would not be excused
  CHECK_FALSE(floor.contact(0, 1));
  SECTION("it is clear of the margin") { floor.robots[0]->from_obstacles_m = 0.011; }
  SECTION("it is clear of its inflation, too") {
    floor.robots[0]->inflation_m = 0.02;
    floor.robots[0]->from_obstacles_m = 0.025;
    floor.run(1s);
    CHECK(floor.contact(0, std::nullopt) == Cause("push"));
    floor.robots[0]->from_obstacles_m = 0.031;
  }
  floor.run(20ms);
  CHECK_FALSE(floor.contact(0, std::nullopt));
  floor.robots[0]->from_obstacles_m = 0.004;
  floor.run(20ms);
  CHECK_FALSE(floor.contact(0, std::nullopt));  // nothing has pushed it there
}

TEST_CASE("a robot that a disturbed robot pushes is disturbed by the same cause while they touch") {
  Floor floor;
  floor.robots[0]->is_in_place = false;
  const bool part = GENERATE(false, true);
  CAPTURE(part);
  floor.push(0);
  floor.run(100ms);
  CHECK_FALSE(floor.contact(1, 2));
  CHECK(floor.contact(0, 1) == Cause("push"));
  floor.robots[1]->position_m = {part ? 0.4 : 0.18, 0};
  floor.run(5s);
  CHECK(floor.disturbances.is_displaced(1) == !part);
  CHECK(floor.contact(2, 1) == (part ? Cause() : Cause("push")));
  CHECK(floor.disturbances.is_displaced(2) == !part);
}

TEST_CASE("two robots in contact do not keep each other disturbed") {
  Floor floor;
  floor.push(0);
  CHECK(floor.contact(1, 0));
  floor.robots[1]->position_m = {0.18, 0};
  floor.run(1s);
  CHECK_FALSE(floor.disturbances.is_displaced(0));
  CHECK_FALSE(floor.disturbances.is_displaced(1));
  CHECK_FALSE(floor.contact(1, 2));
}

TEST_CASE("the cause of a disturbance is unknown unless an operator's message names it") {
  Floor floor;
  SECTION("no message names the cause") {
    floor.disturbances.disturb(0, floor.now, floor.now);
    CHECK(floor.contact(0, 1) == Cause(Disturbances::kUnknownCause));
  }
  SECTION("a message after the report names the cause") {
    floor.disturbances.disturb(0, floor.now, floor.now);
    floor.disturbances.announce(0, "slip");
    CHECK(floor.contact(0, 1) == Cause("slip"));
  }
  SECTION("a message names only one disturbance") {
    floor.push(0);
    floor.run(1s);
    floor.disturbances.disturb(0, floor.now, floor.now);
    CHECK(floor.contact(0, 1) == Cause(Disturbances::kUnknownCause));
  }
  SECTION("a message alone excuses nothing") {
    floor.disturbances.announce(0, "push");
    CHECK_FALSE(floor.contact(0, 1));
  }
  CHECK_FALSE(floor.contact(2, 3));
}

TEST_CASE("a disturbance that is reported repeatedly counts once") {
  Floor floor;
  const Time end = floor.now;
  for (int i = 0; i < 100; ++i) {
    floor.disturbances.disturb(0, end, floor.now);
    floor.run(kPeriod);
  }
  CHECK_FALSE(floor.disturbances.is_displaced(0));
  CHECK_FALSE(floor.contact(0, 1));
}

TEST_CASE("the excused time is the sum over pairs of the time in which a contact would be excused") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    Floor floor;
    floor.run(kPeriod);
    int steps = 0, excused_steps = 0;
    for (int step = 0; step < 1000; ++step) {
      const std::size_t robot = rng.below(4);
      if (rng.chance(0.01)) floor.push(robot, from_seconds(rng.uniform(0, 0.5)));
      const Robots known = floor.robots;
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j) {
          if (!known[i] || !known[j]) continue;
          Disturbances copy = floor.disturbances;
          ++steps;
          excused_steps += copy.on_contact(i, j, floor.now).has_value();
        }
      }
      if (rng.chance(0.02)) floor.robots[robot] = at_rest()[robot];
      if (rng.chance(0.01)) floor.robots[robot].reset();
      if (floor.robots[robot] && rng.chance(0.05)) floor.robots[robot]->speed_mps = rng.uniform(0, 0.1);
      if (floor.robots[robot] && rng.chance(0.05)) floor.robots[robot]->is_in_place = rng.chance(0.7);
      floor.run(kPeriod);
    }
    CHECK(excused_steps > 0);
    CHECK(excused_steps < steps);
    CHECK(floor.disturbances.pair_s() == Approx(steps * to_seconds(kPeriod)));
    CHECK(floor.disturbances.excused_pair_s() == Approx(excused_steps * to_seconds(kPeriod)));
  }
}

TEST_CASE("without a disturbance nothing is ever excused") {
  Floor floor;
  for (auto& robot : floor.robots) robot->is_in_place = false;
  floor.run(10s);
  CHECK_FALSE(floor.contact(0, 1));
  CHECK(floor.disturbances.pair_s() > 50);
  CHECK(floor.disturbances.excused_pair_s() == 0);
}

}  // namespace sidestep::disturbances_test
