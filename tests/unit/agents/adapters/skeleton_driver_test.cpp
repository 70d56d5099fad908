// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/skeleton/skeleton_driver.hpp"

#include "agents/adapters/measured_motion.hpp"
#include "tests/catch.hpp"

namespace sidestep::skeleton_driver_test {

using namespace std::chrono_literals;

TEST_CASE("the driver template moves ideal bases and reports their positions") {
  Time now = time_from_ns(1'000'000'000'000);
  SkeletonDriver driver({2, 5}, [&now] { return now; });
  MeasuredMotion measured;
  driver.on_odometry([&](const OdometryReport& report) {
    if (report.robot == 5) measured.add(report);
  });
  const std::vector<BaseCommand> commands{{2, {}}, {5, {{0.5, 0.1}, 0}}, {99, {{1, 0}, 0}}};
  for (int i = 0; i < 100; ++i) {
    now += 10ms;
    driver.send(commands);
  }
  CHECK(driver.base(2).position_m == Vec2(0, 0));
  CHECK(driver.base(5).position_m.x() == Approx(0.495));  // each command holds until the next
  const auto velocity = measured.mean(now - 10ms, now);
  REQUIRE(velocity);
  CHECK(velocity->linear_mps.y() == Approx(0.1));
}

}  // namespace sidestep::skeleton_driver_test
