// SPDX-License-Identifier: Apache-2.0
// Subscribes to all topics that the monitor subscribes to, and discards
// the messages until it is interrupted. Shows the minimum cost of listening.
#include <cstdio>
#include <cstdlib>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/process/stop_signals.hpp"

int main(int argc, char** argv) {
  using namespace sidestep;
  if (argc != 4) {
    std::fprintf(stderr, "usage: discarding_subscriber SCENARIO DOMAIN INTERFACE\n");
    return 2;
  }
  const Scenario scenario = load_scenario(argv[1]);
  DdsBus bus({std::atoi(argv[2]), argv[3], "discarding-subscriber"});
  std::uint64_t received = 0;
  for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
    if (topic.qos == Qos::kImage) return;
    if (!topic.per_robot) return bus.observe<Message>(topic, 0, [&](const Message&) { ++received; });
    for (const RobotSpec& robot : scenario.robots)
      bus.observe<Message>(topic, robot.id, [&](const Message&) { ++received; });
  });
  const StopSignals stop_signals([&bus] { bus.stop(); });
  bus.run();
  std::printf("%llu messages discarded\n", static_cast<unsigned long long>(received));
  return received > 0 ? 0 : 1;
}
