// SPDX-License-Identifier: Apache-2.0
// What memories of coordinators prove, message by message.
#include <algorithm>
#include <map>

#include "common/messaging/senders.hpp"
#include "deploy/monitor/audit/audited_robot.hpp"
#include "deploy/monitor/audit/order_audit.hpp"
#include "tests/catch.hpp"

namespace sidestep::order_memory_test {

constexpr auto kOperator = static_cast<std::uint32_t>(Sender::kOperator);
constexpr auto kReferee = static_cast<std::uint32_t>(Sender::kReferee);
constexpr auto kScenario = static_cast<std::uint32_t>(Sender::kScenario);
constexpr auto kFirst = static_cast<std::uint32_t>(Sender::kCoordinator), kSecond = kFirst + 1;
constexpr std::uint32_t kClient = 1'000'001, kOtherClient = 1'000'002;
constexpr std::size_t kMaxKept = 4096;

struct Found {
  AuditRule rule;
  RobotId robot;
  VersionNumber version;
  Epoch epoch;
  bool operator==(const Found&) const = default;
};

msg::RememberedOrder order(msg::OrderKind kind, std::uint32_t robot, std::uint32_t client,
                           std::uint64_t number, std::uint32_t zone = 0) {
  msg::RememberedOrder order;
  order.robot(robot);
  order.client(client);
  order.terms().order_kind(kind);
  order.terms().order_number(number);
  order.terms().zone(zone);
  return order;
}
msg::RememberedOrder hold(std::uint32_t robot, std::uint64_t number, std::uint32_t client = kClient) {
  return order(msg::OrderKind::ORDER_HOLD, robot, client, number);
}
msg::RememberedOrder resume(std::uint32_t robot, std::uint64_t number, std::uint32_t client = kClient) {
  return order(msg::OrderKind::ORDER_RESUME, robot, client, number);
}

/// Robots 3, 4 and 5, and two coordinators. Each call is one message, sent a millisecond later than the last.
struct Run {
  explicit Run(bool is_complete = true)
      : audit({3, 4, 5}, is_complete, stamps,
              [this](AuditRule rule, RobotId robot, VersionNumber version, Epoch epoch,
                     const std::string& detail) {
                found.push_back({rule, robot, version, epoch});
                details.push_back(detail);
              }) {}

  msg::Header header(std::uint64_t channel, std::uint32_t sender) {
    now_ns += 1'000'000;
    msg::Header header;
    header.sender(sender);
    header.incarnation(lives[sender]);
    header.message_number(++sent[{channel, sender}]);
    header.stamp_ns(now_ns);
    stamps.record(channel, header);
    return header;
  }
  void send(const msg::RememberedOrder& sent_order) {
    msg::Order message;
    message.header().sender(sent_order.client());
    message.robot(sent_order.robot());
    message.terms(sent_order.terms());
    audit.on_order(message);
  }
  void answer(std::uint32_t coordinator, const msg::RememberedOrder& answered,
              msg::OrderResult result = msg::OrderResult::RESULT_REMEMBERED) {
    msg::OrderAnswer message;
    message.header(header(1, coordinator));
    message.client(answered.client());
    message.order_number(answered.terms().order_number());
    message.result(result);
    audit.on_answer(message);
  }
  void confirm(std::uint32_t coordinator, const msg::RememberedOrder& confirmed) {
    send(confirmed);
    answer(coordinator, confirmed);
  }
  msg::OrderMemory page(std::uint32_t process, const std::vector<msg::RememberedOrder>& orders,
                        std::uint32_t index = 0, std::uint32_t count = 1) {
    msg::OrderMemory memory;
    memory.header(header(2, process));
    memory.process(process);
    memory.page_index(index);
    memory.page_count(count);
    memory.is_complete(true);
    memory.order_count(static_cast<std::uint8_t>(orders.size()));
    std::copy(orders.begin(), orders.end(), memory.orders().begin());
    return memory;
  }
  /// A whole memory, on as many pages as it needs.
  void remember(std::uint32_t process, const std::vector<msg::RememberedOrder>& orders) {
    const std::size_t pages = std::max<std::size_t>(1, (orders.size() + 31) / 32);
    for (std::size_t i = 0; i < pages; ++i) {
      const auto from = orders.begin() + static_cast<std::ptrdiff_t>(std::min(32 * i, orders.size()));
      const auto to = orders.begin() + static_cast<std::ptrdiff_t>(std::min(32 * (i + 1), orders.size()));
      audit.on_memory(
          page(process, {from, to}, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(pages)));
    }
  }
  void grant(std::uint32_t coordinator, RobotId robot, VersionNumber version, Epoch epoch = 7,
             std::int64_t earliest_ns = kAlways) {
    msg::Verdict verdict;
    verdict.header(header(3, coordinator));
    verdict.robot(robot);
    verdict.epoch(epoch);
    verdict.granted_version(version);
    audit.on_grant(verdict, earliest_ns);
  }
  void status(RobotId robot, bool is_held, std::uint64_t number = 0, std::uint32_t client = 0) {
    msg::OrderStatus status;
    status.header(header(4, robot));
    status.robot(robot);
    status.is_held(is_held);
    status.order_number(number);
    status.client(client);
    audit.on_status(status);
  }
  void register_agent(RobotId robot, Epoch epoch) {
    msg::Registration registration;
    registration.header(header(5, robot));
    registration.robot(robot);
    registration.epoch(epoch);
    audit.on_registration(registration);
  }
  std::size_t count(AuditRule rule) const {
    return static_cast<std::size_t>(std::ranges::count(found, rule, &Found::rule));
  }

