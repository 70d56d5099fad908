// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/evasion.hpp"

#include <catch2/catch.hpp>

using namespace sidestep;

namespace {
Time at_s(double seconds) { return Time{} + from_seconds(seconds); }
}  // namespace

TEST_CASE("a robot that is blocked and slow turns farther right once round and back once it is free") {
  const EvasionSettings settings;
  Evasion evasion(settings);
  double t = 1;
  double last = 0;
  evasion.update(false, 0, at_s(t));
  CHECK_FALSE(evasion.is_needed());
  int rounds = 0;
  for (int i = 0; i < 400; ++i) {
    evasion.update(false, 0, at_s(t += 0.0166));
    CHECK(evasion.is_needed() == (evasion.angle_rad() > settings.needed_rad));
    if (evasion.angle_rad() < last) {
      ++rounds;
      CHECK(evasion.angle_rad() == 0);
      CHECK(last > 6.2);
      CHECK(last <= 6.2832);
    }
    last = evasion.angle_rad();
  }
  CHECK(rounds == static_cast<int>(400 * 0.0166 * settings.rate_radps / 6.2832));
  for (int i = 0; i < 200; ++i) evasion.update(true, 0, at_s(t += 0.0166));
  CHECK(evasion.angle_rad() == 0);
}

TEST_CASE("a robot that gets on though not as it wishes does not turn away") {
  Evasion evasion;
  for (int i = 0; i < 100; ++i) evasion.update(false, 1.0, at_s(1 + 0.0166 * i));
  CHECK(evasion.angle_rad() == 0);
}

TEST_CASE("a robot that found a way out of a jam goes on there for a while") {
  const EvasionSettings settings;
  Evasion evasion(settings);
  double t = 1;
  evasion.update(false, 0, at_s(t));
  while (!evasion.is_needed()) evasion.update(false, 0, at_s(t += 0.0166));
  evasion.update(false, 0, at_s(t += 0.0166));
  const double angle = evasion.angle_rad(), freed = t;
  while (t - freed < settings.leaves_s - 0.02) {
    evasion.update(true, 1, at_s(t += 0.0166));
    CHECK(evasion.angle_rad() == angle);
  }
  while (t - freed < settings.leaves_s + 1) evasion.update(true, 1, at_s(t += 0.0166));
  CHECK(evasion.angle_rad() == 0);
}
