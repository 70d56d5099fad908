// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/sent_messages.hpp"

#include "common/config/scenario_loader.hpp"
#include "common/messaging/sim/bus.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::sent_messages_test {

using namespace std::chrono_literals;

Scenario pair() {
  return parse_scenario("field: {length_m: 6, width_m: 4}\ncircle: {count: 2, spacing_m: 3}\n", "pair.yaml");
}

TEST_CASE("malformed messages are counted by sender and topic, with the time of the first") {
  SimNetwork network(1, Time{1000s}, NetworkSpec{});
  SimBus observer(network), sender(network);
  observer.become_observer();
  const SentMessages sent(observer, pair());
  auto states = sender.advertise(topics::kCoordinator);
  network.run_until(Time{1002s});
  msg::CoordinatorState state;
  state.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
  state.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
  states.publish(state, sender.now());
  network.run_until(Time{1003s});
  CHECK(sent.failures().empty());
  state.notices().emplace_back().is_displaced(true);
  state.notices()[0].vx_mps(1000);
  for (int i = 0; i < 3; ++i) states.publish(state, sender.now());
  network.run_until(Time{1004s});
  CHECK(sent.failures() ==
        std::vector<std::string>{"3 malformed messages of coordinator on coordinator, the first at 3.000 s"});
}

TEST_CASE("a system without faults sends no malformed message on any topic") {
  const Scenario scenario = pair();
  SimSystem system(scenario, 1);
  const SentMessages sent(system.observer_bus(), scenario);
  system.run_until(system.begin() + 5s);
  CHECK(system.metrics().report().grants > 50);
  CHECK(sent.failures() == std::vector<std::string>{});
}

}  // namespace sidestep::sent_messages_test
