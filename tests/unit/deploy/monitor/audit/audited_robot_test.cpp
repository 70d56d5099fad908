// SPDX-License-Identifier: Apache-2.0
#include "deploy/monitor/audit/audited_robot.hpp"

#include "tests/catch.hpp"

namespace sidestep::audited_robot_test {

/// Versions 1 to `count`, of which the first `excluded` were excluded at 10 ns.
AuditedRobot robot_with(VersionNumber count, VersionNumber excluded) {
  AuditedRobot robot;
  for (VersionNumber number = 1; number <= count; ++number) {
    KnownVersion& known = robot.find_or_insert(number);
    if (number > excluded) continue;
    known.exclusion = Exclusion::kOlder;
    known.excluded_ns = 10;
  }
  return robot;
}

VersionNumber first_recent(const AuditedRobot& robot) { return robot.versions.at(robot.first_recent).number; }

TEST_CASE("versions excluded long ago are skipped until new evidence arrives") {
  AuditedRobot robot = robot_with(5, 3);
  robot.advance_recent(10);
  CHECK(first_recent(robot) == 1);
  robot.advance_recent(11);
  CHECK(first_recent(robot) == 4);
  robot.make_recent(5);
  CHECK(first_recent(robot) == 4);
  robot.make_recent(2);
  CHECK(first_recent(robot) == 2);
}

TEST_CASE("a robot's recent versions stay recent when older ones are evicted or arrive late") {
  AuditedRobot robot = robot_with(AuditedRobot::kMaxVersions, 40);
  robot.advance_recent(11);
  REQUIRE(first_recent(robot) == 41);
  robot.find_or_insert(AuditedRobot::kMaxVersions + 1);
  CHECK(first_recent(robot) == 41);
  CHECK(robot.find(1) == nullptr);
  CHECK(robot.max_evicted_version == 1);
  robot.forget(11);
  robot.advance_recent(11);
  CHECK(first_recent(robot) == 41);
  CHECK(robot.versions.size() == AuditedRobot::kMaxVersions + 1 - 40);
  robot.find_or_insert(7);
  CHECK(first_recent(robot) == 7);
}

TEST_CASE("a version is found near its former index") {
  AuditedRobot robot = robot_with(10, 0);
  const std::size_t size = robot.versions.size();
  for (VersionNumber number = 1; number <= 11; ++number) {
    const KnownVersion* const expected = robot.find(number);
    for (std::size_t index = 0; index <= size; ++index) CHECK(robot.find_near(index, number) == expected);
  }
}

}  // namespace sidestep::audited_robot_test
