// SPDX-License-Identifier: Apache-2.0
// Verdicts on missing candidates, and on first versions of absent robots that are not rest versions.
#include "tests/catch.hpp"
#include "tests/unit/coordinator/coordinator_fixture.hpp"

namespace sidestep::denied_candidates_test {

using coordinator_test::Floor;
using coordinator_test::kEpoch;

TEST_CASE("a verdict evaluates only as many candidates as the proposal has") {
  Floor floor;
  floor.register_both();
  const auto verdict = floor.ask(proposal_of({continued(floor.a, 10, 1, {3, 0}, 0.6)}, kEpoch));
  CHECK(verdict.granted_version == 0);
  CHECK(verdict.reasons[0] == msg::Reason::REASON_CONFLICT);
  for (std::size_t i = 1; i < verdict.reasons.size(); ++i) {
    CAPTURE(i);
    CHECK(verdict.reasons[i] == msg::Reason::REASON_NOT_EVALUATED);
  }
}

TEST_CASE("a robot that is off the floor is granted only a rest version on base 0") {
  Ledger ledger(floor_for_tests(), {1});
  ledger.register_robot(1, {});
  Version on_other_base = rest_version(1, {0, 0}, 5);
  on_other_base.base = 3;
  CHECK(ledger.grant(on_other_base).reason == msg::Reason::REASON_ABSENT);
  Version moving = continued(rest_version(1, {0, 0}), 6, 1, {1, 0});
  CHECK(ledger.grant(moving).reason == msg::Reason::REASON_ABSENT);
  CHECK(ledger.grant(rest_version(1, {0, 0}, 7)).is_granted());
}

}  // namespace sidestep::denied_candidates_test