  std::int64_t now_ns = 1'000'000'000;
  std::map<std::uint32_t, Incarnation> lives{{kFirst, 10}, {kSecond, 20}, {3, 30},
                                             {4, 40},      {5, 50},       {99, 60}};
  std::map<std::pair<std::uint64_t, std::uint32_t>, std::uint64_t> sent;
  ComparableStamps stamps;
  std::vector<Found> found;
  std::vector<std::string> details;
  OrderAudit audit;
};

TEST_CASE("a grant between two memories with one hold of its robot is reported once") {
  Run run;
  run.remember(kFirst, {hold(4, 100)});
  run.grant(kFirst, 4, 31);
  run.grant(kFirst, 5, 32);
  run.remember(kFirst, {hold(4, 100)});
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.found == std::vector<Found>{{AuditRule::kHeld, 4, 31, 7}});
  CHECK(run.details.front() ==
        "was granted 0.001 s after the coordinator had told hold 100 of client 1000001, which still stands");
  run.grant(kFirst, 4, 33, 8);
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.found.back() == Found{AuditRule::kHeld, 4, 33, 8});
}

TEST_CASE("a single message tells a hold, too, but only a whole memory shows that it still stands") {
  Run run;
  run.audit.on_memory(run.page(kFirst, {hold(4, 100)}, 0, 0));
  run.grant(kFirst, 4, 31);
  run.audit.on_memory(run.page(kFirst, {hold(4, 100)}, 0, 0));
  CHECK(run.found.empty());
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.count(AuditRule::kHeld) == 1);
}

TEST_CASE("what was not granted while the hold stood breaks no rule") {
  Run run;
  SECTION("a grant before the hold was told") {
    run.grant(kFirst, 4, 31);
    run.remember(kFirst, {hold(4, 100)});
  }
  SECTION("a grant at the time of the first memory") {
    run.remember(kFirst, {hold(4, 100)});
    run.now_ns -= 1'000'000;
    run.grant(kFirst, 4, 31);
  }
  SECTION("a grant that may repeat one before the hold") {
    const std::int64_t before_ns = run.now_ns;
    run.remember(kFirst, {hold(4, 100)});
    run.grant(kFirst, 4, 31, 7, before_ns);
  }
  SECTION("a grant of another coordinator") {
    run.remember(kFirst, {hold(4, 100)});
    run.grant(kSecond, 4, 31);
  }
  SECTION("a grant of an earlier run of the coordinator") {
    run.remember(kFirst, {hold(4, 100)});
    run.grant(kFirst, 4, 31);
    ++run.lives[kFirst];
  }
  SECTION("a late grant of an earlier run of the coordinator") {
    run.remember(kFirst, {hold(4, 100)});
    --run.lives[kFirst];
    run.grant(kFirst, 4, 31);
    ++run.lives[kFirst];
  }
  SECTION("a grant while another memory shows the hold lifted") {
    run.remember(kFirst, {hold(4, 100)});
    run.remember(kFirst, {});
    run.grant(kFirst, 4, 31);
  }
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.found.empty());
}

