// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/fault_target.hpp"

#include "tests/catch.hpp"

namespace sidestep::fault_target_test {

TEST_CASE("fault targets have the same names as in reports, and other names are rejected") {
  const auto number = [](const std::string& text) { return parse_fault_target(text)->number; };
  CHECK(number("all") == kEveryProcess);
  CHECK(parse_fault_target("all")->participant.empty());
  CHECK(number("agent 3") == 3);
  CHECK(parse_fault_target("agent 3")->participant == "agent-3");
  CHECK(number("agent 1023") == 1023);
  CHECK(number("coordinator") == 10000);
  CHECK(parse_fault_target("coordinator")->participant == "sidestep-coordinator");
  CHECK(number("coordinator 1") == 10001);
  CHECK(parse_fault_target("coordinator 1")->participant == "coordinator-1");
  CHECK(number("vision") == 20000);
  CHECK(number("simulator") == 30000);
  for (const char* text : {"", "agent", "agent ", "agent 1024", "agent -1", "agent 3 4", "agent 3x",
                           "robot 3", "coordinator 8", "vision 1", "everybody"}) {
    INFO(text);
    CHECK_FALSE(parse_fault_target(text));
  }
}

}  // namespace sidestep::fault_target_test
