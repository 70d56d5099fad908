// SPDX-License-Identifier: Apache-2.0
// Contacts, crashes and counters in single ground-truth messages.
#include <algorithm>

#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/ground_truth_stage.hpp"

namespace sidestep::auditor_contacts_test {

using namespace std::chrono_literals;

constexpr AuditInput kIncomplete{};

TEST_CASE("contacts are reported one by one in the order of the ground truth") {
  GroundTruthStage shown;
  shown.run(50ms);
  shown.touch(0, 1);
  shown.run(20ms);
  CHECK(shown.count(AuditRule::kContact) == 1);
  shown.touch(1, msg::NO_ROBOT);
  shown.touch(1, 0);
  shown.run(20ms);
  REQUIRE(shown.count(AuditRule::kContact) == 3);
  CHECK(shown.violations[0].robot == 0);
  CHECK(shown.violations[1].robot == 1);
  CHECK(shown.violations[1].epoch == 0);
  CHECK_THAT(shown.violations[1].detail, ContainsSubstring("touches an obstacle"));
  CHECK_THAT(shown.violations[2].detail, ContainsSubstring("touches robot 0"));
  CHECK(shown.auditor.totals().unidentified_contacts == 0);
}

TEST_CASE("of many simultaneous contacts only the last eight are reported with their robots") {
  const auto [added, unidentified] = GENERATE(table<int, std::uint64_t>({{8, 0}, {9, 1}, {20, 12}}));
  GroundTruthStage shown;
  shown.run(50ms);
  for (int i = 0; i < added; ++i) shown.touch(0, 1);
  shown.run(20ms);
  CHECK(shown.count(AuditRule::kContact) == static_cast<std::uint64_t>(added) - unidentified);
  CHECK(shown.auditor.totals().unidentified_contacts == unidentified);
}

TEST_CASE("up to eight simultaneous crashes are reported one by one, and further crashes as one") {
  GroundTruthStage shown;
  shown.run(50ms);
  SECTION("one crash") {
    shown.crash(1);
    shown.run(20ms);
    REQUIRE(shown.count(AuditRule::kCrash) == 1);
    CHECK(shown.violations.front().robot == 1);
  }
  SECTION("eight crashes") {
    for (int i = 0; i < 8; ++i) shown.crash(1);
    shown.run(20ms);
    CHECK(shown.count(AuditRule::kCrash) == 8);
  }
  SECTION("nine crashes or more") {
    const int more = GENERATE(1, 5);
    for (int i = 0; i < 8 + more; ++i) shown.crash(1);
    shown.run(20ms);
    CHECK(shown.count(AuditRule::kCrash) == 9);
    CHECK(shown.violations.front().robot == 0);
  }
  SECTION("a pushed robot crashes") {
    shown.push(1);
    shown.run(20ms);
    shown.crash(1);
    shown.crash(0);
    shown.run(20ms);
    CHECK(shown.auditor.totals().excused_crashes == 1);
    REQUIRE(shown.count(AuditRule::kCrash) == 1);
    CHECK(shown.violations.front().robot == 0);
  }
  SECTION("a robot that is not on the roster crashes") {
    shown.crash(77);
    shown.run(20ms);
    CHECK(shown.count(AuditRule::kCrash) == 1);
  }
}

TEST_CASE("an auditor that joins a run does not judge earlier contacts and crashes") {
  GroundTruthStage shown(kIncomplete);
  for (int i = 0; i < 100; ++i) (void)shown.header("truth", 30'000, shown.incarnation);
  shown.touch(0, 1);
  shown.crash(0);
  shown.truth.firmware_violations(0);
  shown.run(50ms);
  CHECK(shown.violations.empty());
  CHECK(shown.auditor.totals().undecided_contacts == 1);
  CHECK(shown.auditor.totals().undecided_crashes == 1);
  shown.touch(0, 1);
  shown.crash(1);
  shown.run(50ms);
  CHECK(shown.count(AuditRule::kContact) == 1);
  CHECK(shown.count(AuditRule::kCrash) == 1);
  CHECK(shown.violations.size() == 2);
}

TEST_CASE("a contact is undecided if the disturbance that excuses it may have been missed") {
  GroundTruthStage shown(kIncomplete);
  shown.run(50ms);
  shown.push(0);
  shown.run(30ms);
  std::uint64_t undecided = 1;
  SECTION("ground truth stops showing a robot") { shown.truth.robots().resize(1); }
  SECTION("messages were missed while a robot was disturbed") {
    (void)shown.header("truth", 30'000, shown.incarnation);
  }
  SECTION("nothing was missed") { undecided = 0; }
  SECTION("an agent's message was missed, which cannot announce a disturbance") {
    (void)shown.header("registration", 0, Stage::kAgent);
    shown.register_versions(0, {shown.rest(0)});
    REQUIRE(shown.auditor.totals().missed == 1);
    undecided = 0;
  }
  shown.run(3s);
  shown.touch(0, 1);
  shown.run(50ms);
  CHECK(shown.auditor.totals().undecided_contacts == undecided);
  CHECK(shown.count(AuditRule::kContact) == 1 - undecided);
}

TEST_CASE("robots up to a millimetre apart count as touching and pass on a disturbance") {
  const double apart_m = GENERATE(0.1805, 0.1815);
  GroundTruthStage shown;
  shown.run(50ms);
  shown.push(0);
  shown.truth.robots()[0].x_m(1 - apart_m);
  shown.truth.robots()[0].reference_error_m(2 - apart_m);
  shown.run(20ms);
  shown.touch(0, 1);
  shown.run(3s);
  shown.touch(1, msg::NO_ROBOT);
  shown.run(20ms);
  CHECK(shown.count(AuditRule::kContact) == (apart_m < 0.181 ? 0 : 1));
}

TEST_CASE("every simulator's counters start at zero") {
  GroundTruthStage shown;
  shown.run(20ms);
  shown.touch(0, 1);
  shown.crash(1);
  shown.truth.firmware_violations(1);
  shown.run(50ms);
  REQUIRE(shown.violations.size() == 3);
  CHECK(shown.count(AuditRule::kFirmwareMonitor) == 1);
  SECTION("equal counts of the next simulator are new events") {
    ++shown.incarnation;
    shown.run(50ms);
    CHECK(shown.violations.size() == 6);
  }
  SECTION("higher counts of the same simulator are new events") {
    shown.truth.firmware_violations(3);
    shown.run(50ms);
    CHECK(shown.count(AuditRule::kFirmwareMonitor) == 2);
  }
  SECTION("lower counts of the same simulator are not new events") {
    shown.truth.contacts(0);
    shown.truth.crashes_while_moving(0);
    shown.truth.firmware_violations(0);
    shown.run(50ms);
    CHECK(shown.violations.size() == 3);
  }
  SECTION("the first of more than sixteen simulators is forgotten") {
    for (int i = 1; i < 16; ++i) {
      ++shown.incarnation;
      shown.truth.contacts(0), shown.truth.crashes_while_moving(0), shown.truth.firmware_violations(0);
      shown.show();
    }
    shown.incarnation -= 15;
    shown.truth.contacts(1);
    shown.show();
    CHECK(shown.violations.size() == 3);
    shown.incarnation += 16;
    shown.truth.contacts(0);
    shown.show();
    shown.incarnation -= 16;
    shown.truth.contacts(1);
    shown.show();
    CHECK(shown.violations.size() == 4);
  }
}

}  // namespace sidestep::auditor_contacts_test