TEST_CASE("a grant at the time of the second memory may follow it") {
  Run run;
  run.remember(kFirst, {hold(4, 100)});
  run.grant(kFirst, 4, 31);
  run.now_ns -= 1'000'000;
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.found.empty());
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.count(AuditRule::kHeld) == 1);
}

TEST_CASE("a hold that was told after a memory without it still stands, though the memory arrives last") {
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

TEST_CASE("a grant that may repeat an earlier one was not made before the given time") {
  Run run;
  run.remember(kFirst, {hold(4, 100)});
  const std::int64_t after_ns = run.now_ns + 1;
  run.grant(kFirst, 4, 31, 7, GENERATE_COPY(after_ns, kAlways));
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.count(AuditRule::kHeld) == 1);
}

TEST_CASE("the newest grant of a robot counts, however late an older verdict arrives") {
  Run run;
  run.remember(kFirst, {hold(4, 100)});
  run.grant(kFirst, 4, 31);
  const VersionNumber second = GENERATE(30u, 31u, 32u);
  run.grant(kFirst, 4, second);
  run.remember(kFirst, {hold(4, 100)});
  CHECK(run.found == std::vector<Found>{{AuditRule::kHeld, 4, std::max<VersionNumber>(31, second), 7}});
}

TEST_CASE("a memory counts only if all of its pages were received in one sequence") {
  Run run;
  const std::vector<msg::RememberedOrder> holds{hold(4, 100)};
  run.remember(kFirst, holds);
  run.grant(kFirst, 4, 31);
  bool is_whole = false;
  SECTION("whole") {
    run.audit.on_memory(run.page(kFirst, holds, 0, 3));
    CHECK(run.found.empty());
    run.audit.on_memory(run.page(kFirst, {}, 1, 3));
    CHECK(run.found.empty());
    run.audit.on_memory(run.page(kFirst, {}, 2, 3));
    is_whole = true;
  }
  SECTION("begun anew") {
    run.audit.on_memory(run.page(kFirst, {}, 0, 2));
    run.audit.on_memory(run.page(kFirst, holds, 0, 2));
    run.audit.on_memory(run.page(kFirst, {}, 1, 2));
    is_whole = true;
  }
  SECTION("a page is missing") {
    run.audit.on_memory(run.page(kFirst, holds, 0, 3));
    run.audit.on_memory(run.page(kFirst, {}, 2, 3));
  }
  SECTION("a page is of a later memory") {
    run.audit.on_memory(run.page(kFirst, holds, 0, 2));
    (void)run.page(kFirst, {}, 1, 2);
    (void)run.page(kFirst, {}, 0, 2);
    run.audit.on_memory(run.page(kFirst, {}, 1, 2));
  }
  SECTION("the first page is missing") { run.audit.on_memory(run.page(kFirst, holds, 1, 2)); }
  SECTION("the last page is missing") { run.audit.on_memory(run.page(kFirst, holds, 0, 2)); }
  CHECK(run.count(AuditRule::kHeld) == (is_whole ? 1 : 0));
}

TEST_CASE("a coordinator that forgets what it has confirmed is reported once, with the robot of the order") {
  const std::uint32_t robot = GENERATE(5u, std::uint32_t{msg::ALL_ROBOTS});
  Run run;
  run.grant(kFirst, 5, 1, 9);
  run.confirm(kFirst, hold(robot, 100));
  run.remember(kFirst, {});
  run.remember(kFirst, {});
  CHECK(run.found == std::vector<Found>{{AuditRule::kForgottenOrder, robot == 5 ? 5u : 3u, 0, 9}});
}

