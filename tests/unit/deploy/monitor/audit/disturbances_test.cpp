// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/disturbances.hpp"

#include <catch2/catch.hpp>

using namespace sidestep;
using namespace std::chrono_literals;

namespace {

constexpr Duration kPeriod = 10ms;
constexpr double kTouching_m = 0.181;
constexpr Time kPushed{100s};

using Places = std::vector<std::optional<Vec2>>;

Places places(double second_x_m) { return {Vec2(0, 0), Vec2(second_x_m, 0), Vec2(5, 5)}; }

/// Three robots, of which somebody pushes the first one, and ground truths that say so.
struct Pushed {
  explicit Pushed(bool sees_places, Duration lasts = 0ms) : hands(3, sees_places), let_go(kPushed + lasts) {
    step(places(3));
  }
  void step(const Places& at) {
    hands.move(0, let_go, now);
    hands.step(now, at, kTouching_m);
    now += kPeriod;
  }
  void step_for(Duration duration, const Places& at) {
    for (Duration t{0}; t < duration; t += kPeriod) step(at);
  }
  Hands hands;
  Time let_go, now = kPushed;
};

}  // namespace

TEST_CASE("a robot that was moved is in nobody's hands when it has been seen in its place later") {
  Pushed run(true, 500ms);
  CHECK(run.hands.are_on(0));
  run.step_for(1400ms, places(3));
  run.hands.see_in_place(0);
  CHECK(run.hands.are_on(0));
  run.step_for(200ms, places(3));
  CHECK(run.hands.are_on(0));
  run.hands.see_in_place(0);
  CHECK_FALSE(run.hands.are_on(0));
  run.step(places(3));
  CHECK_FALSE(run.hands.are_on(0));
  run.let_go = run.now;
  run.step(places(3));
  CHECK(run.hands.are_on(0));
}

TEST_CASE("who does not see places takes robots to be back after a while") {
  Pushed run(false, 500ms);
  run.step_for(1400ms, places(3));
  CHECK(run.hands.are_on(0));
  run.step_for(200ms, places(3));
  CHECK_FALSE(run.hands.are_on(0));
}

TEST_CASE("a hand that says to stay for ages does not") {
  Pushed run(false, 1h);
  run.step_for(62s, places(3));
  CHECK_FALSE(run.hands.are_on(0));
}

TEST_CASE("a simulator whose clock is set back does not stay in a robot's hands for as long") {
  Pushed run(false);
  run.now = kPushed - 50s;
  run.step_for(10s, places(3));
  CHECK(run.hands.are_on(0));
  run.now = kPushed - 99s;
  run.step_for(62s, places(3));
  CHECK_FALSE(run.hands.are_on(0));
}

TEST_CASE("who touches one that was moved is pushed for as long as they touch") {
  const bool part = GENERATE(false, true);
  CAPTURE(part);
  Pushed run(true);
  CHECK(run.hands.touch(0, 1));
  // In place, as far as can be seen, again and again, while the first one is not.
  for (int i = 0; i < 500; ++i) {
    run.step(places(part ? 0.19 : 0.18));
    run.hands.see_in_place(1);
  }
  CHECK(run.hands.are_on(1) == !part);
  CHECK(run.hands.touch(1, 2) == !part);
  CHECK(run.hands.are_on(2) == !part);
}

TEST_CASE("two that touch do not keep each other in somebody's hands") {
  Pushed run(true);
  CHECK(run.hands.touch(1, 0));
  for (int i = 0; i < 300; ++i) {
    run.step(places(0.18));
    run.hands.see_in_place(0);
    run.hands.see_in_place(1);
  }
  CHECK_FALSE(run.hands.are_on(0));
  CHECK_FALSE(run.hands.are_on(1));
  CHECK_FALSE(run.hands.touch(1, 2));
}

TEST_CASE("what is no robot is in nobody's hands") {
  Pushed run(true);
  CHECK_FALSE(run.hands.touch(1, std::nullopt));
  CHECK(run.hands.touch(0, std::nullopt));
  CHECK(run.hands.touch(std::nullopt, 0));
}
