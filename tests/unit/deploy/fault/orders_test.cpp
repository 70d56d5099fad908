// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "deploy/fault/orders.hpp"

using namespace sidestep;

TEST_CASE("targets of orders are named as in reports, and everything else is none") {
  const auto number = [](const std::string& words) { return order_target(words)->number; };
  CHECK(number("all") == kEveryProcess);
  CHECK(order_target("all")->participant.empty());
  CHECK(number("agent 3") == 3);
  CHECK(order_target("agent 3")->participant == "agent-3");
  CHECK(number("agent 1023") == 1023);
  CHECK(number("coordinator") == 10000);
  CHECK(order_target("coordinator")->participant == "sidestep-coordinator");
  CHECK(number("coordinator 1") == 10001);
  CHECK(order_target("coordinator 1")->participant == "coordinator-1");
  CHECK(number("vision") == 20000);
  CHECK(number("simulator") == 30000);
  for (const char* words : {"", "agent", "agent ", "agent 1024", "agent -1", "agent 3 4", "agent 3x",
                            "robot 3", "coordinator 8", "vision 1", "everybody"}) {
    INFO(words);
    CHECK_FALSE(order_target(words));
  }
}