TEST_CASE("what a coordinator has not confirmed, or not yet, it may forget") {
  Run run;
  SECTION("not answered") { run.send(hold(4, 100)); }
  SECTION("answered otherwise") {
    run.send(hold(4, 100));
    run.answer(kFirst, hold(4, 100), msg::OrderResult::RESULT_REPLACED);
  }
  SECTION("nobody heard the order") { run.answer(kFirst, hold(4, 100)); }
  SECTION("a resume") { run.confirm(kFirst, resume(4, 100)); }
  SECTION("confirmed at the time of the memory") {
    run.confirm(kFirst, hold(4, 100));
    run.now_ns -= 1'000'000;
  }
  SECTION("confirmed by another coordinator") { run.confirm(kSecond, hold(4, 100)); }
  SECTION("confirmed by an earlier run of it") {
    run.confirm(kFirst, hold(4, 100));
    ++run.lives[kFirst];
  }
  run.remember(kFirst, {});
  CHECK(run.found.empty());
}

TEST_CASE("of two confirmed orders with one subject the later one must be remembered, whichever came first") {
  const bool is_in_order = GENERATE(true, false);
  const bool is_kept = GENERATE(true, false);
  CAPTURE(is_in_order, is_kept);
  Run run;
  run.confirm(kFirst, hold(4, is_in_order ? 100 : 101));
  run.confirm(kFirst, hold(4, is_in_order ? 101 : 100));
  run.remember(kFirst, {hold(4, is_kept ? 101 : 100)});
  CHECK(run.count(AuditRule::kForgottenOrder) == (is_kept ? 0 : 1));
}

