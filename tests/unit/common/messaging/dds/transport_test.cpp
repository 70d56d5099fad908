// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "common/messaging/dds/operator_channel.hpp"
#include "common/messaging/impairment.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::transport_test {

constexpr std::uint32_t kRobot = 5;

DdsSettings with_faults() {
  DdsSettings settings = test_settings("disturbed");
  settings.faults = true;
  return settings;
}

/// A sender, and a receiver whose messages can be impaired.
struct Connection {
  Connection() {
    there.subscribe(topics::kVerdict, kRobot, std::function([this](const msg::Verdict& verdict) {
                      numbers.push_back(verdict.header().message_number());
                      delays.push_back(there.now() - time_from_ns(verdict.header().stamp_ns()));
                    }));
    writer = here.advertise(topics::kVerdict, kRobot);
  }
  /// Sends until the condition holds. Returns false if it does not hold before the deadline.
  template <typename Condition>
  bool send_until(Condition condition) {
    return run_until(
        [&] {
          msg::Verdict verdict;
          verdict.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
          verdict.robot(kRobot);
          writer.publish(verdict, here.now());
          last_sent = verdict.header().message_number();
          return condition();
        },
        here, there);
  }

  DdsBus here{test_settings("sender")};
  DdsBus there{with_faults()};
  Writer<msg::Verdict> writer;
  std::uint64_t last_sent = 0;
  std::vector<std::uint64_t> numbers;
  std::vector<Duration> delays;
};

msg::NetworkFault cut_fault() {
  msg::NetworkFault fault;
  fault.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
  fault.target(kRobot);
  fault.mean_burst(1);
  fault.is_cut(true);
  return fault;
}

TEST_CASE("a cut blocks all messages except an operator's until it ends") {
  Connection connection;
  int faults_received = 0;
  connection.there.subscribe(topics::kNetworkFault, std::function([&](const msg::NetworkFault& fault) {
                               ++faults_received;
                               connection.there.impair(*link_quality_from(fault), 1);
                             }));
  REQUIRE(connection.send_until([&] { return connection.numbers.size() > 5; }));

  OperatorChannel channel(test_settings("operator"), topics::kNetworkFault);
  REQUIRE(run_until([&] { return channel.subscribers() == std::vector<std::string>{"disturbed"}; },
                    connection.there));
  CHECK(run_until([&] { return channel.has_writer(channel_name(topics::kVerdict, kRobot)); },
                  connection.there));
  CHECK_FALSE(channel.has_writer("verdict/99"));
  msg::NetworkFault fault = cut_fault();
  channel.writer().write(&fault);
  REQUIRE(run_until([&] { return faults_received == 1; }, connection.there));
  CHECK(channel.wait_until_acknowledged(kDeadline));

  connection.numbers.clear();
  const auto until = connection.here.now() + Duration{300'000'000};
  REQUIRE(connection.send_until([&] { return connection.here.now() > until; }));
  CHECK(connection.numbers.empty());
  CHECK(drops_of(connection.there).total(DropReason::kInjectedLoss) > 0);
  CHECK(drops_of(connection.here).total(DropReason::kInjectedLoss) == 0);

  fault.is_cut(false);
  channel.writer().write(&fault);
  CHECK(connection.send_until([&] { return connection.numbers.size() > 5; }));
  CHECK(faults_received == 2);
}

TEST_CASE("a fault delays, duplicates and reorders messages, and delayed messages end with their reader") {
  Connection connection;
  REQUIRE(connection.send_until([&] { return !connection.numbers.empty(); }));
  const Duration min_delay{2'000'000};
  connection.there.impair({0.2, 1, 0.5, min_delay, Duration{20'000'000}, Duration{100'000'000}, false}, 7);
  // Once a later message has arrived, no message without delay is still on its way.
  const std::uint64_t before = connection.last_sent;
  REQUIRE(connection.send_until([&] { return connection.numbers.back() > before + 1; }));
  connection.numbers.clear();
  connection.delays.clear();
  REQUIRE(connection.send_until([&] { return connection.numbers.size() > 200; }));
  CHECK(*std::min_element(connection.delays.begin(), connection.delays.end()) >= min_delay);
  // A reader that keeps only the last sample refuses older samples, so overtaken messages are lost.
  CHECK(connection.numbers.back() - connection.numbers.front() > connection.numbers.size());
  // At this point messages are still delayed, and the readers are destroyed before they arrive.
}

TEST_CASE("after a fault is cleared all messages arrive without delay") {
  Connection connection;
  connection.there.impair({0, 1, 0, Duration{0}, Duration{0}, Duration{0}, true}, 1);
  connection.there.impair(kUnimpairedLink, 1);
  CHECK(connection.send_until([&] { return connection.numbers.size() > 100; }));
}

}  // namespace sidestep::transport_test
