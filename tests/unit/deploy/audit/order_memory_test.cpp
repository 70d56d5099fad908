// SPDX-License-Identifier: Apache-2.0
// The order memories of coordinators as evidence, message by message.
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/order_run.hpp"

namespace sidestep::order_memory_test {

TEST_CASE("a grant between two memories with the same hold of its robot is reported once") {
  Run run;
  run.remember(kFirst, {hold(4, 100)});
  run.grant(kFirst, 4, 31);
  run.grant(kFirst, 5, 32);
  run.remember(kFirst, {hold(4, 100)});
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.found == std::vector<Found>{{AuditRule::kHeld, 4, 31, 7}});
  CHECK(run.details.front() ==
        "was granted 0.001 s after the coordinator had announced hold 100 of client 1000001, which is still "
        "in force");
  run.grant(kFirst, 4, 33, 8);
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.found.back() == Found{AuditRule::kHeld, 4, 33, 8});
}

TEST_CASE("violations name the client whose order was ignored") {
  Run run;
  msg::RememberedOrder named = hold(4, 100, client_id("kitchen"));
  named.terms().client_name(client_name("kitchen"));
  for (const msg::RememberedOrder& remembered : {named, hold(3, 101, kOperator)}) {
    run.remember(kFirst, {remembered});
    run.grant(kFirst, remembered.robot(), 31);
    run.remember(kFirst, {remembered});
  }
  REQUIRE(run.details.size() == 2);
  CHECK_THAT(run.details[0], ContainsSubstring("had announced hold 100 of client kitchen, which"));
  CHECK_THAT(run.details[1], ContainsSubstring("had announced hold 101 of the operator, which"));
}

TEST_CASE(
    "a single message can announce a hold, but only a complete memory shows that it is still in force") {
  Run run;
  run.audit.on_memory(run.page(kFirst, {hold(4, 100)}, 0, 0));
  run.grant(kFirst, 4, 31);
  run.audit.on_memory(run.page(kFirst, {hold(4, 100)}, 0, 0));
  CHECK(run.found.empty());
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.count(AuditRule::kHeld) == 1);
}

TEST_CASE("a grant breaks no rule unless it was certainly made while the hold was in force") {
  Run run;
  SECTION("the grant was made before the hold was announced") {
    run.grant(kFirst, 4, 31);
    run.remember(kFirst, {hold(4, 100)});
  }
  SECTION("the grant was made at the time of the first memory") {
    run.remember(kFirst, {hold(4, 100)});
    run.now_ns -= 1'000'000;
    run.grant(kFirst, 4, 31);
  }
  SECTION("the verdict may repeat a grant from before the hold") {
    const std::int64_t before_ns = run.now_ns;
    run.remember(kFirst, {hold(4, 100)});
    run.grant(kFirst, 4, 31, 7, before_ns);
  }
  SECTION("another coordinator made the grant") {
    run.remember(kFirst, {hold(4, 100)});
    run.grant(kSecond, 4, 31);
  }
  SECTION("an earlier run of the coordinator made the grant") {
    run.remember(kFirst, {hold(4, 100)});
    run.grant(kFirst, 4, 31);
    ++run.incarnations[kFirst];
  }
  SECTION("an earlier run of the coordinator made the grant, whose verdict arrives late") {
    run.remember(kFirst, {hold(4, 100)});
    --run.incarnations[kFirst];
    run.grant(kFirst, 4, 31);
    ++run.incarnations[kFirst];
  }
  SECTION("another memory shows that the hold was lifted at the time of the grant") {
    run.remember(kFirst, {hold(4, 100)});
    run.remember(kFirst, {});
    run.grant(kFirst, 4, 31);
  }
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.found.empty());
}

TEST_CASE("a grant with the time of the second order memory breaks no rule") {
  Run run;
  run.remember(kFirst, {hold(4, 100)});
  run.grant(kFirst, 4, 31);
  run.now_ns -= 1'000'000;
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.found.empty());
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.count(AuditRule::kHeld) == 1);
}

TEST_CASE("a hold announced after an order memory is in force even if the memory's last page is late") {
  Run run;
  const msg::OrderMemory first = run.page(kFirst, {}, 0, 2), second = run.page(kFirst, {}, 1, 2),
                         told = run.page(kFirst, {hold(4, 100)}, 0, 0);
  run.audit.on_memory(first);
  run.audit.on_memory(told);
  run.audit.on_memory(second);
  run.grant(kFirst, 4, 31);
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.count(AuditRule::kHeld) == 1);
}

TEST_CASE("a verdict breaks the rule if any earlier verdict that it may repeat also came after the hold") {
  Run run;
  run.remember(kFirst, {hold(4, 100)});
  const std::int64_t after_ns = run.now_ns + 1;
  run.grant(kFirst, 4, 31, 7, GENERATE_COPY(after_ns, kAlways));
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.count(AuditRule::kHeld) == 1);
}

