// SPDX-License-Identifier: Apache-2.0
// Pending versions with the same start.
#include "common/robot/robot_side.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/robot/test_memory.hpp"

namespace sidestep::robot {

using test::at_ms;
using test::command;
using test::rest_version;
using test::TestMemory;

TEST_CASE("of versions with the same start, the lower number goes first in either order of arrival") {
  const bool is_lower_first = GENERATE(true, false);
  // Whether the higher version continues the lower one; otherwise both continue the initial rest.
  const bool is_chain = GENERATE(true, false);
  CAPTURE(is_lower_first, is_chain);
  TestMemory memory;
  RobotSide<double> side({}, {});
  side.begin_at_rest(0, 0);
  const Version low = rest_version(201, 0, 100), high = rest_version(202, is_chain ? 201 : 0, 100);
  CHECK(side.on_command(command(100, 1, is_lower_first ? &low : &high), at_ms(10), memory));
  CHECK(side.on_command(command(100, 1, is_lower_first ? &high : &low), at_ms(11), memory));
  CHECK(side.robot_report(at_ms(99)).executing->number == 0);
  CHECK(side.robot_report(at_ms(100)).executing->number == (is_chain ? 202 : 201));
  CHECK(side.robot_report(at_ms(101)).executing->number == (is_chain ? 202 : 201));
}

}  // namespace sidestep::robot
