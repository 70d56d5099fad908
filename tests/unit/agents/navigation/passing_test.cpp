// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/passing.hpp"

#include <catch2/catch.hpp>

using namespace sidestep;

namespace {
Time at_s(double seconds) { return Time{} + from_seconds(seconds); }
}  // namespace

TEST_CASE("the preference for the right is small, and fades near the goal") {
  const PassingSettings settings;
  const PassingOnTheRight passing(settings);
  CHECK(passing.angle_rad(10) == settings.angle_rad);
  CHECK(passing.angle_rad(settings.fade_from_m / 2) == Approx(settings.angle_rad / 2));
  CHECK(passing.angle_rad(0) == 0);
}

TEST_CASE("a robot that is blocked and slow turns farther right up to a bound, and back once it is free") {
  const PassingSettings settings;
  PassingOnTheRight passing(settings);
  double t = 1;
  double last = 0;
  passing.update(false, 0, at_s(t));
  for (int i = 0; i < 200; ++i) {
    passing.update(false, 0, at_s(t += 0.0166));
    CHECK(passing.angle_rad(0) >= last);
    last = passing.angle_rad(0);
  }
  CHECK(last == settings.evade_most_rad);
  for (int i = 0; i < 200; ++i) passing.update(true, 0, at_s(t += 0.0166));
  CHECK(passing.angle_rad(0) == 0);
}

TEST_CASE("a robot that gets on, though not as it wishes, does not turn away") {
  PassingOnTheRight passing;
  for (int i = 0; i < 100; ++i) passing.update(false, 1.0, at_s(1 + 0.0166 * i));
  CHECK(passing.angle_rad(0) == 0);
}

TEST_CASE("a long pause counts as one decision") {
  const PassingSettings settings;
  PassingOnTheRight passing(settings);
  passing.update(false, 0, at_s(1));
  const double before = passing.angle_rad(0);
  passing.update(false, 0, at_s(100));
  CHECK(passing.angle_rad(0) - before <= 0.1 * settings.evade_rate_radps + 1e-12);
}
