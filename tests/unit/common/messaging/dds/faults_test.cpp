// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>

#include "common/messaging/dds/operator_channel.hpp"
#include "common/messaging/impairment.hpp"
#include "tests/unit/common/messaging/dds/dds_test_support.hpp"

using namespace sidestep;

namespace {

constexpr std::uint32_t kRobot = 5;

DdsSettings with_faults() {
  DdsSettings settings = test_settings("disturbed");
  settings.faults = true;
  return settings;
}

/// A talker, and a listener whose messages can be disturbed.
struct Talk {
  Talk() {
    there.subscribe(topics::kVerdict, kRobot, std::function([this](const msg::Verdict& verdict) {
                      numbers.push_back(verdict.head().message_number());
                      delays.push_back(there.now() - time_from_ns(verdict.head().stamp_ns()));
                    }));
    writer = here.advertise(topics::kVerdict, kRobot);
  }
  /// Talks until the condition holds; false when it never does.
  template <typename Condition>
  bool talk_until(Condition condition) {
    return run_until(
        [&] {
          msg::Verdict verdict;
          verdict.robot(kRobot);
          writer.publish(verdict, here.now());
          return condition();
        },
        here, there);
  }

  DdsBus here{test_settings("talker")};
  DdsBus there{with_faults()};
  Writer<msg::Verdict> writer;
  std::vector<std::uint64_t> numbers;
  std::vector<Duration> delays;
};

msg::NetworkFault cut_order() {
  msg::NetworkFault order;
  order.target(kRobot);
  order.mean_burst(1);
  order.is_cut(true);
  return order;
}

}  // namespace

TEST_CASE("a cut lets nothing through but an operator's orders, until it is ended") {
  Talk talk;
  int orders_heard = 0;
  talk.there.subscribe(topics::kNetworkFault, std::function([&](const msg::NetworkFault& order) {
                         ++orders_heard;
                         talk.there.impair(*link_quality_from(order), 1);
                       }));
  REQUIRE(talk.talk_until([&] { return talk.numbers.size() > 5; }));

  OperatorChannel orders(test_settings("operator"), topics::kNetworkFault);
  REQUIRE(run_until([&] { return orders.takers() == std::vector<std::string>{"disturbed"}; }, talk.there));
  CHECK(run_until([&] { return orders.is_written(channel_name(topics::kVerdict, kRobot)); }, talk.there));
  CHECK_FALSE(orders.is_written("verdict/99"));
  msg::NetworkFault order = cut_order();
  orders.writer().write(&order);
  REQUIRE(run_until([&] { return orders_heard == 1; }, talk.there));
  CHECK(orders.wait_until_taken(kDeadline));

  talk.numbers.clear();
  const auto until = talk.here.now() + Duration{300'000'000};
  REQUIRE(talk.talk_until([&] { return talk.here.now() > until; }));
  CHECK(talk.numbers.empty());

  order.is_cut(false);
  orders.writer().write(&order);
  CHECK(talk.talk_until([&] { return talk.numbers.size() > 5; }));
  CHECK(orders_heard == 2);
}

TEST_CASE("messages come late, twice and out of order as ordered, and what waits goes with its reader") {
  Talk talk;
  REQUIRE(talk.talk_until([&] { return !talk.numbers.empty(); }));
  const Duration least{2'000'000};
  talk.there.impair({0.2, 1, 0.5, least, Duration{20'000'000}, Duration{100'000'000}, false}, 7);
  // Whatever was under way has come when the first late one has.
  const std::uint64_t before = talk.writer.count();
  REQUIRE(talk.talk_until([&] { return talk.numbers.back() > before + 1; }));
  talk.numbers.clear();
  talk.delays.clear();
  REQUIRE(talk.talk_until([&] { return talk.numbers.size() > 200; }));
  CHECK(*std::min_element(talk.delays.begin(), talk.delays.end()) >= least);
  // A reader that keeps the last sample takes no older one after it: overtaken messages are lost to it.
  CHECK(talk.numbers.back() - talk.numbers.front() > talk.numbers.size());
  // Some messages wait now, and the readers end before they have come.
}

TEST_CASE("buses without a fault and with one that was cleared pass everything on at once") {
  Talk talk;
  talk.there.impair({0, 1, 0, Duration{0}, Duration{0}, Duration{0}, true}, 1);
  talk.there.impair(kUntouchedLink, 1);
  CHECK(talk.talk_until([&] { return talk.numbers.size() > 100; }));
}
