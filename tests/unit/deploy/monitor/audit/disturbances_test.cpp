// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/disturbances.hpp"

#include "tests/catch.hpp"

namespace sidestep::disturbances_test {

using namespace std::chrono_literals;

constexpr Duration kPeriod = 10ms;
constexpr double kContactDistance_m = 0.181;
constexpr Time kPushTime{100s};

using Positions = std::vector<std::optional<Vec2>>;

Positions positions(double second_x_m) { return {Vec2(0, 0), Vec2(second_x_m, 0), Vec2(5, 5)}; }

/// Three robots, the first of which an operator disturbs, and the ground truths that report it.
struct Run {
  explicit Run(bool has_position_checks, Duration duration = 0ms)
      : disturbances(3, has_position_checks), end_time(kPushTime + duration) {
    step(positions(3));
  }
  void step(const Positions& positions_m) {
    disturbances.disturb(0, end_time, now);
    disturbances.update(now, positions_m, kContactDistance_m);
    now += kPeriod;
  }
  void step_for(Duration duration, const Positions& positions_m) {
    for (Duration t{0}; t < duration; t += kPeriod) step(positions_m);
  }
  Disturbances disturbances;
  Time end_time, now = kPushTime;
};

TEST_CASE("a robot counts as disturbed until it is observed in place a while after the disturbance") {
  Run run(true, 500ms);
  CHECK(run.disturbances.is_disturbed(0));
  run.step_for(1400ms, positions(3));
  run.disturbances.confirm_in_place(0);
  CHECK(run.disturbances.is_disturbed(0));
  run.step_for(200ms, positions(3));
  CHECK(run.disturbances.is_disturbed(0));
  run.disturbances.confirm_in_place(0);
  CHECK_FALSE(run.disturbances.is_disturbed(0));
  run.step(positions(3));
  CHECK_FALSE(run.disturbances.is_disturbed(0));
  run.end_time = run.now;
  run.step(positions(3));
  CHECK(run.disturbances.is_disturbed(0));
}

TEST_CASE("without position checks a robot counts as back in place after a timeout") {
  Run run(false, 500ms);
  run.step_for(1400ms, positions(3));
  CHECK(run.disturbances.is_disturbed(0));
  run.step_for(200ms, positions(3));
  CHECK_FALSE(run.disturbances.is_disturbed(0));
}

TEST_CASE("a disturbance that is reported to last for an hour is limited to a minute") {
  Run run(false, 1h);
  run.step_for(62s, positions(3));
  CHECK_FALSE(run.disturbances.is_disturbed(0));
}

TEST_CASE("setting the simulator's clock back does not prolong a disturbance beyond a minute") {
  Run run(false);
  run.now = kPushTime - 50s;
  run.step_for(10s, positions(3));
  CHECK(run.disturbances.is_disturbed(0));
  run.now = kPushTime - 99s;
  run.step_for(62s, positions(3));
  CHECK_FALSE(run.disturbances.is_disturbed(0));
}

TEST_CASE("a robot that a disturbed robot touches counts as disturbed while they touch") {
  const bool part = GENERATE(false, true);
  CAPTURE(part);
  Run run(true);
  CHECK(run.disturbances.on_contact(0, 1));
  // The second robot is repeatedly observed in place, the first one is not.
  for (int i = 0; i < 500; ++i) {
    run.step(positions(part ? 0.19 : 0.18));
    run.disturbances.confirm_in_place(1);
  }
  CHECK(run.disturbances.is_disturbed(1) == !part);
  CHECK(run.disturbances.on_contact(1, 2) == !part);
  CHECK(run.disturbances.is_disturbed(2) == !part);
}

TEST_CASE("two robots in contact do not keep each other disturbed") {
  Run run(true);
  CHECK(run.disturbances.on_contact(1, 0));
  for (int i = 0; i < 300; ++i) {
    run.step(positions(0.18));
    run.disturbances.confirm_in_place(0);
    run.disturbances.confirm_in_place(1);
  }
  CHECK_FALSE(run.disturbances.is_disturbed(0));
  CHECK_FALSE(run.disturbances.is_disturbed(1));
  CHECK_FALSE(run.disturbances.on_contact(1, 2));
}

TEST_CASE("an obstacle is never disturbed") {
  Run run(true);
  CHECK_FALSE(run.disturbances.on_contact(1, std::nullopt));
  CHECK(run.disturbances.on_contact(0, std::nullopt));
  CHECK(run.disturbances.on_contact(std::nullopt, 0));
}

}  // namespace sidestep::disturbances_test
