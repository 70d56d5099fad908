// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/distance_meter.hpp"

#include "tests/catch.hpp"

namespace sidestep::distance_meter_test {

TEST_CASE("distances are measured in total and since a given time, without position noise") {
  DistanceMeter meter(time_from_ns(5'000'000'000));
  for (int i = 0; i <= 100; ++i) {
    msg::GroundTruth truth;
    truth.valid_at_ns(i * 100'000'000LL);
    truth.robots().resize(2);
    truth.robots()[0].robot(3);
    truth.robots()[0].x_m(0.02 * i);
    truth.robots()[1].robot(4);
    truth.robots()[1].y_m(i % 2 == 0 ? 0.001 : -0.001);
    meter.add(truth);
  }
  CHECK(meter.total_m() == Approx(2).margin(0.02));
  CHECK(meter.recent_total_m() == Approx(1).margin(0.02));
  CHECK(meter.stationary_robots(0.05) == std::vector<RobotId>{4});
}

}  // namespace sidestep::distance_meter_test
