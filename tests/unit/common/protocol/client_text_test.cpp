// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/client_text.hpp"

#include "tests/catch.hpp"

namespace sidestep::client_text_test {

TEST_CASE("a client is shown by its name, and by its number only if it has none") {
  CHECK(client_text(client_id("kitchen"), client_name("kitchen")) == "client kitchen");
  CHECK(client_phrase(client_id("kitchen"), client_name("kitchen")) == "client kitchen");
  CHECK(client_text(2'000'001, {}) == "client 2000001");
  CHECK(client_text(static_cast<ClientId>(Sender::kOperator), {}) == "operator");
  CHECK(client_phrase(static_cast<ClientId>(Sender::kOperator), {}) == "the operator");
  CHECK(client_phrase(static_cast<ClientId>(Sender::kScenario), {}) == "the scenario");
  CHECK(client_phrase(static_cast<ClientId>(Sender::kCoordinator) + 1, {}) == "coordinator 1");
}

TEST_CASE("a zone that is not there cannot be removed, and the zones that are there are named") {
  constexpr auto kOperator = static_cast<ClientId>(Sender::kOperator);
  CHECK(unknown_zone_text(7, kOperator, {}, {}) ==
        "remove zone 7: refused, the operator has no zone 7; there are no zones");
  const auto zone = [](ClientId client, std::uint32_t number, const char* name = "") {
    Order order{msg::OrderKind::ORDER_ZONE, kAllRobots, client, 1};
    order.zone_number = number;
    order.client_name = client_name(name);
    return order;
  };
  // Two coordinators list the same zone.
  CHECK(
      unknown_zone_text(7, client_id("bob"), client_name("bob"),
                        {zone(kOperator, 1), zone(client_id("kitchen"), 7, "kitchen"), zone(2'000'001, 8),
                         zone(kOperator, 1)}) ==
      "remove zone 7: refused, client bob has no zone 7; zones: 1 of the operator, 7 of client kitchen, 8 of "
      "client 2000001");
}

}  // namespace sidestep::client_text_test
