// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/displaced_obstacles.hpp"

#include <cmath>
#include <vector>

#include "tests/catch.hpp"

namespace sidestep::displaced_obstacles_test {

constexpr Time kNow = time_from_ns(1'000'000'000'000);
constexpr Duration kClockDifference{1'000'000};
constexpr Duration kNoLag{0};

msg::RobotNotice displaced(RobotId robot, double x, double vx, Time observed_at = kNow) {
  msg::RobotNotice notice;
  notice.robot(robot);
  notice.is_displaced(true);
  notice.x_m(x);
  notice.vx_mps(vx);
  notice.position_variance_m2(1e-4);
  notice.observed_at_ns(to_ns(observed_at));
  return notice;
}

struct Fixture {
  DisplacedObstacles obstacles{3, 0.09, 0.01, 2, kClockDifference};
  std::vector<msg::RobotNotice> notices;

  void receive(const std::vector<msg::RobotNotice>& all, Time now = kNow) {
    notices = all;
    CoordinatorHeartbeat heartbeat;
    heartbeat.notices = notices;
    obstacles.on_heartbeat(heartbeat, now);
  }
};

TEST_CASE("other robots that are displaced are moving obstacles") {
  Fixture f;
  msg::RobotNotice missing;
  missing.robot(8);
  missing.is_missing(true);
  f.receive({displaced(3, 1, 0), displaced(5, 2, 0.5), missing});
  const auto recent = f.obstacles.recent(kNow, kNoLag);
  REQUIRE(recent.size() == 1);
  CHECK(recent[0].reach.position_m.x() == 2);
  CHECK(recent[0].reach.radius_m == Approx(0.09 + 4 * 0.01));
  CHECK(recent[0].reach.observed_at == kNow - kClockDifference);
  CHECK(recent[0].reach.speed_mps == 2);
  CHECK(recent[0].reach.velocity_mps.x() == 0.5);
  CHECK(recent[0].separation_m == Approx(0.19));
  const Duration max_lag = std::chrono::milliseconds(60);
  CHECK(f.obstacles.recent(kNow, max_lag)[0].reach.observed_at == kNow - kClockDifference - max_lag);
  f.receive({});
  CHECK(f.obstacles.recent(kNow, kNoLag).empty());
}

TEST_CASE("a displaced robot is dropped after vision has lost it for a second") {
  Fixture f;
  f.receive({displaced(5, 2, 0)});
  CHECK(f.obstacles.recent(kNow + std::chrono::milliseconds(990), kNoLag).size() == 1);
  CHECK(f.obstacles.recent(kNow + std::chrono::milliseconds(1010), kNoLag).empty());
}

TEST_CASE("a robot that is silent but not displaced is a moving obstacle") {
  Fixture f;
  msg::RobotNotice silent = displaced(5, 2, 1);
  silent.is_displaced(false);
  f.receive({silent});
  CHECK(f.obstacles.recent(kNow, kNoLag).empty());
  silent.is_silent(true);
  f.receive({silent});
  CHECK(f.obstacles.recent(kNow, kNoLag).size() == 1);
}

}  // namespace sidestep::displaced_obstacles_test
