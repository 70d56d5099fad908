// SPDX-License-Identifier: Apache-2.0
// The versions of a lifted robot that the ledger must keep.
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/stage.hpp"

namespace sidestep::auditor_lifted_test {

using namespace std::chrono_literals;

/// Robot 0 executes version 1 and is lifted. It has also been granted version 2, which continues version 1,
/// version 3, the place where it will be put down, and version 4, which continues version 3.
struct Lifted : Stage {
  Lifted() {
    begin();
    const msg::Version first = next(rest(0), 1);
    second = next(first, 2, 200ms);
    place = next(rest(0), 3, 300ms);
    later = next(place, 4, 400ms);
    for (const auto& version : {first, second, place, later}) grant(version);
    command(first);
    advance(50ms);
    robot_reports[0].executing(first);
    report(0);
    advance(1ms);
    msg::Version nothing;
    nothing.robot(0);
    nothing.base(1);
    robot_reports[0].executing(nothing);
    robot_reports[0].is_lifted(true);
    report(0);
    violations.clear();
    advance(1ms);
  }

  msg::Version second, place, later;
};

TEST_CASE("the ledger may drop a lifted robot's old versions but not its new place or versions from there") {
  Lifted lifted;
  const msg::Version other = lifted.rest(1);
  SECTION("all versions are kept") {
    lifted.show_page({lifted.second, lifted.place, lifted.later, other});
    CHECK(lifted.violations.empty());
  }
  SECTION("the version that continues the last executed version is dropped") {
    lifted.show_page({lifted.place, lifted.later, other});
    CHECK(lifted.violations.empty());
  }
  SECTION("the new place is dropped") {
    lifted.show_page({lifted.later, other});
    check_only(lifted, AuditRule::kLedgerPage, 1);
    CHECK(lifted.violations.front().version == 3);
  }
  SECTION("the version that continues the new place is dropped") {
    lifted.show_page({lifted.place, other});
    check_only(lifted, AuditRule::kLedgerPage, 1);
    CHECK(lifted.violations.front().version == 4);
  }
}

}  // namespace sidestep::auditor_lifted_test