TEST_CASE("the newest grant of a robot counts even if an older verdict arrives later") {
  Run run;
  run.remember(kFirst, {hold(4, 100)});
  run.grant(kFirst, 4, 31);
  const VersionNumber second = GENERATE(30u, 31u, 32u);
  run.grant(kFirst, 4, second);
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.found == std::vector<Found>{{AuditRule::kHeld, 4, std::max<VersionNumber>(31, second), 7}});
}

TEST_CASE("an order memory counts only if all of its pages are received in one sequence") {
  Run run;
  const std::vector<msg::RememberedOrder> holds{hold(4, 100)};
  run.remember(kFirst, holds);
  run.grant(kFirst, 4, 31);
  bool is_whole = false;
  SECTION("all pages arrive") {
    run.audit.on_memory(run.page(kFirst, holds, 0, 3));
    CHECK(run.found.empty());
    run.audit.on_memory(run.page(kFirst, {}, 1, 3));
    CHECK(run.found.empty());
    run.audit.on_memory(run.page(kFirst, {}, 2, 3));
    is_whole = true;
  }
  SECTION("the sequence starts over") {
    run.audit.on_memory(run.page(kFirst, {}, 0, 2));
    run.audit.on_memory(run.page(kFirst, holds, 0, 2));
    run.audit.on_memory(run.page(kFirst, {}, 1, 2));
    is_whole = true;
  }
  SECTION("a page is missing") {
    run.audit.on_memory(run.page(kFirst, holds, 0, 3));
    run.audit.on_memory(run.page(kFirst, {}, 2, 3));
  }
  SECTION("a page belongs to a later memory") {
    run.audit.on_memory(run.page(kFirst, holds, 0, 2));
    (void)run.page(kFirst, {}, 1, 2);
    (void)run.page(kFirst, {}, 0, 2);
    run.audit.on_memory(run.page(kFirst, {}, 1, 2));
  }
  SECTION("the first page is missing") { run.audit.on_memory(run.page(kFirst, holds, 1, 2)); }
  SECTION("the last page is missing") { run.audit.on_memory(run.page(kFirst, holds, 0, 2)); }
  CHECK(run.count(AuditRule::kHeld) == (is_whole ? 1 : 0));
}

TEST_CASE("a coordinator that forgets a confirmed order is reported once, with the order's robot") {
  const std::uint32_t robot = GENERATE(5u, std::uint32_t{msg::ALL_ROBOTS});
  Run run;
  run.grant(kFirst, 5, 1, 9);
  run.confirm(kFirst, hold(robot, 100));
  run.remember(kFirst, {});
  run.remember(kFirst, {});
  CHECK(run.found == std::vector<Found>{{AuditRule::kForgottenOrder, robot == 5 ? 5u : 3u, 0, 9}});
}

TEST_CASE("a coordinator may forget an order that it has not certainly confirmed") {
  Run run;
  SECTION("the coordinator did not answer the order") { run.send(hold(4, 100)); }
  SECTION("the coordinator answered that the order was replaced") {
    run.send(hold(4, 100));
    run.answer(kFirst, hold(4, 100), msg::OrderResult::RESULT_REPLACED);
  }
  SECTION("no process sent the order") { run.answer(kFirst, hold(4, 100)); }
  SECTION("the order is a resume") { run.confirm(kFirst, resume(4, 100)); }
  SECTION("the coordinator confirmed the order at the time of the memory") {
    run.confirm(kFirst, hold(4, 100));
    run.now_ns -= 1'000'000;
  }
  SECTION("another coordinator confirmed the order") { run.confirm(kSecond, hold(4, 100)); }
  SECTION("an earlier run of the coordinator confirmed the order") {
    run.confirm(kFirst, hold(4, 100));
    ++run.incarnations[kFirst];
  }
  run.remember(kFirst, {});
  CHECK(run.found.empty());
}

TEST_CASE("of two confirmed orders on one subject, the order with the higher number must be remembered") {
  const bool is_in_order = GENERATE(true, false);
  const bool is_kept = GENERATE(true, false);
  CAPTURE(is_in_order, is_kept);
  Run run;
  run.confirm(kFirst, hold(4, is_in_order ? 100 : 101));
  run.confirm(kFirst, hold(4, is_in_order ? 101 : 100));
  run.remember(kFirst, {hold(4, is_kept ? 101 : 100)});
  CHECK(run.count(AuditRule::kForgottenOrder) == (is_kept ? 0 : 1));
}

TEST_CASE("drive orders of all clients replace each other but not those of operator, referee and scenario") {
  const auto go = [](std::uint32_t client, std::uint64_t number) {
    return order(msg::OrderKind::ORDER_GO, 4, client, number);
  };
  const auto is_forgotten = [&](std::uint32_t confirmed, std::uint32_t remembered) {
    Run run;
    run.confirm(kFirst, go(confirmed, 100));
    run.remember(kFirst, {go(remembered, 101)});
    return run.count(AuditRule::kForgottenOrder) == 1;
  };
  const std::vector<std::uint32_t> clients{kClient, kOtherClient, kOperator, kReferee, kScenario};
  for (const std::uint32_t a : clients) {
    for (const std::uint32_t b : clients) {
      CAPTURE(a, b);
      const bool is_one_place = a == b || (a >= kClient && b >= kClient);
      CHECK(is_forgotten(a, b) == !is_one_place);
    }
  }
}

