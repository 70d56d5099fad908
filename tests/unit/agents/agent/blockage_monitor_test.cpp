// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/blockage_monitor.hpp"

#include "tests/catch.hpp"

namespace sidestep::blockage_monitor_test {

using namespace std::chrono_literals;

constexpr Time kStart = Time{} + 5s;

Blockage by_robot(std::uint32_t robot) { return {msg::BlockReason::BLOCK_ROBOT, robot, {1, 0}, {0, 0}}; }

TEST_CASE("a blockage is reported with its latest cause once it has lasted long enough") {
  BlockageMonitor monitor(300ms);
  CHECK_FALSE(monitor.is_blocked());
  monitor.on_blocked(by_robot(3), kStart);
  CHECK(monitor.is_blocked());
  CHECK_FALSE(monitor.lasting(kStart + 299ms));
  monitor.on_blocked(by_robot(4), kStart + 300ms);
  REQUIRE(monitor.lasting(kStart + 300ms));
  CHECK(monitor.lasting(kStart + 300ms)->blocker == 4);
}

TEST_CASE("a blockage ends when the goal becomes reachable, and the next one must last long enough again") {
  BlockageMonitor monitor(300ms);
  monitor.on_blocked(by_robot(3), kStart);
  monitor.clear();
  CHECK_FALSE(monitor.is_blocked());
  CHECK_FALSE(monitor.lasting(kStart + 1s));
  monitor.on_blocked(by_robot(3), kStart + 1s);
  CHECK_FALSE(monitor.lasting(kStart + 1299ms));
  CHECK(monitor.lasting(kStart + 1300ms));
}

TEST_CASE("after the clock is set back, a blockage must last long enough again") {
  BlockageMonitor monitor(300ms);
  monitor.on_blocked(by_robot(3), kStart);
  monitor.restart();
  monitor.on_blocked(by_robot(3), kStart - 4s);
  CHECK_FALSE(monitor.lasting(kStart - 3900ms));
  CHECK(monitor.lasting(kStart - 3700ms));
}

}  // namespace sidestep::blockage_monitor_test
