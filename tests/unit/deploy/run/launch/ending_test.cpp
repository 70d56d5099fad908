// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/ending.hpp"

#include <limits>

#include "tests/catch.hpp"

namespace sidestep::ending_test {
namespace {

using namespace std::chrono_literals;
using Step = Ending::Step;

constexpr Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr Duration kTimeToRest = 1400ms, kPeriod = 20ms;

/// Robots 3 and 7, which drive at 2 m/s until `braking_from` and then brake with 5 m/s² each, and what shows
/// them.
struct Floor {
  double speed_mps(Time at) const {
    return std::max(0.0, 2 - 5 * std::max(0.0, to_seconds(at - braking_from)));
  }
  void advance() {
    now += kPeriod;
    x_m += speed_mps(now) * to_seconds(kPeriod);
    if (is_seen)
      sightings = {{3, now + clock_error, {x_m, 0}, speed_mps(now)}, {7, now + clock_error, {x_m, 1}, 0}};
  }
  Step update() { return ending.update(now, sightings, running); }
  /// Returns the step at the end of the duration, or as soon as it changes.
  Step run(Duration duration) {
    const Step before = update();
    for (const Time end = now + duration; now < end;) {
      advance();
      if (update() != before) return update();
    }
    return before;
  }

  Time now = kBegin, braking_from = kBegin;
  Duration clock_error{0};  ///< of the process that sees the robots
  bool is_seen = true;
  double x_m = 0;
  std::vector<RobotSighting> sightings{{3, kBegin, {0, 0}, 2}, {7, kBegin, {0, 1}, 2}};
  MovingProcesses running{true, true};
  Ending ending{{kTimeToRest, 0.005}, kBegin};
};

}  // namespace

TEST_CASE("drivers end after agents have ended and robots rest, and the run ends after the drivers") {
  Floor floor;
  CHECK(floor.run(300ms) == Step::kRobotsStop);
  CHECK(floor.ending.moving_robots() == std::vector<RobotId>{3, 7});
  CHECK(floor.run(900ms) == Step::kRobotsStop);
  CHECK(floor.ending.moving_robots().empty());
  floor.running.agents = false;
  CHECK(floor.run(100ms) == Step::kDriversEnd);
  CHECK(floor.run(900ms) == Step::kDriversEnd);
  floor.running.drivers = false;
  CHECK(floor.run(100ms) == Step::kOver);
  CHECK(floor.ending.problem().empty());
}

TEST_CASE(
    "agents that have ended do not end the run while a robot moves, and without a driver it then ends") {
  Floor floor;
  floor.running = {};
  CHECK(floor.run(400ms) == Step::kRobotsStop);
  CHECK(floor.run(5s) == Step::kOver);
  const double stopped_s = 2.0 / 5;
  CHECK(to_seconds(floor.now - kBegin) >= stopped_s + to_seconds(RestWatch::kRestTime) - 0.1);
  CHECK(to_seconds(floor.now - kBegin) < stopped_s + 0.5);
  CHECK(floor.ending.problem().empty());
}

TEST_CASE("bases that coast after their driver has ended are waited for") {
  Floor floor;
  floor.running.agents = false;
  floor.braking_from = kBegin - 1s;
  REQUIRE(floor.run(5s) == Step::kDriversEnd);
  floor.running.drivers = false;
  floor.braking_from = floor.now;
  floor.advance();
  CHECK(floor.update() == Step::kDriversEnd);
  CHECK(floor.run(5s) == Step::kOver);
  CHECK(to_seconds(floor.now - floor.braking_from) > 0.6);
  CHECK(floor.ending.problem().empty());
}

TEST_CASE("the end of a run whose robots never stop is bounded, and says which robots move and how fast") {
  Floor floor;
  floor.running = {};
  floor.braking_from = kBegin + 1h;
  CHECK(floor.run(kTimeToRest + Ending::kGrace - 2 * kPeriod) == Step::kRobotsStop);
  floor.running.drivers = true;
  CHECK(floor.run(100ms) == Step::kDriversEnd);
  CHECK(floor.run(kTimeToRest + Ending::kGrace - 2 * kPeriod) == Step::kDriversEnd);
  CHECK(floor.run(100ms) == Step::kOver);
  CHECK(floor.ending.problem() == "robots 3, 7 still move at up to 2.00 m/s");
}

TEST_CASE("processes that do not end are not waited for longer than robots would take") {
  Floor floor;
  floor.braking_from = kBegin - 1s;
  CHECK(floor.run(10s) == Step::kDriversEnd);
  CHECK(floor.now - kBegin <= kTimeToRest + Ending::kGrace + kPeriod);
  const Time began = floor.now;
  CHECK(floor.run(10s) == Step::kOver);
  CHECK(floor.now - began <= kTimeToRest + Ending::kGrace + kPeriod);
  CHECK(floor.ending.problem().empty());
}

TEST_CASE(
    "if nobody sees robots any more, they are not waited for, and it is said that nobody saw them rest") {
  Floor floor;
  floor.running = {};
  CHECK(floor.run(200ms) == Step::kRobotsStop);
  floor.is_seen = false;
  CHECK(floor.run(Ending::kMaxSilence - 50ms) == Step::kRobotsStop);
  CHECK(floor.run(200ms) == Step::kOver);
  CHECK_THAT(floor.ending.problem(), StartsWith("nobody saw robots 3, 7 come to rest from up to "));
}

TEST_CASE("robots that were seen at rest are known to rest even if nothing shows them later") {
  Floor floor;
  floor.running.drivers = false;
  floor.braking_from = kBegin - 1s;
  CHECK(floor.run(500ms) == Step::kRobotsStop);
  floor.is_seen = false;
  CHECK(floor.run(2s) == Step::kRobotsStop);
  floor.running.agents = false;
  CHECK(floor.run(100ms) == Step::kOver);
  CHECK(floor.ending.problem().empty());
}

TEST_CASE("the clock of the process that sees robots need not agree with that of the launcher") {
  Floor floor;
  floor.clock_error = GENERATE(-1h, 0h, 1h);
  for (RobotSighting& sighting : floor.sightings) sighting.at += floor.clock_error;
  floor.running = {};
  CHECK(floor.run(400ms) == Step::kRobotsStop);
  CHECK(floor.run(5s) == Step::kOver);
  CHECK(floor.now - kBegin < 1s);
  CHECK(floor.ending.problem().empty());
}

TEST_CASE("a run in which no robot was seen ends as soon as its processes have ended") {
  Ending ending({kTimeToRest, 0.005}, kBegin);
  CHECK(ending.update(kBegin, {}, {true, false}) == Step::kRobotsStop);
  CHECK(ending.update(kBegin + kPeriod, {}, {false, false}) == Step::kOver);
  CHECK(ending.problem().empty());
}

TEST_CASE("a robot that has not been seen for long is not waited for") {
  Ending ending({kTimeToRest, 0.005}, kBegin);
  std::vector<RobotSighting> sightings{{3, kBegin - 5s, {0, 0}, 1}, {7, kBegin, {1, 0}, 0}};
  Step step = Step::kRobotsStop;
  Time now = kBegin;
  for (; step != Step::kOver && now < kBegin + 10s; now += kPeriod) {
    sightings[1].at = now;
    step = ending.update(now, sightings, {});
  }
  CHECK(now - kBegin < 500ms);
  CHECK(ending.problem().empty());
}

TEST_CASE("a robot that is taken off the floor while robots come to rest is not waited for") {
  Floor floor;
  CHECK(floor.run(100ms) == Step::kRobotsStop);
  floor.is_seen = false;
  floor.sightings.erase(floor.sightings.begin());
  floor.running = {false, false};
  for (const Time end = floor.now + 400ms; floor.now < end;) {
    floor.advance();
    floor.sightings[0].at = floor.now;
    floor.update();
  }
  CHECK(floor.update() == Step::kOver);
  CHECK(floor.ending.problem().empty());
}

TEST_CASE("a robot whose position is not a number never rests") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  RestWatch watch({3, kBegin, {kNan, 0}, 0});
  for (Time at = kBegin; at < kBegin + 1s; at += kPeriod) watch.see({3, at, {kNan, 0}, 0}, 0.005);
  CHECK_FALSE(watch.is_at_rest());
}

TEST_CASE("a robot that creeps within the tolerance of its last place but leaves it does not rest") {
  RestWatch watch({3, kBegin, {0, 0}, 0});
  for (Time at = kBegin; at < kBegin + 1s; at += kPeriod) {
    watch.see({3, at, {0.03 * to_seconds(at - kBegin), 0}, 0.03}, 0.005);
    CHECK_FALSE(watch.is_at_rest());
  }
  CHECK(watch.speed_mps() == Approx(0.03));
}

}  // namespace sidestep::ending_test
