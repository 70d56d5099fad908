// SPDX-License-Identifier: Apache-2.0
#include "tests/study/safety/interpenetration.hpp"

#include "tests/catch.hpp"

namespace sidestep::interpenetration_test {

TEST_CASE("a disc that passes through another disc counts one contact and the integral of the depth") {
  // One disc passes through the centre of a resting disc at 1 m/s. The depth is 0.2 m minus the distance,
  // which is |t| metres, so its integral is 0.2 m times 0.2 s.
  Interpenetration meter(2, 0.1);
  const double step_s = 1e-4;
  for (double t = -0.5; t < 0.5; t += step_s) {
    const Vec2 positions[] = {{t, 0}, {0, 0}};
    meter.add(positions, step_s);
  }
  CHECK(meter.depth_time_m_s() == Approx(0.04).epsilon(1e-3));
  CHECK(meter.contacts() == 1);
  CHECK(meter.min_clearance_m() == Approx(-0.2).margin(1e-3));
}

TEST_CASE("for discs that approach and part without contact only the clearance is recorded") {
  Interpenetration meter(3, 0.1);
  for (const double gap : {0.3, 0.05, 0.3}) {
    const Vec2 positions[] = {{0, 0}, {0.2 + gap, 0}, {5, 5}};
    meter.add(positions, 0.01);
  }
  CHECK(meter.depth_time_m_s() == 0);
  CHECK(meter.contacts() == 0);
  CHECK(meter.min_clearance_m() == Approx(0.05));
}

}  // namespace sidestep::interpenetration_test
