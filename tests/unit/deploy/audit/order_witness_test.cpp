// SPDX-License-Identifier: Apache-2.0
// Which messages prove that an agent has announced an order to a new coordinator.
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/order_run.hpp"

namespace sidestep::order_memory_test {

/// An order that the first coordinator has confirmed and an agent has announced to the second one, which does
/// not remember it.
struct CoordinatorSuccession : Run {
  using Run::Run;
  void begin() { confirm(kFirst, lost); }
  void learn() { audit.on_memory(page(4, {lost})); }
  void succeed() {
    register_agent(4, 8);
    grant(kSecond, 5, 31, 8);
  }
  std::size_t forgotten() {
    remember(kSecond, {});
    return count(AuditRule::kForgottenOrder);
  }

  msg::RememberedOrder lost = hold(4, 100);
};

TEST_CASE("a new coordinator that does not remember an order announced to it is reported") {
  CoordinatorSuccession run;
  run.begin();
  run.learn();
  run.succeed();
  CHECK(run.forgotten() == 1);
  CHECK(run.found == std::vector<Found>{{AuditRule::kForgottenOrder, 4, 0, 8}});
  CHECK(run.details.front() ==
        "hold 100 of client 1000001, confirmed by coordinator 0, is not in the memory of coordinator 1, and "
        "nothing has replaced it");
}

TEST_CASE("a new coordinator is reported only if an agent has certainly announced the order to it") {
  const bool is_complete = GENERATE(true, false);
  CoordinatorSuccession run(is_complete);
  run.begin();
  std::size_t expected = 0;
  SECTION("no agent knows the order") { run.succeed(); }
  SECTION("messages may be missed, so the agent may have learned something else") {
    run.learn();
    run.succeed();
    expected = is_complete ? 1 : 0;
  }
  SECTION("the agent learns the order after it has registered") {
    run.succeed();
    run.learn();
  }
  SECTION("the agent learns the order between two registrations in one epoch") {
    run.register_agent(4, 8);
    run.learn();
    run.succeed();
  }
  SECTION("the agent learns the order between registrations in two epochs") {
    run.register_agent(4, 7);
    run.learn();
    run.succeed();
    expected = is_complete ? 1 : 0;
  }
  SECTION("the agent has restarted before it registers") {
    run.learn();
    ++run.incarnations[4];
    run.succeed();
  }
  SECTION("the agent has registered in another epoch since") {
    run.learn();
    run.succeed();
    run.register_agent(4, 9);
  }
  SECTION("a late registration in an earlier epoch changes nothing") {
    run.learn();
    run.succeed();
    run.register_agent(4, 7);
    expected = is_complete ? 1 : 0;
  }
  SECTION("only an agent that is not on the roster knows the order") {
    run.audit.on_memory(run.page(99, {run.lost}));
    run.register_agent(99, 8);
    run.grant(kSecond, 5, 31, 8);
  }
  SECTION("another process speaks for the agent") {
    msg::OrderMemory forged = run.page(4, {run.lost});
    forged.header().sender(5);
    run.audit.on_memory(forged);
    run.succeed();
  }
  SECTION("the coordinator has granted nothing yet") {
    run.learn();
    run.register_agent(4, 8);
  }
  SECTION("the coordinator granted only after the first page of its memory") {
    run.learn();
    run.register_agent(4, 8);
    run.audit.on_memory(run.page(kSecond, {}, 0, 2));
    run.grant(kSecond, 5, 31, 8);
    // A grant is not part of this topic, so it leaves no gap in the message numbers.
    run.audit.on_memory(run.page(kSecond, {}, 1, 2));
    CHECK(run.found.empty());
    return;
  }
  SECTION("the coordinator does not know yet whether it remembers all orders") {
    run.learn();
    run.succeed();
    msg::OrderMemory memory = run.page(kSecond, {});
    memory.is_complete(false);
    run.audit.on_memory(memory);
    CHECK(run.found.empty());
    return;
  }
  SECTION("the agent's clock was set back") {
    run.learn();
    run.now_ns -= 5'000'000;
    run.learn();
    run.now_ns += 10'000'000;
    run.succeed();
  }
  CHECK(run.forgotten() == expected);
}

TEST_CASE("an agent that follows a drive order remembers it") {
  const bool is_complete = GENERATE(true, false);
  CoordinatorSuccession run(is_complete);
  run.lost = order(msg::OrderKind::ORDER_GO, 4, kClient, 100);
  run.begin();
  SECTION("the agent names the order") {
    run.status(4, false, 100, kClient);
    run.succeed();
    CHECK(run.forgotten() == (is_complete ? 1 : 0));
  }
  SECTION("the agent names another order") {
    run.status(4, false, 99, kClient);
    run.status(4, false, 100, kOtherClient);
    run.status(4, false);
    run.succeed();
    CHECK(run.forgotten() == 0);
  }
}

TEST_CASE("an agent that reports being held remembers the only hold sent to it since it was last free") {
  const bool is_complete = GENERATE(true, false);
  CoordinatorSuccession run(is_complete);
  run.status(4, false);
  bool is_known = true;
  SECTION("only this hold was sent") { run.begin(); }
  SECTION("only this hold was sent, and it was sent twice") {
    run.begin();
    run.send(run.lost);
  }
  SECTION("only this hold was sent, for all robots") {
    run.lost = hold(msg::ALL_ROBOTS, 100);
    run.begin();
  }
  SECTION("another robot's hold was also sent") {
    run.begin();
    run.send(hold(5, 90));
  }
  SECTION("an order of another kind was also sent") {
    run.begin();
    run.send(order(msg::OrderKind::ORDER_GO, 4, kClient, 90));
  }
  SECTION("two earlier holds ended before this hold was sent") {
    run.send(hold(4, 70));
    run.send(hold(4, 71));
    run.status(4, true);
    run.status(4, false);
    run.begin();
  }
  SECTION("two holds were sent") {
    run.send(hold(4, 90, kOtherClient));
    run.begin();
    is_known = false;
  }
  SECTION("the robot was already held when this hold was sent") {
    run.send(hold(4, 90));
    run.status(4, true);
    run.begin();
    run.status(4, true);
    is_known = false;
  }
  SECTION("this hold was sent during an earlier hold") {
    run.send(hold(4, 90));
    run.status(4, true);
    run.begin();
    run.status(4, false);
    is_known = false;
  }
  run.status(4, true);
  run.succeed();
  CHECK(run.forgotten() == (is_known && is_complete ? 1 : 0));
}

TEST_CASE("a status report that is late or not from the robot's agent proves nothing") {
  CoordinatorSuccession run;
  run.status(4, false);
  SECTION("an earlier report arrives late") {
    msg::OrderStatus late;
    late.header(run.header(4, 4));
    late.robot(4);
    late.is_held(true);
    run.status(4, false);
    run.begin();
    run.audit.on_status(late);
  }
  SECTION("another robot's agent reports") {
    msg::OrderStatus forged;
    run.begin();
    forged.header(run.header(4, 5));
    forged.robot(4);
    forged.is_held(true);
    run.audit.on_status(forged);
  }
  run.succeed();
  CHECK(run.forgotten() == 0);
}

TEST_CASE("a restarted agent knows an order from the time at which it learned the order again") {
  CoordinatorSuccession run;
  run.begin();
  run.learn();
  ++run.incarnations[4];
  run.learn();
  run.succeed();
  CHECK(run.forgotten() == 1);
}

TEST_CASE("an agent knows an order from the time at which it first announced it") {
  CoordinatorSuccession run;
  run.begin();
  run.learn();
  run.register_agent(4, 8);
  run.learn();
  run.grant(kSecond, 5, 31, 8);
  CHECK(run.forgotten() == 1);
}

}  // namespace sidestep::order_memory_test
