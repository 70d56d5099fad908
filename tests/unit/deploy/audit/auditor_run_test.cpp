// SPDX-License-Identifier: Apache-2.0
// The duration of a run.
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/stage.hpp"

namespace sidestep::auditor_run_test {

using namespace std::chrono_literals;

TEST_CASE("a run lasts until its latest message of any kind, even an invalid one") {
  Stage stage;
  stage.begin();
  stage.drive(stage.next(stage.rest(0), 1));
  const double before_s = stage.auditor.totals().run_s;
  stage.advance(2s);
  Auditor& auditor = stage.auditor;
  SECTION("proposal") { auditor.on_proposal({}, stage.now); }
  SECTION("verdict") { auditor.on_verdict({}, stage.now); }
  SECTION("registration") { auditor.on_registration({}, stage.now); }
  SECTION("coordinator state") { auditor.on_coordinator({}, stage.now); }
  SECTION("ledger page") { auditor.on_ledger({}, stage.now); }
  SECTION("command") { auditor.on_command({}, stage.now); }
  SECTION("feedback") { auditor.on_robot_report({}, stage.now); }
  SECTION("ground truth") { auditor.on_truth({}, stage.now); }
  SECTION("world state") { auditor.on_world_state({}, stage.now); }
  SECTION("disturbance") { auditor.on_disturbance({}, stage.now); }
  SECTION("attestation") { auditor.on_attestation({}, stage.now); }
  SECTION("order") { auditor.on_order({}, stage.now); }
  SECTION("answer to an order") { auditor.on_order_answer({}, stage.now); }
  SECTION("order memory") { auditor.on_order_memory({}, stage.now); }
  SECTION("order status") { auditor.on_order_status({}, stage.now); }
  SECTION("no message") { auditor.advance(stage.now); }
  CHECK(auditor.totals().run_s == Approx(before_s + 2));
}

TEST_CASE("message coverage is zero without messages and complete after a first message without a gap") {
  Stage stage;
  CHECK(stage.auditor.totals().coverage.messages == 0);
  stage.report(0);
  CHECK(stage.auditor.totals().coverage.messages == 1);
}

}  // namespace sidestep::auditor_run_test