TEST_CASE("orders to drive share one place, but operator, referee and scenario have their own") {
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

TEST_CASE("of two orders with one number that of the higher client replaces the other") {
  const auto go = [](std::uint32_t client) { return order(msg::OrderKind::ORDER_GO, 4, client, 100); };
  Run run;
  run.confirm(kFirst, go(kClient));
  run.remember(kFirst, {go(kOtherClient)});
  CHECK(run.found.empty());
  run.confirm(kFirst, go(kOtherClient));
  run.remember(kFirst, {go(kClient)});
  CHECK(run.count(AuditRule::kForgottenOrder) == 1);
}

TEST_CASE(
    "a coordinator that may have dropped old resumes may lack holds, and one with many removals zones") {
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
  // These are not of the kind that is dropped.
  for (std::uint32_t i = 0; i < 300; ++i) memory.push_back(is_hold ? resume(i, 1, kOperator) : resume(i, 1));
  run.confirm(kFirst, lost);
  run.remember(kFirst, memory);
  CHECK(run.count(AuditRule::kForgottenOrder) == (are_many ? 0 : 1));
  // It remains possible: the orders that were dropped are gone.
  run.confirm(kFirst, lost);
  run.remember(kFirst, {});
  CHECK(run.count(AuditRule::kForgottenOrder) == (are_many ? 0 : 2));
  // Other orders are judged.
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

TEST_CASE("of very many orders the latest are judged") {
  Run run;
  SECTION("confirmed ones") {
    for (std::uint32_t i = 0; i < kMaxKept + 10; ++i) run.confirm(kFirst, hold(i, 100 + i));
    run.remember(kFirst, {});
    CHECK(run.found.size() == kMaxKept);
    CHECK(std::ranges::count(run.found, RobotId{9}, &Found::robot) == 0);
    CHECK(std::ranges::count(run.found, RobotId{10}, &Found::robot) == 1);
  }
  SECTION("sent ones") {
    for (std::uint32_t i = 0; i < kMaxKept + 10; ++i) run.send(hold(i, 100 + i));
    for (const std::uint32_t i : {9u, 10u}) run.answer(kFirst, hold(i, 100 + i));
    run.remember(kFirst, {});
    CHECK(run.found == std::vector<Found>{{AuditRule::kForgottenOrder, 10, 0, 0}});
  }
  SECTION("those that agents have heard of") {
    for (std::uint32_t i = 0; i < kMaxKept + 10; ++i) run.audit.on_memory(run.page(4, {hold(i, 100 + i)}));
    run.confirm(kFirst, hold(9, 109));
    run.confirm(kFirst, hold(10, 110));
    run.register_agent(4, 8);
    run.grant(kSecond, 4, 31, 8);
    run.remember(kSecond, {});
    CHECK(run.found == std::vector<Found>{{AuditRule::kForgottenOrder, 10, 0, 8}});
  }
}

/// An order that the first coordinator has confirmed, that an agent has told the second one, and that the
/// second one does not remember.
struct Succession : Run {
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

TEST_CASE("a new coordinator that was told an order and does not remember it is reported") {
  Succession run;
  run.begin();
  run.learn();
  run.succeed();
  CHECK(run.forgotten() == 1);
  CHECK(run.found == std::vector<Found>{{AuditRule::kForgottenOrder, 4, 0, 8}});
  CHECK(run.details.front() ==
        "hold 100 of client 1000001, confirmed by coordinator 0, is not in the memory of coordinator 1, and "
        "nothing has replaced it");
}

TEST_CASE("a new coordinator is reported only if it is certain that an agent has told it the order") {
  const bool is_complete = GENERATE(true, false);
  Succession run(is_complete);
  run.begin();
  std::size_t expected = 0;
  SECTION("no agent knows the order") { run.succeed(); }
  SECTION("not all messages are received, so it may have been told otherwise") {
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
  SECTION("the agent learns it between registrations in two epochs") {
    run.register_agent(4, 7);
    run.learn();
    run.succeed();
    expected = is_complete ? 1 : 0;
  }
  SECTION("an agent that has restarted since registers") {
    run.learn();
    ++run.lives[4];
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
  SECTION("somebody else speaks for the agent") {
    msg::OrderMemory forged = run.page(4, {run.lost});
    forged.header().sender(5);
    run.audit.on_memory(forged);
    run.succeed();
  }
  SECTION("the coordinator has granted nothing yet") {
    run.learn();
    run.register_agent(4, 8);
  }
  SECTION("the coordinator has granted only after the first page of its memory") {
    run.learn();
    run.register_agent(4, 8);
    run.audit.on_memory(run.page(kSecond, {}, 0, 2));
    run.grant(kSecond, 5, 31, 8);
    // A grant is no message of this topic.
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

TEST_CASE("an agent that follows an order to drive remembers it") {
  const bool is_complete = GENERATE(true, false);
  Succession run(is_complete);
  run.lost = order(msg::OrderKind::ORDER_GO, 4, kClient, 100);
  run.begin();
  SECTION("it names the order") {
    run.status(4, false, 100, kClient);
    run.succeed();
    CHECK(run.forgotten() == (is_complete ? 1 : 0));
  }
  SECTION("it names another one") {
    run.status(4, false, 99, kClient);
    run.status(4, false, 100, kOtherClient);
    run.status(4, false);
    run.succeed();
    CHECK(run.forgotten() == 0);
  }
}

TEST_CASE("an agent that reports being held remembers the only hold that was sent to it since it was not") {
  const bool is_complete = GENERATE(true, false);
  Succession run(is_complete);
  run.status(4, false);
  bool is_known = true;
  SECTION("the only one") { run.begin(); }
  SECTION("the only one, repeated") {
    run.begin();
    run.send(run.lost);
  }
  SECTION("one for all robots") {
    run.lost = hold(msg::ALL_ROBOTS, 100);
    run.begin();
  }
  SECTION("besides one of another robot") {
    run.begin();
    run.send(hold(5, 90));
  }
  SECTION("besides another order") {
    run.begin();
    run.send(order(msg::OrderKind::ORDER_GO, 4, kClient, 90));
  }
  SECTION("of two, which were not the cause of one earlier report") {
    run.send(hold(4, 70));
    run.send(hold(4, 71));
    run.status(4, true);
    run.status(4, false);
    run.begin();
  }
  SECTION("one of two") {
    run.send(hold(4, 90, kOtherClient));
    run.begin();
    is_known = false;
  }
  SECTION("one that was sent when the robot was held already") {
    run.send(hold(4, 90));
    run.status(4, true);
    run.begin();
    run.status(4, true);
    is_known = false;
  }
  SECTION("one that was sent before an earlier report of being held ended") {
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

TEST_CASE("reports of robots that are late, or not from their agents, prove nothing") {
  Succession run;
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

TEST_CASE("the time at which a restarted agent learned an order counts") {
  Succession run;
  run.begin();
  run.learn();
  ++run.lives[4];
  run.learn();
  run.succeed();
  CHECK(run.forgotten() == 1);
}

TEST_CASE("an agent knows an order from when it told it first") {
  Succession run;
  run.begin();
  run.learn();
  run.register_agent(4, 8);
  run.learn();
  run.grant(kSecond, 5, 31, 8);
  CHECK(run.forgotten() == 1);
}

}  // namespace sidestep::order_memory_test
