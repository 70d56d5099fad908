// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/contact_counter.hpp"

#include <array>

#include "tests/catch.hpp"

namespace sidestep::contact_counter_test {

constexpr double kRadius_m = 0.09, kCycle_s = 0.02;

CycleMotion moving(const Vec2& from_m, const Vec2& velocity_mps) { return {{from_m, velocity_mps}, {0, 0}}; }

TEST_CASE("robots that touch between the ends of a cycle have a contact") {
  ContactCounter counter(kRadius_m, {});
  // They pass each other at a distance of 0.17 m, which is less than two radii.
  counter.add(std::array{moving({-0.07, 0}, {7, 0}), moving({0, 0.17}, {0, 0})}, kCycle_s);
  CHECK(counter.contacts() == 1);
}

TEST_CASE("robots that pass at a distance of two radii have no contact") {
  ContactCounter counter(kRadius_m, {});
  counter.add(std::array{moving({-0.07, 0}, {7, 0}), moving({0, 0.1801}, {0, 0})}, kCycle_s);
  CHECK(counter.contacts() == 0);
}

TEST_CASE("a pair counts again only after it was apart") {
  ContactCounter counter(kRadius_m, {Box{{1, -1}, {2, 1}}});
  const auto stand_at = [&](double x_m) { counter.add(std::array{moving({x_m, 0}, {0, 0})}, kCycle_s); };
  stand_at(0.92);
  stand_at(0.9099);
  stand_at(0.92);
  CHECK(counter.contacts() == 1);
  stand_at(0.5);
  stand_at(0.92);
  CHECK(counter.contacts() == 2);
}

}  // namespace sidestep::contact_counter_test
