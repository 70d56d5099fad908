// SPDX-License-Identifier: Apache-2.0
#include "coordinator/fleet_reception.hpp"

#include "tests/catch.hpp"

namespace sidestep::fleet_reception_test {

constexpr Duration kPeriod{16'666'667};

Time after_ms(int ms) { return time_from_ns(1'000'000'000'000) + std::chrono::milliseconds(ms); }

TEST_CASE("a coordinator hears its robots while facts arrive from half of the recently heard robots") {
  FleetReception reception(kPeriod);
  CHECK_FALSE(reception.hears_robots(after_ms(0)));
  for (const RobotId robot : {1, 2, 3, 4}) reception.on_robot_report(robot, 5, false, after_ms(0));
  CHECK(reception.hears_robots(after_ms(80)));
  CHECK_FALSE(reception.hears_robots(after_ms(90)));
  reception.on_robot_report(1, 5, false, after_ms(100));
  CHECK_FALSE(reception.hears_robots(after_ms(100)));
  reception.on_robot_report(2, 5, false, after_ms(100));
  CHECK(reception.hears_robots(after_ms(100)));
  // Robots that have been silent for a long time do not count.
  reception.on_robot_report(4, 5, false, after_ms(10'200));
  CHECK(reception.hears_robots(after_ms(10'200)));
}

TEST_CASE("a coordinator hears robots that report as rarely as they may, at any control rate") {
  const Duration cycle = GENERATE(Duration{2'000'000}, kPeriod, Duration{200'000'000});
  CAPTURE(cycle);
  FleetReception reception(cycle);
  const Time begin = after_ms(0);
  for (int i = 0; i < 10; ++i) {
    reception.on_robot_report(1, 5, false, begin + i * max_report_gap(cycle));
    CHECK(reception.hears_robots(begin + (i + 1) * max_report_gap(cycle)));
  }
}

TEST_CASE("a fleet counts as served while robots begin to execute granted versions") {
  FleetReception reception(kPeriod);
  const Duration lately = std::chrono::milliseconds(60);
  reception.on_robot_report(1, 5, true, after_ms(0));
  CHECK_FALSE(reception.is_fleet_served(lately, after_ms(0)));  // the version may have begun long ago
  reception.on_robot_report(1, 5, true, after_ms(10));
  CHECK_FALSE(reception.is_fleet_served(lately, after_ms(10)));
  reception.on_robot_report(1, 9, false, after_ms(20));  // the robot's own stop
  CHECK_FALSE(reception.is_fleet_served(lately, after_ms(20)));
  reception.on_robot_report(1, 10, true, after_ms(30));
  CHECK(reception.is_fleet_served(lately, after_ms(89)));
  CHECK_FALSE(reception.is_fleet_served(lately, after_ms(90)));
  reception.on_robot_report(1, 7, true, after_ms(100));  // arrives late
  CHECK_FALSE(reception.is_fleet_served(lately, after_ms(100)));
}

TEST_CASE("an agent counts as asking for a coordinator while it repeats its registration") {
  FleetReception reception(kPeriod);
  CHECK(reception.request_duration(1, after_ms(0)) == Duration{0});
  for (int ms = 0; ms <= 600; ms += 100) reception.on_registration(1, after_ms(ms));
  CHECK(reception.request_duration(1, after_ms(650)) == std::chrono::milliseconds(600));
  CHECK(reception.time_since_first_request(1, after_ms(650)) == std::chrono::milliseconds(650));
  CHECK(reception.request_duration(1, after_ms(1000)) == Duration{0});
  // Agents that only measure the clock register once per second.
  for (int ms = 2000; ms <= 9000; ms += 1000) {
    reception.on_registration(1, after_ms(ms));
    CHECK(reception.request_duration(1, after_ms(ms)) == Duration{0});
  }
  for (int ms = 9100; ms <= 9500; ms += 100) reception.on_registration(1, after_ms(ms));
  reception.forget_requests();
  reception.on_registration(1, after_ms(9600));
  CHECK(reception.request_duration(1, after_ms(9600)) == Duration{0});
}

TEST_CASE("a coordinator hears its agents if a message from each has arrived recently") {
  FleetReception reception(kPeriod);
  reception.on_agent(1, after_ms(0));
  CHECK_FALSE(reception.hears_agents({1, 2}, after_ms(0)));
  reception.on_agent(2, after_ms(1000));
  CHECK(reception.hears_agents({1, 2}, after_ms(2500)));
  CHECK_FALSE(reception.hears_agents({1, 2}, after_ms(2600)));
  CHECK(reception.hears_agents({2}, after_ms(2600)));
}

}  // namespace sidestep::fleet_reception_test
