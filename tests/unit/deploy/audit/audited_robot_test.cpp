// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/audited_robot.hpp"

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

TEST_CASE("recent versions stay recent when older ones are evicted or arrive late") {
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

TEST_CASE("a version that arrives late is recent even if higher versions were excluded long ago") {
  AuditedRobot robot;
  for (const VersionNumber number : {2u, 4u, 6u}) {
    KnownVersion& known = robot.find_or_insert(number);
    if (number == 6) continue;
    known.exclusion = Exclusion::kOlder;
    known.excluded_ns = 10;
  }
  robot.advance_recent(11);
  REQUIRE(first_recent(robot) == 6);
  robot.find_or_insert(3);
  CHECK(first_recent(robot) == 3);
}

TEST_CASE("a version that was neither granted nor registered belongs to no epoch") {
  KnownVersion known;
  CHECK_FALSE(known.is_in(0));
  CHECK_FALSE(known.is_in(1));
  known.granted_in = 1;
  CHECK(known.is_in(1));
  CHECK_FALSE(known.is_in(0));
}

/// Gives a version content: it continues `base` and starts at `start_ns`.
void add_content(AuditedRobot& robot, VersionNumber number, VersionNumber base, std::int64_t start_ns) {
  KnownVersion& known = robot.find_or_insert(number);
  known.has_content = true;
  known.version.version_number(number);
  known.version.base(base);
  known.version.start_ns(start_ns);
  known.path = AuditPath(known.version);
}

TEST_CASE(
    "after a robot is lifted, only its new place and versions that continue from there remain possible") {
  AuditedRobot robot;
  AuditedRobot::ReceivedReport lifted;
  lifted.at_ns = 100;
  lifted.is_lifted = true;
  lifted.last_executed = 7;
  add_content(robot, 0, 0, 101);  // the initial rest
  add_content(robot, 8, 0, 101);
  add_content(robot, 9, 8, 101);
  add_content(robot, 10, 0, 100);
  add_content(robot, 11, 7, 101);
  CHECK(exclusion_by(lifted, *robot.find(0)) == Exclusion::kLifted);
  CHECK(exclusion_by(lifted, *robot.find(8)) == Exclusion::kNone);
  CHECK(exclusion_by(lifted, *robot.find(9)) == Exclusion::kNone);
  CHECK(exclusion_by(lifted, *robot.find(10)) == Exclusion::kLifted);
  CHECK(exclusion_by(lifted, *robot.find(11)) == Exclusion::kLifted);
}

TEST_CASE("a version excluded as late is possible again once the robot's clock has been set back") {
  AuditedRobot robot = robot_with(5, 3);
  robot.last_report.emplace().at_ns = 1000;
  robot.find(4)->exclusion = Exclusion::kLate;
  robot.find(4)->excluded_ns = 10;
  robot.advance_recent(11);
  REQUIRE(first_recent(robot) == 5);
  robot.forget_times();
  CHECK(robot.find(4)->exclusion == Exclusion::kNone);
  CHECK(robot.find(4)->excluded_ns == kNever);
  CHECK(robot.find(3)->exclusion == Exclusion::kOlder);
  CHECK(first_recent(robot) <= 4);
}

TEST_CASE("a version continues another if the bases of all versions between them are known and match") {
  AuditedRobot robot;
  for (const VersionNumber number : {3u, 5u, 6u, 9u})
    add_content(robot, number, number == 9 ? 6 : number - 1, 0);
  robot.find_or_insert(4);
  CHECK(robot.continues(9, 9));
  CHECK(robot.continues(6, 9));
  CHECK(robot.continues(5, 9));
  CHECK(robot.continues(4, 5));
  CHECK_FALSE(robot.continues(3, 9));  // the content of version 4 is unknown
  CHECK_FALSE(robot.continues(7, 9));  // version 9 does not continue version 7
  CHECK_FALSE(robot.continues(9, 6));
  CHECK_FALSE(robot.continues(3, 8));
}

TEST_CASE("executed versions stay counted even after they are forgotten") {
  AuditedRobot robot;
  robot.traceable_from_ns = 100;
  for (VersionNumber number = 1; number <= 10; ++number) {
    add_content(robot, number, number - 1, number == 1 ? 100 : 101);
    KnownVersion& known = robot.find_or_insert(number);
    known.was_executed = number != 2;
    known.is_own_stop = number == 3;
    known.is_proposed = number != 4;
    known.granted_in = number == 5 ? 0 : 7;
    known.sent_ns = number == 6 ? kNever : 50;
    known.is_content_checked = number != 9;
    known.is_pair_checked = number != 10;
    known.excluded_ns = 10;
  }
  const auto check = [&] {
    CHECK(robot.executed_versions().all == 7);     // versions 4 to 10
    CHECK(robot.executed_versions().traced == 2);  // versions 7 and 8
  };
  check();
  robot.forget(11);
  CHECK(robot.versions.empty());
  check();
  robot.registered.emplace().epoch = 7;
  robot.reset();
  check();
  CHECK(robot.forgotten_until_epoch == 7);
  robot.reset();
  CHECK(robot.forgotten_until_epoch == 7);
}

TEST_CASE("versions to which a robot switches soon after its first report are counted separately") {
  AuditedRobot robot;
  constexpr std::int64_t kFirstReport_ns = 5'000'000'000;
  robot.traceable_from_ns = kFirstReport_ns + kMaxLead_ns;
  const std::vector<std::int64_t> starts_ns{kFirstReport_ns, kFirstReport_ns + 1, robot.traceable_from_ns,
                                            robot.traceable_from_ns + 1};
  for (VersionNumber number = 1; number <= starts_ns.size(); ++number) {
    add_content(robot, number, number - 1, starts_ns[number - 1]);
    KnownVersion& known = robot.find_or_insert(number);
    known.was_executed = true;
    known.excluded_ns = 10;
  }
  KnownVersion& traced = robot.find_or_insert(2);
  traced.is_proposed = traced.is_content_checked = traced.is_pair_checked = true;
  traced.granted_in = 7;
  traced.sent_ns = 50;
  const auto check = [&] {
    CHECK(robot.executed_versions().all == 1);        // version 4
    CHECK(robot.first_executed_versions().all == 2);  // versions 2 and 3; the robot reported version 1 first
    CHECK(robot.first_executed_versions().traced == 1);  // version 2
  };
  check();
  robot.forget(11);
  CHECK(robot.versions.empty());
  check();
  robot.reset();
  check();
}

TEST_CASE("a robot's initial rest does not count as an agent's version, but version 1 does") {
  for (const VersionNumber number : {0u, 1u}) {
    AuditedRobot robot;
    robot.traceable_from_ns = 100;
    add_content(robot, number, 0, 101);
    robot.find(number)->was_executed = true;
    CHECK(robot.executed_versions().all == number);
  }
}

TEST_CASE("find_near() finds a version from any former index") {
  AuditedRobot robot = robot_with(10, 0);
  const std::size_t size = robot.versions.size();
  for (VersionNumber number = 1; number <= 11; ++number) {
    const KnownVersion* const expected = robot.find(number);
    for (std::size_t index = 0; index <= size; ++index) CHECK(robot.find_near(index, number) == expected);
  }
}

}  // namespace sidestep::audited_robot_test
