// SPDX-License-Identifier: Apache-2.0
#include "common/robot/stable_memory.hpp"

#include <optional>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/robot/test_memory.hpp"

namespace sidestep::robot {

using test::at_ms;
using test::command;
using test::rest_version;
using test::TestMemory;

TEST_CASE("a robot stores the agent and epoch before it acknowledges them") {
  TestMemory memory;
  RobotSide<double> side({}, {});
  side.begin_at_rest(1, 2);
  REQUIRE(side.on_command(command(100, 7), at_ms(1), memory));
  CHECK(memory.stored.incarnation == 100);
  CHECK(memory.stored.epoch == 7);
  CHECK(side.robot_report(at_ms(2)).obeyed_incarnation == 100);
  CHECK(side.robot_report(at_ms(2)).obeyed_epoch == 7);
}

TEST_CASE("a robot whose memory fails neither obeys nor acknowledges a new agent or epoch") {
  TestMemory memory;
  RobotSide<double> side({}, {});
  side.begin_at_rest(0, 0);
  REQUIRE(side.on_command(command(100, 7), at_ms(1), memory));
  memory.fails = true;
  const Version version = rest_version(101, 0, 50);
  CHECK_FALSE(side.on_command(command(200, 7, &version), at_ms(2), memory));
  CHECK_FALSE(side.on_command(command(100, 8, &version), at_ms(2), memory));
  CHECK(side.robot_report(at_ms(3)).obeyed_incarnation == 100);
  CHECK(side.robot_report(at_ms(3)).obeyed_epoch == 7);
  // The first version is also refused, because the robot would have to store that it has moved.
  CHECK(side.on_command(command(100, 7, &version), at_ms(4), memory));
  CHECK(side.robot_report(at_ms(60)).executing->number == 0);
  CHECK(side.counts().refused_unstored == 3);
  memory.fails = false;
  const Version later = rest_version(102, 0, 80);
  CHECK(side.on_command(command(100, 7, &later), at_ms(61), memory));
  CHECK(side.robot_report(at_ms(80)).executing->number == 102);
}

TEST_CASE("a restarted robot still refuses superseded agents and epochs and knows that it has moved") {
  TestMemory memory;
  {
    RobotSide<float> side({}, {});
    side.begin_at_rest(0, 0);
    const Version version = rest_version(201, 0, 20, 200);
    REQUIRE(side.on_command(command(200, 9, &version), at_ms(1), memory));
    REQUIRE(side.robot_report(at_ms(30)).executing->number == 201);
  }
  RobotSide<float> side({}, memory.stored);
  CHECK_FALSE(side.has_pose());
  CHECK_FALSE(side.may_report());
  side.find_pose();
  side.check_reference(at_ms(40), {}, memory);
  const RobotReport robot_report = side.robot_report(at_ms(41));
  CHECK(robot_report.obeyed_incarnation == 200);
  CHECK(robot_report.obeyed_epoch == 9);
  CHECK(robot_report.has_moved);
  CHECK(robot_report.is_off_reference);
  CHECK(robot_report.executing->number > 201);
  CHECK_FALSE(side.on_command(command(199, 9), at_ms(42), memory));
  const Version old_epoch =
      rest_version(robot_report.executing->number + 1, robot_report.executing->number, 60, 200);
  CHECK(side.on_command(command(200, 8, &old_epoch), at_ms(42), memory));
  CHECK_FALSE(side.has_pending());
}

TEST_CASE("after a restart at any time, a robot numbers its own stop above all received and used numbers") {
  Rng rng(23);
  TestMemory memory;
  std::optional<RobotSide<double>> side(std::in_place, Settings<double>{}, DurableState{});
  side->begin_at_rest(0, 0);
  std::uint64_t highest = 0, agent = 1'000'000;
  std::int64_t now = at_ms(0);
  for (int i = 0; i < 20'000; ++i) {
    now += 1'000'000;
    if (rng.chance(0.001)) agent += static_cast<std::uint64_t>(rng.uniform(1.0, 1e12));
    const std::uint64_t number = std::max(highest, agent) + static_cast<std::uint64_t>(rng.uniform(1.0, 2e6));
    const Version version = rest_version(number, side->executing().number, 0, agent);
    highest = std::max(highest, number);
    (void)side->on_command(command(agent, 1, &version), now, memory);
    if (!rng.chance(0.01)) continue;
    if (rng.chance(0.5))
      side->reboot();
    else
      side.emplace(Settings<double>{}, memory.stored);
    if (!side->has_pose()) side->find_pose();
    side->check_reference(now + 500'000, {}, memory);
    INFO("after " << i << " commands");
    REQUIRE(side->executing().number > highest);
    REQUIRE(side->executing().number <= memory.stored.number_bound);
    highest = side->executing().number;
  }
}

TEST_CASE("a robot stores rarely: a day of commands costs a few writes") {
  TestMemory memory;
  RobotSide<double> side({}, {});
  side.begin_at_rest(0, 0);
  std::uint64_t number = 1'700'000'000'000'000'000;
  const std::uint64_t agent = number;
  // 60 cycles a second with four proposals of five candidates each.
  for (int i = 0; i < 86'400 * 60; i += 100) {
    number += 20 * 100;
    const Version version = rest_version(number, 0, 0, agent);
    (void)side.on_command(command(agent, 1, &version), at_ms(i), memory);
  }
  CHECK(memory.writes <= 5);
}

TEST_CASE("a robot that cannot store the number of its own stop still stops but is silent until it can") {
  TestMemory memory;
  RobotSide<double> side({}, {});
  side.begin_at_rest(0, 0);
  memory.fails = true;
  Estimate<double> pushed;
  pushed.position_m = {1, 0};
  side.check_reference(at_ms(1), pushed, memory);
  REQUIRE(side.is_off_reference());
  CHECK_FALSE(side.may_report());
  CHECK_FALSE(side.on_command(command(100, 1), at_ms(2), memory));
  CHECK_FALSE(side.may_report());
  memory.fails = false;
  CHECK(side.on_command(command(100, 1), at_ms(3), memory));
  CHECK(side.may_report());
  CHECK(memory.stored.number_bound >= side.executing().number);
}

}  // namespace sidestep::robot
