// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/hands.hpp"

#include <catch2/catch.hpp>

using namespace sidestep;
using namespace std::chrono_literals;

namespace {

constexpr Duration kPeriod = 10ms;
constexpr double kTouching_m = 0.181;

using Places = std::vector<std::optional<Vec2>>;

Places places(double second_x_m) { return {Vec2(0, 0), Vec2(second_x_m, 0), Vec2(5, 5)}; }

void step_for(Hands& hands, Duration duration, const Places& at) {
  for (Duration t{0}; t < duration; t += kPeriod) hands.step(at, kTouching_m);
}

}  // namespace

TEST_CASE("a robot that was moved is in nobody's hands when it has been seen in its place later") {
  Hands hands(3, kPeriod, true);
  hands.move(0, 500ms);
  CHECK(hands.are_on(0));
  step_for(hands, 1400ms, places(3));
  hands.see_in_place(0);
  CHECK(hands.are_on(0));
  step_for(hands, 200ms, places(3));
  CHECK(hands.are_on(0));
  hands.see_in_place(0);
  CHECK_FALSE(hands.are_on(0));
}

TEST_CASE("who does not see places takes robots to be back after a while") {
  Hands hands(3, kPeriod, false);
  hands.move(0, 500ms);
  step_for(hands, 1400ms, places(3));
  CHECK(hands.are_on(0));
  step_for(hands, 200ms, places(3));
  CHECK_FALSE(hands.are_on(0));
}

TEST_CASE("who touches one that was moved is pushed for as long as they touch") {
  const bool part = GENERATE(false, true);
  CAPTURE(part);
  Hands hands(3, kPeriod, true);
  hands.move(0, 0ms);
  CHECK(hands.touch(0, 1));
  // In place, as far as can be seen, again and again, while the first one is not.
  for (int i = 0; i < 500; ++i) {
    hands.step(places(part ? 0.19 : 0.18), kTouching_m);
    hands.see_in_place(1);
  }
  CHECK(hands.are_on(1) == !part);
  CHECK(hands.touch(1, 2) == !part);
  CHECK(hands.are_on(2) == !part);
}

TEST_CASE("two that touch do not keep each other in somebody's hands") {
  Hands hands(3, kPeriod, true);
  hands.move(0, 0ms);
  CHECK(hands.touch(1, 0));
  for (int i = 0; i < 300; ++i) {
    hands.step(places(0.18), kTouching_m);
    hands.see_in_place(0);
    hands.see_in_place(1);
  }
  CHECK_FALSE(hands.are_on(0));
  CHECK_FALSE(hands.are_on(1));
  CHECK_FALSE(hands.touch(1, 2));
}

TEST_CASE("what is no robot is in nobody's hands") {
  Hands hands(3, kPeriod, true);
  CHECK_FALSE(hands.touch(1, std::nullopt));
  hands.move(1, 0ms);
  CHECK(hands.touch(1, std::nullopt));
  CHECK(hands.touch(std::nullopt, 1));
}
