// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/clock_responder.hpp"

#include <vector>

#include "common/messaging/clock_codec.hpp"
#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"

namespace sidestep::clock_responder_test {

using namespace std::chrono_literals;

TEST_CASE("a process answers a probe with its clock, its host's clock and its role") {
  SimNetwork network(1, time_from_ns(1'700'000'000'000'000'000), NetworkSpec{});
  SimBus client(network), process(network, {network.new_process(), {2s, 0, {}}});
  const ClockResponder responder(process, {5, 77, 0.0005, "robot-5", "crossing"},
                                 [] { return Duration(-2s); });
  std::vector<ClockAnswer> answers;
  std::vector<Time> received;
  client.subscribe(topics::kClockReading, [&](const msg::ClockReading& message) {
    answers.push_back(decode(message).value());
    received.push_back(client.now());
  });
  auto writer = client.advertise(topics::kClockProbe);
  const Time sent = client.now();
  msg::ClockProbe probe;
  probe.client(1'000'007);
  probe.header().sender(1'000'007);
  writer.publish(probe, sent);
  network.run_until(network.now() + 1s);
  REQUIRE(answers.size() == 1);
  CHECK(answers[0].process == 5);
  CHECK(answers[0].incarnation == 77);
  CHECK(answers[0].client == 1'000'007);
  CHECK(answers[0].probe_sent == sent);
  CHECK(answers[0].probe_received >= sent + 2s);
  CHECK(answers[0].answered <= received[0] + 2s);
  CHECK(answers[0].host_ahead == Duration(-2s));
  CHECK(answers[0].clock_bound_s == 0.0005);
  CHECK(answers[0].host == "robot-5");
  CHECK(answers[0].scenario == "crossing");
}

TEST_CASE("a process that receives many probes answers at a bounded rate") {
  SimNetwork network(1, time_from_ns(1'700'000'000'000'000'000), NetworkSpec{});
  SimBus client(network), process(network);
  const ClockResponder responder(process, {5, 77, 0.0005, "robot-5", "crossing"},
                                 [] { return Duration(0s); });
  int answers = 0;
  client.subscribe(topics::kClockReading, [&](const msg::ClockReading&) { ++answers; });
  auto writer = client.advertise(topics::kClockProbe);
  for (int i = 0; i < 10'000; ++i) {
    msg::ClockProbe probe;
    probe.client(static_cast<std::uint32_t>(i));
    probe.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
    writer.publish(probe, client.now());
    network.run_until(network.now() + 100us);
  }
  network.run_until(network.now() + 1s);
  CHECK(answers >= 100);
  CHECK(answers <= ClockResponder::kBurst + 101);
}

}  // namespace sidestep::clock_responder_test