TEST_CASE(
    "of two orders with the same number, the order of the client with the higher id replaces the other") {
  const auto go = [](std::uint32_t client) { return order(msg::OrderKind::ORDER_GO, 4, client, 100); };
  Run run;
  run.confirm(kFirst, go(kClient));
  run.remember(kFirst, {go(kOtherClient)});
  CHECK(run.found.empty());
  run.confirm(kFirst, go(kOtherClient));
  run.remember(kFirst, {go(kClient)});
  CHECK(run.count(AuditRule::kForgottenOrder) == 1);
}

TEST_CASE("a coordinator that remembers many resumes or zone removals may have dropped holds or zones") {
  const bool are_many = GENERATE(true, false);
  CAPTURE(are_many);
  Run run;
  std::vector<msg::RememberedOrder> memory;
  const auto zone = order(msg::OrderKind::ORDER_ZONE, msg::ALL_ROBOTS, kClient, 100, 3);
  const auto lost = GENERATE_COPY(hold(4, 100), zone);
  const bool is_hold = lost.terms().order_kind() == msg::OrderKind::ORDER_HOLD;
  CAPTURE(is_hold);
  for (std::uint32_t i = 0; i < (is_hold ? 255u : 127u) + (are_many ? 1 : 0); ++i) {
    memory.push_back(is_hold ? resume(i, 1, kOtherClient)
                             : order(msg::OrderKind::ORDER_REMOVE_ZONE, msg::ALL_ROBOTS, kOtherClient, 1, i));
  }
  // Resumes and removals of another kind do not cause orders to be dropped.
  for (std::uint32_t i = 0; i < 300; ++i) memory.push_back(is_hold ? resume(i, 1, kOperator) : resume(i, 1));
  run.confirm(kFirst, lost);
  run.remember(kFirst, memory);
  CHECK(run.count(AuditRule::kForgottenOrder) == (are_many ? 0 : 1));
  // Later order memories are not judged either, because dropped orders do not return.
  run.confirm(kFirst, lost);
  run.remember(kFirst, {});
  CHECK(run.count(AuditRule::kForgottenOrder) == (are_many ? 0 : 2));
  // Orders of other kinds are judged.
  const auto go = order(msg::OrderKind::ORDER_GO, 4, kClient, 100);
  const auto other = is_hold ? zone : hold(5, 100);
  run.found.clear();
  run.confirm(kFirst, go);
  if (is_hold) run.confirm(kFirst, other);
  run.remember(kFirst, {});
  CHECK(run.count(AuditRule::kForgottenOrder) == (is_hold ? 2 : 1));
}

TEST_CASE("a grant during a hold of all robots is not judged once resumes may have been dropped") {
  const std::uint32_t robot = GENERATE(4u, std::uint32_t{msg::ALL_ROBOTS});
  Run run;
  std::vector<msg::RememberedOrder> resumes;
  for (std::uint32_t i = 100; i < 356; ++i) resumes.push_back(resume(i, 1, kOtherClient));
  run.remember(kFirst, resumes);
  run.remember(kFirst, {hold(robot, 100)});
  run.grant(kFirst, 4, 31);
  run.remember(kFirst, {hold(robot, 100)});
  CHECK(run.count(AuditRule::kHeld) == (robot == 4 ? 1 : 0));
}

TEST_CASE("of thousands of orders only the latest are judged") {
  Run run;
  SECTION("confirmed orders") {
    for (std::uint32_t i = 0; i < kMaxKept + 10; ++i) run.confirm(kFirst, hold(i, 100 + i));
    run.remember(kFirst, {});
    CHECK(run.found.size() == kMaxKept);
    CHECK(std::ranges::count(run.found, RobotId{9}, &Found::robot) == 0);
    CHECK(std::ranges::count(run.found, RobotId{10}, &Found::robot) == 1);
  }
  SECTION("sent orders") {
    for (std::uint32_t i = 0; i < kMaxKept + 10; ++i) run.send(hold(i, 100 + i));
    for (const std::uint32_t i : {9u, 10u}) run.answer(kFirst, hold(i, 100 + i));
    run.remember(kFirst, {});
    CHECK(run.found == std::vector<Found>{{AuditRule::kForgottenOrder, 10, 0, 0}});
  }
  SECTION("orders that agents announced") {
    for (std::uint32_t i = 0; i < kMaxKept + 10; ++i) run.audit.on_memory(run.page(4, {hold(i, 100 + i)}));
    run.confirm(kFirst, hold(9, 109));
    run.confirm(kFirst, hold(10, 110));
    run.register_agent(4, 8);
    run.grant(kSecond, 4, 31, 8);
    run.remember(kSecond, {});
    CHECK(run.found == std::vector<Found>{{AuditRule::kForgottenOrder, 10, 0, 8}});
  }
}

}  // namespace sidestep::order_memory_test
