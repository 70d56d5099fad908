// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/panels.hpp"

#include <nlohmann/json.hpp>
#include <set>

#include "common/messaging/order_codec.hpp"
#include "tests/catch.hpp"

namespace sidestep::panels_test {

TEST_CASE("a zone is shown with the name of its client") {
  std::vector<RememberedOrder> zones(2);
  for (Order* order : {&zones[0].order, &zones[1].order}) {
    order->kind = msg::OrderKind::ORDER_ZONE;
    order->robot = kAllRobots;
    order->number = 5;
    order->zone_number = 7;
    order->zone = {{{1, 2}}, 0.5};
  }
  zones[0].order.client = client_id("kitchen");
  zones[0].order.client_name = client_name("kitchen");
  zones[1].order.client = static_cast<ClientId>(Sender::kOperator);
  msg::OrderMemory memory = encode(zones, true, false).front();
  memory.process(static_cast<std::uint32_t>(Sender::kCoordinator));
  memory.header().sender(memory.process());
  FloorState floor;
  floor.on(memory, time_from_ns(1'000'000'000'000));
  std::set<std::string> clients;
  for (const auto& zone : zones_json(floor)) clients.insert(zone.at("client").get<std::string>());
  CHECK(clients == std::set<std::string>{"client kitchen", "operator"});
}

}  // namespace sidestep::panels_test
