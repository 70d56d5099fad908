// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/audited_robot.hpp"

#include <catch2/catch.hpp>

using namespace sidestep;

namespace {

/// Versions 1 to `count`, of which the first `excluded` were excluded at 10 ns.
AuditedRobot robot_with(VersionNumber count, VersionNumber excluded) {
  AuditedRobot robot;
  for (VersionNumber number = 1; number <= count; ++number) {
    Known& known = robot.note(number);
    if (number > excluded) continue;
    known.excluded = Excluded::kOlder;
    known.excluded_ns = 10;
  }
  return robot;
}

VersionNumber first_recent(const AuditedRobot& robot) { return robot.versions.at(robot.first_recent).number; }

}  // namespace

TEST_CASE("what was excluded a while ago is passed over until more is known of it") {
  AuditedRobot robot = robot_with(5, 3);
  robot.age(10);
  CHECK(first_recent(robot) == 1);
  robot.age(11);
  CHECK(first_recent(robot) == 4);
  robot.make_recent(5);
  CHECK(first_recent(robot) == 4);
  robot.make_recent(2);
  CHECK(first_recent(robot) == 2);
}

TEST_CASE("a robot's recent versions stay so when older ones are given up or come late") {
  AuditedRobot robot = robot_with(AuditedRobot::kMostVersions, 40);
  robot.age(11);
  REQUIRE(first_recent(robot) == 41);
  robot.note(AuditedRobot::kMostVersions + 1);
  CHECK(first_recent(robot) == 41);
  CHECK(robot.find(1) == nullptr);
  CHECK(robot.given_up_version == 1);
  robot.forget(11);
  robot.age(11);
  CHECK(first_recent(robot) == 41);
  CHECK(robot.versions.size() == AuditedRobot::kMostVersions + 1 - 40);
  robot.note(7);
  CHECK(first_recent(robot) == 7);
}

TEST_CASE("a version is found near where it was, and where it has come to") {
  AuditedRobot robot = robot_with(10, 0);
  const std::size_t size = robot.versions.size();
  for (VersionNumber number = 1; number <= 11; ++number) {
    const Known* const expected = robot.find(number);
    for (std::size_t index = 0; index <= size; ++index) CHECK(robot.find_near(index, number) == expected);
  }
}
