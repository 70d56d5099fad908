// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/deadlock_recovery.hpp"

#include "tests/catch.hpp"

namespace sidestep::deadlock_recovery_test {

Time at_s(double seconds) { return Time{} + from_seconds(seconds); }

TEST_CASE("a blocked robot turns farther and farther right, and turns back once it is free") {
  DeadlockRecovery recovery;
  double t = 1;
  double last = 0;
  recovery.update(false, 0, at_s(t));
  CHECK_FALSE(recovery.is_active());
  int rounds = 0;
  for (int i = 0; i < 400; ++i) {
    recovery.update(false, 0, at_s(t += 0.0166));
    CHECK(recovery.is_active() == (recovery.angle_rad() > DeadlockRecovery::kActivation_rad));
    if (recovery.angle_rad() < last) {
      ++rounds;
      CHECK(recovery.angle_rad() == 0);
      CHECK(last > 6.2);
      CHECK(last <= 6.2832);
    }
    last = recovery.angle_rad();
  }
  CHECK(rounds == static_cast<int>(400 * 0.0166 * DeadlockRecovery::kTurnRate_radps / 6.2832));
  for (int i = 0; i < 200; ++i) recovery.update(true, 0, at_s(t += 0.0166));
  CHECK(recovery.angle_rad() == 0);
}

TEST_CASE("a robot that moves, even if not as desired, does not start recovery") {
  DeadlockRecovery recovery;
  for (int i = 0; i < 100; ++i) recovery.update(false, 1.0, at_s(1 + 0.0166 * i));
  CHECK(recovery.angle_rad() == 0);
}

TEST_CASE("a robot that escapes a deadlock keeps its angle for the release delay") {
  DeadlockRecovery recovery;
  double t = 1;
  recovery.update(false, 0, at_s(t));
  while (!recovery.is_active()) recovery.update(false, 0, at_s(t += 0.0166));
  recovery.update(false, 0, at_s(t += 0.0166));
  const double angle = recovery.angle_rad(), freed = t;
  while (t - freed < DeadlockRecovery::kReleaseDelay_s - 0.02) {
    recovery.update(true, 1, at_s(t += 0.0166));
    CHECK(recovery.angle_rad() == angle);
  }
  while (t - freed < DeadlockRecovery::kReleaseDelay_s + 1) recovery.update(true, 1, at_s(t += 0.0166));
  CHECK(recovery.angle_rad() == 0);
}

}  // namespace sidestep::deadlock_recovery_test
